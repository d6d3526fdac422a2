"""Load cases by `loads`, `losses`, `excitation` and `design`: beside the percents that they are, misaligned, at their
own speeds, resumed, on two ranks.

Problem: He's relieved spur pair in line contact, in the plane, and a narrow helical pair. Two runs differ by rounding:
figures of what is the same are compared to eight of the nine digits of a table.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from shutil import rmtree
from typing import Any

import pytest

from evolvent.commands.app import Exit, main
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS
from evolvent.gears import shared_gears
from evolvent.results.archive.store import ArchiveError
from evolvent.results.tables.load_table import LOADS, LoadRuns
from evolvent.results.tables.table import Table
from evolvent.run.computation import Computation
from evolvent.run.design.checked import BEST
from evolvent.run.kinds.design import Design
from evolvent.run.kinds.excitation import Excitation
from evolvent.run.kinds.loads import Loads
from evolvent.run.kinds.losses import LOSSES, Losses, loss_lines
from evolvent.scene.scene import Scene, SceneError, load_scene, scene_from_text
from tests.support.checkout import ROOT
from tests.support.computing.interruption import Interrupted, interrupted
from tests.support.computing.quiet import quietly
from tests.support.computing.redrawn import redrawn
from tests.support.computing.same_tables import same_tables
from tests.support.gear_cases import HELICAL, QUIET, helical_scene, spur_scene
from tests.support.recorded_tables import assert_same_rows
from tests.support.running.processes import RunScript

RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)
LINE = (*RELIEVED, "mesh.level=line", "sweep.positions=4", "contact.friction=[0.1]", "output.error_bars=true")
SAME = 'load_case=[{name = "full", torque_Nm = 170.0}, {name = "half", torque_Nm = 85.0}]'
"""50 and 100 % of the torque of He's pair."""
DUTY = (
    'load_case=[{name = "slow", torque_Nm = 170.0, speed_rpm = 500.0, share_of_life = 0.25}, '
    '{name = "fast", torque_Nm = 170.0, speed_rpm = 3000.0, share_of_life = 0.5}, '
    '{name = "light", torque_Nm = 85.0, share_of_life = 0.25}]'
)
BARE = "output.error_bars=false"
TILTED = 'load_case=[{name = "a", torque_Nm = 85.0}, {name = "b", torque_Nm = 170.0, misalignment_um = 5.0}]'
VARY = 'design.vary=[["both.tip_relief_um",16.0,24.0,4.0]]'
TABLES: dict[type[Computation[Any]], tuple[Table[Any], ...]] = {
    Loads: (LOADS,), Losses: (LOSSES,), Excitation: (EXCITATION, HARMONICS), Design: (BEST,),
}


def line_scene(*settings: str) -> Scene:
    """He's relieved pair in line contact."""
    return spur_scene(*LINE, *settings)


def helical_line(*settings: str) -> Scene:
    """A relieved narrow helical pair in line contact."""
    text = HELICAL.replace('level = "quick"\norder = 1\nelements_per_contact_width = 0.5', 'level = "line"')
    return scene_from_text(text, [*QUIET, *(setting.replace("=20", "=60") for setting in RELIEVED), *settings])


def unnamed(rows: list[Any]) -> list[Any]:
    """Rows without the name of their load."""
    return [replace(row, case="") for row in rows]


@pytest.mark.parametrize("kind", TABLES, ids=lambda kind: kind.name)
def test_load_cases_are_the_percents_that_they_are(kind: type[Computation[Any]], tmp_path: Path) -> None:
    """85 and 170 N·m beside 50 and 100 % of 170 N·m: the same rows under other names."""
    more = (VARY,) if kind is Design else ()
    quietly(kind.of(line_scene(*more), (50.0, 100.0)), tmp_path / "percents")
    quietly(kind.of(line_scene(*more, SAME)), tmp_path / "cases")
    for table in TABLES[kind]:
        parts, named = (table.read(tmp_path / name) for name in ("percents", "cases"))
        assert [row.case for row in parts if row.torque_Nm] == [
            {"half": "50 %", "full": "100 %"}[row.case] for row in named if row.torque_Nm
        ]
        assert_same_rows(unnamed(named), unnamed(parts), 1e-8)


@pytest.mark.parametrize("scene", [helical_scene, helical_line])
def test_misaligned_load_case_has_the_figures_of_the_misaligned_pair(
    scene: Callable[..., Scene], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: a narrow helical pair under one torque, aligned and open by 15 µm, with the contact resolved and in line
    contact. Exact: the scene with 15 µm. Both are on gears that are condensed once; the open pair bears more on one
    end."""
    calls, condensed = [], shared_gears.condensed_gears

    def counted(*given: Any, **named: Any) -> Any:
        calls.append(given)
        return condensed(*given, **named)

    monkeypatch.setattr(shared_gears, "condensed_gears", counted)
    openings = {"a": 0, "b": 15}
    cases = (f'{{name = "{name}", torque_Nm = 120.0, misalignment_um = {um}}}' for name, um in openings.items())
    one = "contact.friction=0.1"
    quietly(Loads.of(scene(one, f"load_case=[{', '.join(cases)}]")), tmp_path / "both")
    assert len(calls) == 1
    quietly(Loads.of(scene(one, "pair.misalignment_um=15"), (100.0,)), tmp_path / "open")
    aligned, tilted = LOADS.read(tmp_path / "both")
    assert (aligned.case, aligned.misalignment_um) == ("a", 0.0)
    assert_same_rows(unnamed([tilted]), unnamed(LOADS.read(tmp_path / "open")), 1e-8)
    assert tilted.face_load_factor > 1.05 * aligned.face_load_factor


def test_power_is_lost_at_the_speed_of_the_load_case(tmp_path: Path) -> None:
    """170 N·m at 500 and 3000 r/min are 8901.179 and 53407.075 W, of which the loss in percent is lost, which does not
    depend on the speed; without a speed there is no power but that at 1000 r/min."""
    quietly(Losses.of(line_scene(DUTY)), tmp_path)
    light, slow, fast = LOSSES.read(tmp_path)
    assert [row.case for row in (light, slow, fast)] == ["light", "slow", "fast"]
    assert [row.share_of_life for row in (light, slow, fast)] == [0.25, 0.25, 0.5]
    for row, power in ((slow, 8901.17919), (fast, 53407.0751)):
        assert row.input_W == pytest.approx(power, rel=1e-8)
        assert row.loss_W == pytest.approx(0.01 * row.loss_percent * power, rel=1e-7)
        assert row.loss_W_error == pytest.approx(0.01 * row.loss_percent_error * power, rel=1e-7)
    assert fast.loss_percent == pytest.approx(slow.loss_percent, rel=1e-8)
    assert all(math.isnan(value) for value in (light.speed_rpm, light.input_W, light.loss_W, light.loss_W_error))
    said = list(loss_lines(tmp_path))
    assert said[1].startswith("slow, 170 N·m on the pinion") and f"{slow.loss_W:.1f} ± " in said[1]
    assert "W at 500 r/min" in said[1] and "W at 3000 r/min" in said[2] and len(said) == 3


def test_runs_of_load_cases_are_resumed_and_drawn_again(tmp_path: Path) -> None:
    """Interrupted after half of the results: the tables of a call that was not; each load case has a folder by its
    name; the scene of the folder repeats the list; pictures are drawn again byte by byte. A load case of another name
    is another run, of another torque another scene; a run whose folder has gone is left out of the picture."""
    drawn, plain = (line_scene(DUTY, BARE, f"output.pictures={each}") for each in ("true", "false"))
    with interrupted(0) as counts:
        quietly(Loads.of(drawn), tmp_path / "whole")
    with interrupted(counts["stored"] // 2), pytest.raises(Interrupted):
        quietly(Loads.of(plain), tmp_path / "half")
    quietly(Loads.of(plain), tmp_path / "half", resume=True)
    assert same_tables(tmp_path / "half", tmp_path / "whole")
    folders = sorted(path.parent.name for path in (tmp_path / "whole").glob("*/summary.json"))
    assert folders == ["load_fast", "load_light", "load_slow"]
    assert Loads.of(load_scene(tmp_path / "whole/scene.toml")) == Loads.of(drawn)
    assert redrawn(tmp_path / "whole", tmp_path) == {"loads.png"}
    with interrupted(0) as counts:
        quietly(Loads.of(line_scene(DUTY.replace("3000.0", "2500.0"), BARE)), tmp_path / "half", resume=True)
        assert counts["stored"] == 0  # the speed is in the tables alone
        quietly(Loads.of(line_scene(DUTY.replace("slow", "slower"), BARE)), tmp_path / "half", resume=True)
        assert counts["stored"] > 0
    with pytest.raises(ArchiveError, match=r"load\.torque_Nm = 160 \(kept: 170\)"):
        quietly(Loads.of(line_scene(DUTY.replace("slow\", torque_Nm = 170", "slow\", torque_Nm = 160"))),
                tmp_path / "whole", resume=True)
    rmtree(tmp_path / "half/load_light")
    assert [each.row.case for each in LoadRuns().read(tmp_path / "half")] == ["slower", "fast"]


def test_losses_of_other_load_cases_are_named(tmp_path: Path) -> None:
    """Resumed with other torques: their keys, not the torques that follow; with other speeds nothing is solved."""
    quietly(Losses.of(line_scene(SAME)), tmp_path)
    with interrupted(0) as counts:
        quietly(Losses.of(line_scene(SAME.replace("85.0", "85.0, speed_rpm = 100.0"))), tmp_path, resume=True)
        assert counts["stored"] == 0
    assert LOSSES.read(tmp_path)[0].speed_rpm == 100.0
    with pytest.raises(ArchiveError, match=r"this one has load_case\[1\]\.torque_Nm = 80 \(kept: 85\), .*speed_rpm"):
        quietly(Losses.of(line_scene(SAME.replace("85.0", "80.0"))), tmp_path, resume=True)


def test_torques_of_one_mesh_are_of_one_misalignment(tmp_path: Path) -> None:
    """Load cases of one torque are one torque of an excitation, under all their names; they may all be misaligned, also
    otherwise than the pair. Different misalignments are refused, with what takes them."""
    loads = Excitation.of(line_scene(DUTY)).loads
    assert loads.torques == (85e3, 170e3) and loads.cases == ("light", "slow, fast")
    alike = Excitation.of(line_scene(TILTED.replace("85.0", "85.0, misalignment_um = 5.0")))
    assert alike.scene.pair.misalignment_um == 5.0 and not alike.loads.problem.is_plane
    for kind in (Excitation, Design):
        with pytest.raises(SceneError, match=r"load_case\.misalignment_um: found \[0, 5\]; .*`evolvent loads` or"):
            kind.of(line_scene(VARY, TILTED))


@pytest.mark.parametrize(("command", "words", "said"), [
    ("loads", ("--percent", "50"), "--percent: found [50] beside the sections [[load_case]]"),
    ("losses", ("--set", "load.percents=[50.0]"), "load_case: found load cases, and load.percents = [50] beside"),
    ("excitation", (), "load_case.misalignment_um: found [0, 5]"),
])
def test_what_is_refused_leaves_no_folder(
    command: str, words: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 2 and the reason, before anything is written."""
    scene, out = str(ROOT / "demos/he2022.toml"), tmp_path / "out"
    assert main([command, scene, "--out", str(out), "--set", TILTED, *words]) == Exit.BAD_INPUT
    assert said in capsys.readouterr().err and not out.exists()


def test_loads_in_space_are_said() -> None:
    """A spur pair that is misaligned under one of its loads: both commands warn."""
    for kind in (Loads, Losses):
        said = list(kind.of(line_scene(TILTED)).warnings())
        assert any(each.startswith("In space under all loads") for each in said)


def small(kind: type[Computation[Any]]) -> Computation[Any]:
    """A list of three load cases."""
    return kind.of(line_scene(DUTY, BARE))


@pytest.mark.mpi
def test_results_do_not_depend_on_ranks(tmp_path: Path, run_script: RunScript) -> None:
    """The tables of one rank and of two."""
    done = run_script(__file__, str(tmp_path / "ranks"), ranks=2, timeout=300.0)
    assert done.returncode == 0, done.stderr[-3000:]
    for kind in (Loads, Losses):
        quietly(small(kind), tmp_path / kind.name)
        assert same_tables(tmp_path / "ranks" / kind.name, tmp_path / kind.name)


if __name__ == "__main__":
    for each in (Loads, Losses):
        quietly(small(each), Path(sys.argv[1]) / each.name)
