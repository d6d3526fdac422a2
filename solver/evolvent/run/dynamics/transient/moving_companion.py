"""The coarse companion of a scene's cases, for their error bars: the same pair on elements of twice the size, in the
time steps of the scene and in steps of a quarter."""

from __future__ import annotations

from collections.abc import Callable

from mpi4py import MPI

from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.results.transient.compared import FINER
from evolvent.dynamics.results.transient.errors import MovingCompanion
from evolvent.gears.gear_model import Preparer
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import FolderError
from evolvent.run.dynamics.transient.cases import PairCases, PairMeshes
from evolvent.run.dynamics.transient.kept_cases import COARSE, FINER_STEPS, KeptCases
from evolvent.run.progress import ERROR_BARS, Progress
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.files import WriteError

MODES = 3
"""Of each harmonic, at least: with these a small pair whose teeth part and meet has its mesh force within 0.2 % of that
with all modes, with one within 2 % (tests/solver/dynamics/transient/test_full_gears.py). What the scene sets counts."""


def companion_of(
    scene: Scene, problem: GearProblem, settings: DriveSettings, kept: Callable[[str], KeptCases], comm: MPI.Comm,
    progress: Progress, prepare: Preparer,
) -> tuple[MovingCompanion | None, list[str]]:
    """Its cases on rank 0, none where the scene asks for no error bars; and why there are none: results are not lost
    for their error bars. kept: by the kind of cases. Collective. Raises ArchiveError, WriteError, FolderError."""
    if not wanted_output(scene).error_bars:
        return None, []
    progress.stage(ERROR_BARS)
    coarse, on = kept(COARSE), PairMeshes(companion_mesh, MODES)
    try:
        with Progress(hidden=True) as hidden:
            cases = PairCases.of(scene, problem, settings, on, coarse, comm, hidden, prepare)
        contacts = cases.contacts(FINER)
        finer = cases.tried(kept(FINER_STEPS), contacts)
        same = cases.tried(coarse, contacts.thinned(FINER))
    except (ArchiveError, FolderError, WriteError):
        raise
    except EvolventError as error:  # the same on all ranks
        return None, [f"Error bars: their coarse companion could not be solved: {error}"]
    return MovingCompanion(cases.pair.model, scene.mesh.order, cases.static.positions, same, finer), []
