"""What every computation can do, whichever it is: it is resumed, leaves its scene, log and cost, is drawn again, is
certified, does not depend on the number of ranks, and is known to the command line and to studies.

Problem: the small scene of `tests.support.computing.small_kinds`. Exact: a call that was interrupted and resumed, or
that several ranks have computed, gives the tables of one that was not, within the difference of two runs
(docs/checks.md), and solves nothing again.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from shutil import copytree

import pytest

from evolvent.commands.app import COMMANDS
from evolvent.dynamics.excitation import loaded_mesh
from evolvent.gears.solution import certificates
from evolvent.gears.solution.certificates import PitchImbalance
from evolvent.gears.sweep import pitch_sweep
from evolvent.results.archive.run_folder import FolderError
from evolvent.results.archive.store import ArchiveError
from evolvent.run.kinds.all import KINDS, Kind
from evolvent.run.study.plan.study_file import COMPUTATIONS
from evolvent.scene.scene import load_scene
from evolvent.wear.gears import gear_wear
from tests.support.computing.interruption import Interrupted, interrupted
from tests.support.computing.quiet import quietly
from tests.support.computing.redrawn import redrawn
from tests.support.computing.same_tables import same_tables
from tests.support.computing.small_kinds import small
from tests.support.running.patches import calling_first
from tests.support.running.processes import RunScript

SOLVING = pitch_sweep, loaded_mesh, gear_wear
"""Modules that solve positions by `shared_position`."""


@dataclass(frozen=True)
class Whole:
    """A computation that was not interrupted."""

    folder: Path
    """Folder of the computation."""
    counts: Counter[str]
    """Number of positions that were solved, and of results that were stored."""


@contextmanager
def counted(interrupted_after: int = 0) -> Iterator[Counter[str]]:
    """Counts solved positions and stored results. interrupted_after: number of results after which the call ends."""
    with interrupted(interrupted_after) as counts, pytest.MonkeyPatch.context() as patch:
        for module in SOLVING:
            solved = calling_first(module.shared_position, lambda *_, **__: counts.update(["positions"]))
            patch.setattr(module, "shared_position", solved)
        yield counts


@pytest.fixture(scope="module", params=KINDS, ids=lambda kind: kind.name)
def kind(request: pytest.FixtureRequest) -> Kind:
    found: Kind = request.param
    return found


@pytest.fixture(scope="module")
def whole(kind: Kind, tmp_path_factory: pytest.TempPathFactory) -> Whole:
    folder = tmp_path_factory.mktemp(kind.name)
    with counted() as counts:
        quietly(small(kind), folder)
    return Whole(folder, counts)


@pytest.fixture(scope="module")
def ranks_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("ranks")


@pytest.fixture
def on_two_ranks(run_script: RunScript, ranks_folder: Path) -> Path:
    """A folder with those of all computations, by one process of mpirun with two ranks, which the first test starts."""
    if not any(ranks_folder.iterdir()):
        done = run_script("-m", "tests.support.computing.small_kinds", str(ranks_folder), ranks=2, timeout=900.0)
        assert done.returncode == 0, done.stderr[-3000:]
    return ranks_folder


def test_interrupted_computation_solves_nothing_again(kind: Kind, whole: Whole, tmp_path: Path) -> None:
    """Interrupted as half of its results are stored, resumed: as many positions in all as without interruption, and the
    same tables; once it is complete, nothing is solved."""
    wanted, half = whole.counts["positions"], whole.counts["stored"] // 2
    assert wanted > 3 and half > 1
    with counted(half) as counts:
        with pytest.raises(Interrupted):
            quietly(small(kind), tmp_path)
        assert 0 < counts["positions"] < wanted
        quietly(small(kind), tmp_path, resume=True)
        assert counts["positions"] == wanted
        assert same_tables(tmp_path, whole.folder)
        quietly(small(kind), tmp_path, resume=True)
        assert counts["positions"] == wanted and same_tables(tmp_path, whole.folder)


@pytest.mark.mpi
def test_results_do_not_depend_on_ranks(kind: Kind, whole: Whole, on_two_ranks: Path) -> None:
    """The tables of one rank and of two."""
    assert same_tables(on_two_ranks / kind.name, whole.folder)


def test_folder_has_scene_log_and_cost(kind: Kind, whole: Whole) -> None:
    """The scene that repeats it, its log to the end, and what it has cost under the name of its command: the whole and,
    but for a list, whose runs have costs of their own, each stage."""
    assert kind.load().of(load_scene(whole.folder / "scene.toml")) == small(kind)
    assert "done in " in (whole.folder / "run.log").read_text(encoding="utf-8")
    cost = json.loads((whole.folder / "results/cost.json").read_text(encoding="utf-8"))
    assert cost["command"] == kind.command
    assert cost["timings"]["total"] > 0.0 and cost["memory_MB"] > 1.0
    stages = [cost["timings"][stage] for stage in ("mesh", "assemble", "factor", "positions")]
    assert kind.load().is_list or min(stages) > 0.0
    assert sum(stages) <= cost["timings"]["total"]


def test_results_are_not_replaced_unasked(kind: Kind, whole: Whole) -> None:
    """A second call is refused, and says what to do."""
    before = {path: path.stat().st_mtime_ns for path in whole.folder.rglob("*")}
    with pytest.raises(FolderError, match="--resume goes on from them, --overwrite removes them and computes anew"):
        quietly(small(kind), whole.folder)
    assert {path: path.stat().st_mtime_ns for path in whole.folder.rglob("*")} == before


def test_another_scene_is_not_resumed(kind: Kind, whole: Whole) -> None:
    """Resumed with another torque: refused, and the folder stays as it is."""
    before = {path: path.stat().st_mtime_ns for path in whole.folder.rglob("*")}
    with pytest.raises(ArchiveError, match=r"load\.torque_Nm|of another one|other gears"):
        quietly(small(kind, "load.torque_Nm=111"), whole.folder, resume=True)
    assert {path: path.stat().st_mtime_ns for path in whole.folder.rglob("*")} == before


def test_foreign_files_stay(kind: Kind, tmp_path: Path) -> None:
    """A file of the name of a table that no call has written: refused before anything is computed, also with
    --overwrite."""
    table = tmp_path / kind.load().outputs.tables[0]
    table.write_text("mine", encoding="utf-8")
    with pytest.raises(FolderError, match=table.name):
        quietly(small(kind), tmp_path, overwrite=True)
    assert table.read_text(encoding="utf-8") == "mine"


def test_every_picture_is_drawn_again(kind: Kind, whole: Whole, tmp_path: Path) -> None:
    """A call is resumed for its pictures alone: `evolvent plot` draws each of them again, byte by byte."""
    out = copytree(whole.folder, tmp_path / "out")
    quietly(small(kind, "output.pictures=true"), out, resume=True)
    pictures = {path.name for path in (out / "pictures").iterdir()}
    assert pictures and redrawn(out, tmp_path) == pictures


def test_files_are_declared(kind: Kind, whole: Whole) -> None:
    """The computation leaves no tables and pictures but those that it declares."""
    outputs = kind.load().outputs
    found = {path.name for pattern in ("*.csv", "*.json") for path in whole.folder.glob(pattern)}
    assert outputs.tables[0] in found and found <= set(outputs.results)


def test_pitch_out_of_balance_is_an_error(kind: Kind, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Energy that no pitch can balance, before deflection and on deflected flanks: no table is written."""
    monkeypatch.setattr(certificates, "BALANCE_LIMIT", -1.0)
    with pytest.raises(PitchImbalance, match="wanted an energy balance within"):
        quietly(small(kind), tmp_path)
    assert not list(tmp_path.glob("*.csv"))


def test_command_line_and_studies_know_it(kind: Kind) -> None:
    """Command line and studies name each computation; a load list and a design are themselves of several scenes."""
    assert kind.command in {command.name for command in COMMANDS}
    assert (kind.name in COMPUTATIONS) == (kind.name not in ("loads", "design"))
    assert kind.load().name == kind.name and kind.load().command == kind.command
