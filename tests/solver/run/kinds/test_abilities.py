"""What every computation can do, whichever it is: it is resumed, leaves its scene, log and cost, is drawn again, is
certified, and is known to the command line and to studies.

Problem: He's spur pair in plane strain, a few positions of a pitch on coarse meshes. Exact: a call that was interrupted
and resumed gives the tables of one that was not, within the difference of two runs (docs/checks.md), and solves nothing
again.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from evolvent.commands.app import COMMANDS
from evolvent.dynamics.excitation import loaded_mesh
from evolvent.gears.solution import certificates
from evolvent.gears.solution.certificates import PitchImbalance
from evolvent.gears.sweep import pitch_sweep
from evolvent.results.archive.store import Store
from evolvent.run.computation import Computation
from evolvent.run.kinds.all import KINDS, Kind
from evolvent.run.study.plan.study_file import COMPUTATIONS
from evolvent.scene.scene import load_scene
from evolvent.wear.gears import gear_wear
from tests.support.gear_cases import spur_scene
from tests.support.quiet import quietly
from tests.support.running.patches import calling_first
from tests.support.running.redrawn import redrawn
from tests.support.same_tables import same_tables

SMALL = (
    "mesh.level=quick", "sweep.positions=4", "contact.friction=[0.1]", "output.error_bars=true",
    "output.animation=false", "output.fields=false",
)
MORE: Mapping[str, tuple[str, ...]] = {
    "wear": ("wear.cycles=1e5", "wear.pinion_mm2_per_N=1e-12", "wear.wheel_mm2_per_N=1e-12"),
    "dynamics": ("dynamics.speeds=3", "dynamics.torque_percents=[50,100]", "dynamics.backlash_um=50"),
    "transient": ("transient.speeds_rpm=[1000,2000]", "transient.mesh_periods=3"),
}
SOLVED = (pitch_sweep, "shared_position"), (loaded_mesh, "shared_position"), (gear_wear, "shared_position")
"""Functions that solve a position, where they are called."""


class Interrupted(BaseException):
    """Raised in place of a signal."""


def computation_of(kind: Kind, *settings: str) -> Computation[Any]:
    return kind.load().of(spur_scene(*SMALL, *MORE.get(kind.name, ()), *settings), (50.0, 100.0))


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Number of positions that were solved, and of results that were stored."""
    counts: Counter[str] = Counter()
    for module, name in SOLVED:
        counted = calling_first(getattr(module, name), lambda *_, **__: counts.update(["positions"]))
        monkeypatch.setattr(module, name, counted)
    monkeypatch.setattr(Store, "write", calling_first(Store.write, lambda *_, **__: counts.update(["stored"])))
    return counts


@pytest.fixture(scope="module", params=KINDS, ids=lambda kind: kind.name)
def kind(request: pytest.FixtureRequest) -> Kind:
    found: Kind = request.param
    return found


@pytest.fixture(scope="module")
def whole(kind: Kind, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a computation that was not interrupted."""
    folder = tmp_path_factory.mktemp(kind.name)
    quietly(computation_of(kind), folder)
    return folder


def test_interrupted_computation_solves_nothing_again(
    kind: Kind, whole: Path, tmp_path: Path, solved: Counter[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted as half of its results are stored, resumed: as many positions in all as without interruption, and the
    same tables; once it is complete, nothing is solved."""
    quietly(computation_of(kind), tmp_path / "counted")
    wanted, half = solved["positions"], solved["stored"] // 2
    assert wanted > 3 and half > 1
    solved.clear()
    write = Store.write

    def interrupted(store: Store, *given: Any) -> None:
        write(store, *given)
        if solved["stored"] == half:
            raise Interrupted

    with monkeypatch.context() as patch:
        patch.setattr(Store, "write", interrupted)
        with pytest.raises(Interrupted):
            quietly(computation_of(kind), tmp_path / "out")
    assert 0 < solved["positions"] < wanted
    quietly(computation_of(kind), tmp_path / "out", resume=True)
    assert solved["positions"] == wanted
    assert same_tables(tmp_path / "out", whole)
    quietly(computation_of(kind), tmp_path / "out", resume=True)
    assert solved["positions"] == wanted and same_tables(tmp_path / "out", whole)


def test_folder_has_scene_log_and_cost(kind: Kind, whole: Path) -> None:
    """The scene that repeats it, its log to the end, and what it has cost under the name of its command."""
    assert kind.load().of(load_scene(whole / "scene.toml")) == computation_of(kind)
    assert "done in " in (whole / "run.log").read_text(encoding="utf-8")
    cost = json.loads((whole / "results/cost.json").read_text(encoding="utf-8"))
    assert cost["command"] == kind.command
    assert cost["timings"]["total"] > 0.0 and cost["memory_MB"] > 1.0


def test_every_picture_is_drawn_again(kind: Kind, whole: Path, tmp_path: Path) -> None:
    """Of a call that is resumed for its pictures alone: `evolvent plot` draws each of them, byte by byte."""
    out = copytree(whole, tmp_path / "out")
    quietly(computation_of(kind, "output.pictures=true"), out, resume=True)
    pictures = {path.name for path in (out / "pictures").iterdir()}
    assert pictures and redrawn(out, tmp_path) == pictures


def test_folder_is_that_of_one_command(kind: Kind, whole: Path, tmp_path: Path) -> None:
    """All tables and pictures that the computation declares are there, but those that a scene has to ask for; it leaves
    no others."""
    outputs = kind.load().outputs
    patterns = "*.csv", "*.json", "pictures/*"
    found = {path.relative_to(whole).as_posix() for pattern in patterns for path in whole.glob(pattern)}
    assert outputs.tables[0] in found
    runs = {"pictures"} if kind.command == "run" else set()
    assert {name for name in found if name.partition("/")[0] not in runs} <= set(outputs.results)


def test_pitch_out_of_balance_is_an_error(kind: Kind, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Energy that no pitch can balance, before deflection and on deflected flanks: no table is written."""
    monkeypatch.setattr(certificates, "BALANCE_LIMIT", -1.0)
    with pytest.raises(PitchImbalance, match="wanted an energy balance within"):
        quietly(computation_of(kind), tmp_path)
    assert not list(tmp_path.glob("*.csv"))


def test_command_line_and_studies_know_it(kind: Kind) -> None:
    """Its command, and its name in a study; a load list is itself one of several scenes."""
    assert kind.command in {command.name for command in COMMANDS}
    assert (kind.name in COMPUTATIONS) == (kind.name != "loads")
    assert kind.load().name == kind.name and kind.load().command == kind.command
