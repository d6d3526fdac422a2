"""Excitation scenes that differ in misalignment only, solved together in this process."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from evidence.tables import read_csv
from evolvent.dynamics.excitation import misaligned_mesh
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.misaligned_position import misaligned_on
from evolvent.gears.sweep.position_search import SharedPosition
from evolvent.run.study.misalignment_line import line_name, solve_line
from evolvent.run.study.results.scene_record import SceneRecord, scene_folder
from evolvent.run.study.scene_task import SceneTask, condense, solve
from tests.support.checkout import ROOT
from tests.support.running.study_cases import scenes_of

LINE = f"""
scene = "{ROOT / "evidence/benchmarks/accuracy/scenes/narrow_helical.toml"}"
compute = "excitation"

[set]
mesh.elements_per_contact_width = 0.5
mesh.order = 1
contact.friction = 0.0
sweep.positions = 4

[grid]
pair.misalignment_um = [4.0, -4.0, 0.0]
"""


def tasks(folder: Path, text: str = LINE, compute: str = "excitation") -> list[SceneTask]:
    """Of all scenes, into folder/scenes."""
    found = scenes_of(folder, text)
    return [SceneTask(each.name, scene_folder(folder, each.name), compute, each.scene) for each in found if each.scene]


def values(task: SceneTask, column: str) -> dict[tuple[str, str], float]:
    """A column of a scene's harmonics.csv, by quantity and harmonic."""
    rows = read_csv(task.folder / "harmonics.csv")
    return {(row["quantity"], row["harmonic"]): float(row[column]) for row in rows}


@dataclass(frozen=True)
class Solved:
    """A line that was solved together, and how often a scene took the search of another one."""

    tasks: list[SceneTask]
    records: list[SceneRecord]
    taken: int


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> Solved:
    """The three scenes of LINE."""
    used: list[object] = []

    def counted(model: GearModel, shared: SharedPosition) -> SharedPosition | None:
        used.append(model)
        return misaligned_on(model, shared)

    together = tasks(tmp_path_factory.mktemp("line"))
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(misaligned_mesh, "misaligned_on", counted)
        return Solved(together, solve_line(together, condense(together)), len(used))


def test_a_line_is_solved_together(line: Solved, tmp_path: Path) -> None:
    """Three scenes: two of the three misalignments take the search of the middle one, on both meshes of four
    positions. Figures are those of scenes solved alone within their error bars, the middle one's to rounding."""
    assert [record.status for record in line.records] == ["done"] * 3
    assert line.taken == 2 * 4 * 2
    for task, alone in zip(line.tasks, tasks(tmp_path)):
        assert solve(alone).status == "done"
        found, exact, bars = values(task, "mean"), values(alone, "mean"), values(alone, "mean_error")
        for key, value in exact.items():
            allowed = bars[key] if task.scene.pair.misalignment_um and key[0] != "unloaded_transmission_error_um" else 0
            assert found[key] == pytest.approx(value, abs=0.1 * allowed, rel=1e-6)


def test_scenes_that_are_done_are_left(line: Solved, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line again: nothing is searched, the records are the same."""
    monkeypatch.setattr(misaligned_mesh, "shared_position", None)
    assert solve_line(line.tasks, condense(line.tasks)) == line.records


def test_names_of_lines(tmp_path: Path) -> None:
    """Misalignment does not count, the torque does; other computations have no lines."""
    grid = LINE + "load.torque_Nm = [100.0, 200.0]\n"
    names = [line_name(task) for task in tasks(tmp_path, grid)]
    assert len(set(names)) == 2 and names[0] == names[2] == names[4] != names[1]
    strength = tasks(tmp_path, grid.replace('"excitation"', '"strength"'), "strength")
    assert [line_name(task) for task in strength] == [task.name for task in strength]
