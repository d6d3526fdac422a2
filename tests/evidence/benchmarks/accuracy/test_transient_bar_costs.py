"""What error bars of transient contact cost: which runs are measured, what is said of them. No times are asserted."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from evidence.benchmarks.accuracy import transient_bar_costs
from evidence.benchmarks.accuracy.transient_bar_costs import CASES, KEPT, CostCase, CostRow, cost_rows, said
from evidence.processes import Command, Cost, RunFailed
from evidence.tables import write_rows
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS, TransientFacts
from evolvent.results.archive.run_folder import RunFolder
from evolvent.scene.scene import load_scene
from tests.support.checkout import ROOT
from tests.support.made_rows import made

QUICK = CostCase("quick", "a case", "he2022_dynamics.toml", (
    "mesh.level=quick", "sweep.positions=6", "transient.speeds_rpm=[3000]", "dynamics.damping_ratio=0.2",
))
TWICE = CostRow("A pair", 10.0, 20.0)


@pytest.mark.evidence
@pytest.mark.slow
def test_both_runs_differ_by_their_error_bars(tmp_path: Path) -> None:
    """He's pair in six positions at one speed: one row, of a run whose figures have no error bars and of one whose
    figures have them. The figures themselves agree, so that it is the same motion: to 1e-9, for sums of two processes
    round differently where their arrays lie differently in memory (docs/checks.md, *How well figures repeat*)."""
    (row,) = cost_rows(tmp_path, [QUICK])
    assert row.case == QUICK.words
    assert min(row.without_bars, row.with_bars) > 0.0
    (without,), (barred,) = (
        json.loads((tmp_path / f"quick_{which}/transient.json").read_text()) for which in ("without", "with")
    )
    assert without["dynamic_factor_error"] is None and barred["dynamic_factor_error"] > 0.0
    assert without["dynamic_factor"] == pytest.approx(barred["dynamic_factor"], rel=1e-9)


class MadeRuns:
    """Stands for `run`: processor times one after the other, and a table whose figure has this error bar."""

    def __init__(self, bar: float | None) -> None:
        self.bar = bar
        self.seconds = iter((7.0, 10.0, 25.0))
        self.commands: list[Command] = []

    def __call__(self, command: Command) -> Cost:
        self.commands.append(command)
        folder = Path(command.words[command.words.index("--out") + 1])
        folder.mkdir()
        bar = math.nan if self.bar is None else self.bar
        fact = made(TransientFacts, speed_rpm=3000.0, friction=0.0, dynamic_factor_error=bar)
        TRANSIENT_FACTS.write(RunFolder(folder), [fact])
        return Cost(wall=1.0, cpu=next(self.seconds), memory_MB=1.0)


def test_what_is_measured_is_the_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of three runs, which take 7, 10 and 25 s of processor time, the first does not count; bars are on in the last.
    Each is of one process, and takes nothing from a folder that an earlier call has left."""
    made = MadeRuns(bar=0.1)
    monkeypatch.setattr(transient_bar_costs, "run", made)
    assert list(cost_rows(tmp_path, [QUICK])) == [CostRow(QUICK.words, 10.0, 25.0)]
    for command, bars in zip(made.commands, ("false", "false", "true"), strict=True):
        assert f"--set=output.error_bars={bars}" in command.words
        assert command.ranks == 1 and "--overwrite" in command.words


def test_bars_that_failed_are_no_cost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that was to have error bars and has none, as its companion failed: an error that names the case."""
    monkeypatch.setattr(transient_bar_costs, "run", MadeRuns(bar=None))
    with pytest.raises(ValueError, match=r"quick_with: wanted error bars, found none at 3000 r/min"):
        list(cost_rows(tmp_path, [QUICK]))


def test_a_scene_that_fails_is_an_error(tmp_path: Path) -> None:
    """A row of a run that came to no end would be a cost of nothing."""
    with pytest.raises(RunFailed, match="speeds_rpm"):
        list(cost_rows(tmp_path, [CostCase("bad", "a case", "he2022_dynamics.toml", ("transient.speeds_rpm=[0]",))]))


def test_cases_are_scenes() -> None:
    """All settings are keys of a scene with values that are allowed."""
    for case in CASES:
        section = load_scene(ROOT / "demos" / case.scene, case.settings).transient
        assert section is not None and section.speeds_rpm


def test_what_is_said(tmp_path: Path) -> None:
    """10 s without and 20 s with bars: twice as much. Without a table there is an error that names the command."""
    with pytest.raises(ValueError, match="transient_bar_costs --out DIR"):
        said(tmp_path)
    write_rows(tmp_path / KEPT, [TWICE])
    assert "A pair takes 10 s of processor time without and 20 s with them, **2.0 times** as much" in said(tmp_path)
