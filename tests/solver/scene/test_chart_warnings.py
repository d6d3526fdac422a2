"""Flank charts that do not end where the face does: said by every command that computes with them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from evolvent.commands.app import COMMANDS, Exit, main
from evolvent.run.study.results.check_figures import run_check
from tests.support.checkout import ROOT
from tests.support.gear_cases import QUIET, spur_scene

CHART = "diameter_mm,z_mm,depth_um\n140,-8,1\n140,8,1\n156,-8,1\n156,8,1\n"
"""Heights over 80 % of the face of He's gears, alike, so that the pair stays plane."""
SAID = "pinion.flank_csv, lead.csv: heights z = -8 to 8 mm cover 80 % of the face"
SETTINGS = (
    "mesh.order=1", "sweep.positions=3", "transient.speeds_rpm=[1000]", "dynamics.backlash_um=50",
    'design.vary=[["both.tip_relief_um",10.0,20.0,10.0]]',
    "dynamics.speed_rpm=[1000,1100]", "dynamics.speeds=2", "dynamics.torque_percents=[50,100,150]", *QUIET,
)
PERCENT = {"loads": "100", "excitation": "50,100"}


def arguments(chart: Path) -> list[str]:
    """A scene with the chart, as cheap as it can be."""
    chart.write_text(CHART, encoding="utf-8")
    settings = [f"--set={setting}" for setting in (*SETTINGS, f"pinion.flank_csv={chart}")]
    return [str(ROOT / "demos/he2022.toml"), "--level", "quick", *settings]


def test_check_says_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The command alone, and as a part of a study, which counts it."""
    assert main(["check", *arguments(tmp_path / "lead.csv")]) == Exit.DONE
    assert SAID in capsys.readouterr().out
    scene = spur_scene(f'pinion.flank_csv="{tmp_path / "lead.csv"}"')
    assert any(SAID in sentence for sentence in run_check(scene, tmp_path / "out"))


@pytest.mark.slow
@pytest.mark.parametrize("command", [each.name for each in COMMANDS if each.parallel])
def test_every_computing_command_says_it(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Problem: a chart over 80 % of the face; every computing command takes part. Right: each says on stderr that the
    chart is extended, and a run's summary.json beside its figures."""
    percent = [f"--percent={PERCENT[command]}"] if command in PERCENT else []
    rubbing = ["--set=contact.friction=0.1"] * (command == "losses")  # which are nothing without friction
    out = tmp_path / "out"
    words = [command, *arguments(tmp_path / "lead.csv"), *percent, *rubbing]
    assert main([*words, "--out", str(out), "--quiet"]) == Exit.DONE
    assert f"warning: {SAID}" in capsys.readouterr().err
    if command == "run":
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        assert any(SAID in sentence for sentence in summary["warnings"])
