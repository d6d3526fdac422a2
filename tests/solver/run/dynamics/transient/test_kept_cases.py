"""`evolvent transient --resume`: He's pair in plane strain at one speed and two friction coefficients."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.results.archive.run_folder import FolderError
from evolvent.results.archive.store import ArchiveError, arrays_bytes, read_arrays
from evolvent.run import kept_pitch
from evolvent.run.dynamics.transient import cases as module
from evolvent.run.dynamics.transient.kept_cases import KeptCases, another
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import Scene, load_scene
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.computing.same_tables import same_tables
from tests.support.running.processes import RunScript, on_ranks

TABLES = "transient.csv", "transient_teeth.csv", "transient.json"
SETTINGS = (
    "mesh.level=quick", "sweep.positions=6", "contact.friction=[0.0,0.2]", "transient.speeds_rpm=[2000]",
    "dynamics.backlash_um=50", "output.pictures=false", "output.animation=false", "transient.mesh_periods=2",
)
WHOLE = "import sys; from evolvent.commands.app import main; sys.exit(main(sys.argv[1:]))"
STOPPED = """
import sys
from mpi4py import MPI
from evolvent.commands.app import main
from evolvent.run.dynamics.transient import cases

def stopped(*given):
    raise RuntimeError("stopped")

if MPI.COMM_WORLD.rank == MPI.COMM_WORLD.size - 1:
    cases.until_steady = stopped
sys.exit(main(sys.argv[1:]))
"""
"""A run whose last rank ends in its first case."""


class Killed(Exception):
    """A call ends here."""


def stopped(*given: object) -> None:
    raise Killed


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022.toml", [*SETTINGS, *settings])


def kept(folder: Path) -> list[str]:
    """Names of the stored cases."""
    return sorted(path.name for path in (folder / "results").glob("transient_*.npz"))


def unsolved(*_: object) -> None:
    pytest.fail("statics solved again")


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("transient")
    quietly(Transient.of(scene()), folder)
    return folder


def test_another_scene_is_named_by_its_keys(tmp_path: Path) -> None:
    """The scene of the call that has ended is there: the torque with both values; without it, or where it cannot be
    read, there are none."""
    wanted, path = scene("load.torque_Nm=90"), tmp_path / "results/transient_static.npz"
    assert "found that of another one; --resume" in another(wanted, path)
    (tmp_path / "scene.toml").write_text(scene().resolved_toml(), encoding="utf-8")
    torque = f"{scene().load.torque_Nm:g}"
    assert f"found that of another one: this one has load.torque_Nm = 90 (kept: {torque});" in another(wanted, path)
    (tmp_path / "scene.toml").write_text("no scene", encoding="utf-8")
    assert "found that of another one; --resume" in another(wanted, path)


@pytest.mark.evidence
def test_stopped_call_goes_on(out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Killed in the second of two cases and resumed: statics and the first case are not computed again, and the tables
    are those of a call that was not stopped; also where the companion is killed in its third motion of four, and when
    resumed once more, where nothing is missing. Another scene is refused."""
    counts: list[int] = []
    solved = module.until_steady

    def counted(*given: Any) -> MeshPeriods:
        counts.append(1)
        if len(counts) in (2, 6):
            raise Killed
        return solved(*given)

    monkeypatch.setattr(module, "until_steady", counted)
    with pytest.raises(Killed):
        quietly(Transient.of(scene()), tmp_path)
    assert kept(tmp_path) == ["transient_2000rpm_0.npz"]
    with pytest.raises(FolderError, match=r"found the results of an earlier call \(results/state\.npz\)"):
        quietly(Transient.of(scene()), tmp_path)
    with pytest.raises(ArchiveError, match="found that of another one"):
        quietly(Transient.of(scene("transient.mesh_periods=50")), tmp_path, resume=True)
    with pytest.raises(Killed):
        quietly(Transient.of(scene()), tmp_path, resume=True)
    assert kept(tmp_path) == [
        "transient_2000rpm_0.npz", "transient_2000rpm_1.npz", "transient_finer_2000rpm_0.npz",
        "transient_finer_2000rpm_1.npz",
    ]
    monkeypatch.setattr(kept_pitch, "sweep_until_periodic", unsolved)
    said = quietly(Transient.of(scene()), tmp_path, resume=True)
    assert len(counts) == 2 + 4 + 2
    assert same_tables(tmp_path, out)
    monkeypatch.setattr(module, "until_steady", None)
    assert quietly(Transient.of(scene()), tmp_path, resume=True) == said
    assert same_tables(tmp_path, out)


def test_overwriting_begins_anew(out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Cases of an earlier call are gone before any other is computed."""
    earlier = KeptCases.of(scene(), scene().gear_pair(), tmp_path)
    earlier.write(1, KeptCases.of(scene(), earlier.pair, out).read()[1])
    assert kept(tmp_path) == ["transient_2000rpm_1.npz"]
    monkeypatch.setattr(module, "resolved_modes", stopped)
    with pytest.raises(Killed):
        quietly(Transient.of(scene()), tmp_path, overwrite=True)
    assert kept(tmp_path) == []


def test_error_bars_that_are_asked_for_later(out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a call without them nothing is computed again but the companion; the tables are those of a call with them.
    """
    quietly(Transient.of(scene("output.error_bars=false")), tmp_path)
    assert kept(tmp_path) == ["transient_2000rpm_0.npz", "transient_2000rpm_1.npz"]
    assert not same_tables(tmp_path, out)
    counts: list[int] = []
    solved = module.until_steady

    def counted(*given: Any) -> MeshPeriods:
        counts.append(1)
        return solved(*given)

    monkeypatch.setattr(module, "until_steady", counted)
    quietly(Transient.of(scene()), tmp_path, resume=True)
    assert len(counts) == 4
    assert same_tables(tmp_path, out)


@pytest.mark.parametrize(
    ("modes", "speeds", "more"),
    [((), (2000,), (900, 2000)), (("transient.modes_per_harmonic=1",), (2000,), (2000, 2600))],
)
def test_speeds_that_are_added_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, modes: tuple[str, ...], speeds: tuple[int, ...],
    more: tuple[int, ...],
) -> None:
    """A lower speed before the first one; a higher one where the modes do not follow from it: that one alone is
    computed, without its statics, and the tables are those of one call with both speeds."""

    def of(each: tuple[int, ...]) -> Scene:
        few = ("contact.friction=0", "output.error_bars=false", *modes)
        return scene(*few, f"transient.speeds_rpm={list(each)}")

    whole, grown = tmp_path / "whole", tmp_path / "grown"
    quietly(Transient.of(of(more)), whole)
    quietly(Transient.of(of(speeds)), grown)
    counts: list[str] = []
    solved = module.until_steady

    def counted(*given: Any) -> MeshPeriods:
        counts.append(given[0].name)
        return solved(*given)

    monkeypatch.setattr(module, "until_steady", counted)
    monkeypatch.setattr(kept_pitch, "sweep_until_periodic", unsolved)
    quietly(Transient.of(of(more)), grown, resume=True)
    assert len(counts) == 1 and str(*(set(more) - set(speeds))) in counts[0]
    assert same_tables(grown, whole)


def test_a_higher_speed_resolves_other_modes(out: Path, tmp_path: Path) -> None:
    """By default the natural modes follow from the highest speed: kept cases are not those of the longer list, and the
    message says what may be added."""
    earlier = KeptCases.of(scene(), scene().gear_pair(), out)
    faster = KeptCases.of(scene("transient.speeds_rpm=[2000,2600]"), earlier.pair, out)
    with pytest.raises(ArchiveError, match="lower speeds may be added"):
        faster.read()
    assert sorted(KeptCases.of(scene("transient.speeds_rpm=[900,2000]"), earlier.pair, out).read()) == [2, 3]


def test_nothing_to_go_on_from_is_said(tmp_path: Path) -> None:
    """The call begins from the start, with a sentence."""
    few = scene("contact.friction=0", "output.error_bars=false")
    said = quietly(Transient.of(few), tmp_path, resume=True)
    assert said[0].startswith("--resume found nothing to continue")


def test_a_case_that_cannot_be_read_is_refused(out: Path, tmp_path: Path) -> None:
    """One of another version lacks an array: it is named, with --overwrite."""
    cases = KeptCases.of(scene(), scene().gear_pair(), tmp_path)
    found = KeptCases.of(scene(), cases.pair, out).read()
    assert sorted(found) == [0, 1]
    cases.write(0, found[0])
    path = tmp_path / "results/transient_2000rpm_0.npz"
    arrays = read_arrays(path)
    del arrays["energies"]
    path.write_bytes(arrays_bytes(arrays))
    with pytest.raises(ArchiveError, match="some without 'energies'; compute anew with --overwrite"):
        cases.read()


@pytest.mark.evidence
@pytest.mark.mpi
@pytest.mark.parametrize("ranks", on_ranks(2))
def test_ranks_go_on(run_script: RunScript, tmp_path: Path, ranks: int) -> None:
    """Where the last rank fails in its case, that of the other one is kept; resumed on both ranks it is not computed
    again, and the tables are those of two ranks that were not stopped."""
    whole, cut, words = tmp_path / "whole", tmp_path / "cut", ["transient", "demos/he2022.toml"]
    for setting in (*SETTINGS, "output.error_bars=false"):
        words += ["--set", setting]
    done = run_script("-c", WHOLE, *words, "--out", str(whole), ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    assert run_script("-c", STOPPED, *words, "--out", str(cut), ranks=ranks).returncode != 0
    assert kept(cut) == ["transient_2000rpm_0.npz"]
    before = (cut / "results/transient_2000rpm_0.npz").stat().st_mtime_ns
    done = run_script("-c", WHOLE, *words, "--out", str(cut), "--resume", ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    assert (cut / "results/transient_2000rpm_0.npz").stat().st_mtime_ns == before
    assert same_tables(cut, whole)
