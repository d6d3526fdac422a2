"""A scene under a list of loads: folders, table and picture, resuming, refusals. He's spur pair, three positions."""

from __future__ import annotations

import csv
import json
from dataclasses import fields
from pathlib import Path

import pytest

from evolvent.commands.app import Exit, main
from evolvent.gears import shared_gears as gear_loads
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError
from evolvent.results.tables.load_table import LoadRow
from evolvent.run.kinds.loads import Loads
from evolvent.run.kinds.losses import Losses
from evolvent.run.kinds.run import Run
from evolvent.scene.scene import SceneError, load_scene
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import spur_scene

SHORT = (
    "mesh.level=quick", "sweep.positions=3", "contact.friction=[0.0]", "output.pictures=false", "output.fields=false",
    "output.animation=false", "output.error_bars=true",
)


def test_each_load_is_a_run_of_its_own_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half and all of the torque: two folders with the torque in their summaries, a line each in the table that repeats
    their figures; the gears and their coarse companion are condensed once each. Resumed, nothing is condensed. The
    scene that a run leaves gives the same figures alone."""
    calls, condensed = [], gear_loads.condensed_gears

    def counted(*given: object, **named: object) -> object:
        calls.append(given)
        return condensed(*given, **named)  # type: ignore[arg-type]

    monkeypatch.setattr(gear_loads, "condensed_gears", counted)
    scene, out = spur_scene(*SHORT), tmp_path / "out"
    assert quietly(Loads.of(scene, [50.0, 100.0]), out) == []
    assert len(calls) == 2
    with open(out / "loads.csv", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    folders = [out / name for name in ("load_050.0_percent", "load_100.0_percent")]
    torque = scene.load.torque_Nm
    assert list(rows[0]) == [field.name for field in fields(LoadRow)]
    assert [float(row["torque_Nm"]) for row in rows] == [0.5 * torque, torque]
    for row, folder in zip(rows, folders):
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        (figures,) = summary["frictions"]
        assert int(row["tip_edge_positions"]) == sum(each["tip_edge"] for each in summary["positions"])
        assert int(row["warnings"]) == len(summary["warnings"]) > 0
        assert row["max_pressure_at_zone_end"] == str(figures["max_pressure_at_zone_end"])
        cells = summary["mesh"]["cells_across_contact_width"]
        assert float(row["cells_across_contact_width"]) == pytest.approx(cells, rel=1e-8)
        for key in ("transmission_error_peak_to_peak_um", "max_pressure_MPa"):
            assert float(row[key]) == pytest.approx(figures[key], rel=1e-8)
            assert float(row[key + "_error"]) == pytest.approx(figures["estimated_error"][key], rel=1e-8)
    quietly(Loads.of(scene, [50.0, 100.0]), out, resume=True)
    assert len(calls) == 2
    quietly(Run.of(load_scene(folders[0] / "scene.toml")), tmp_path / "alone")
    alone, found = (
        json.loads((folder / "summary.json").read_text(encoding="utf-8"))["frictions"][0]
        for folder in (tmp_path / "alone", folders[0])
    )
    assert alone["max_pressure_MPa"] == pytest.approx(found["max_pressure_MPa"], rel=1e-6)


def test_resuming_with_a_heavier_load_is_refused_before_anything_is_computed(tmp_path: Path) -> None:
    """Its meshes serve other torques, so that no kept result would fit: the error names the key and the command, and no
    folder is made for the new load."""
    scene = spur_scene(*SHORT)
    quietly(Loads.of(scene, [50.0, 100.0]), tmp_path)
    with pytest.raises(ArchiveError, match=r"mesh_torques_Nm(.|\n)*`evolvent loads \.\.\. --overwrite`"):
        quietly(Loads.of(scene, [50.0, 100.0, 120.0]), tmp_path, resume=True)
    assert not (tmp_path / "load_120.0_percent").exists()


def test_each_load_has_a_folder_of_its_own() -> None:
    """Loads that differ by less than a tenth of a percent, the heaviest first. Exact."""
    scenes = Loads.of(spur_scene(*SHORT), [5.0, 12.51, 12.54, 100.0]).runs
    names = ["load_100.0_percent", "load_012.54_percent", "load_012.51_percent", "load_005.0_percent"]
    assert list(scenes) == names


def test_gears_that_wear_have_no_load_list() -> None:
    """The remedy is named."""
    wearing = ("wear.cycles=1e5", "wear.pinion_mm2_per_N=1e-12", "wear.wheel_mm2_per_N=1e-12")
    with pytest.raises(SceneError, match="without \\[wear\\]"):
        Loads.of(spur_scene(*SHORT, *wearing), [50.0, 100.0])


@pytest.mark.parametrize("percents", ["0,50", "50,50", "fifty", "2000"])
def test_impossible_percentages_are_refused(percents: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 2 before anything is written."""
    status = main(["loads", "demos/first_pair.toml", "--out", str(tmp_path / "out"), "--percent", percents])
    assert status == Exit.BAD_INPUT and "--percent" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_torque_beyond_those_of_the_meshes_is_refused() -> None:
    """A scene whose meshes serve 1 to 2 N·m only."""
    with pytest.raises(SceneError, match="mesh_torques_Nm"):
        spur_scene(*SHORT, "load.mesh_torques_Nm=[1.0,2.0]")


@pytest.mark.parametrize("kind", [Loads, Losses])
def test_results_of_a_list_stay_until_its_gears_are_condensed(
    kind: type[Loads] | type[Losses], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Gears that cannot be condensed: `--overwrite` removes no earlier table, as of all other commands."""

    def without_memory(*_: object) -> None:
        raise MemoryError("no memory")

    monkeypatch.setattr(gear_loads, "condensed_gears", without_memory)
    (table,) = kind.outputs.tables
    RunFolder(tmp_path).write_text(table, "of an earlier call\n")
    with pytest.raises(MemoryError, match="no memory"):
        quietly(kind.of(spur_scene(*SHORT, "contact.friction=0.1"), [50.0, 100.0]), tmp_path, overwrite=True)
    assert (tmp_path / table).read_text() == "of an earlier call\n" and not (tmp_path / "scene.toml").exists()
