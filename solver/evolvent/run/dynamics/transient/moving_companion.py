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
from evolvent.run.companion import Attempt, attempted
from evolvent.run.dynamics.transient.cases import PairCases, PairMeshes
from evolvent.run.dynamics.transient.kept_cases import COARSE, FINER_STEPS, KeptCases
from evolvent.run.progress import ERROR_BARS, Progress
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output

MODES = 3
"""Natural modes of each harmonic of the companion, at least, unless the scene sets their number. With these a small
pair whose flanks separate and meet has its mesh force within 0.2 % of that with all modes, with one within 2 %
(tests/solver/dynamics/transient/test_full_gears.py)."""


def companion_of(
    scene: Scene, problem: GearProblem, settings: DriveSettings, kept: Callable[[str], KeptCases], comm: MPI.Comm,
    progress: Progress, prepare: Preparer,
) -> Attempt[MovingCompanion]:
    """The companion of a transient, on rank 0; none where the scene asks for no error bars. kept: archive by the kind
    of cases. Collective. Raises ArchiveError, WriteError, FolderError."""
    if not wanted_output(scene).error_bars:
        return Attempt()
    progress.stage(ERROR_BARS)
    coarse, on = kept(COARSE), PairMeshes(companion_mesh, MODES)

    def solved() -> MovingCompanion:
        with Progress(hidden=True) as hidden:
            cases = PairCases.of(scene, problem, settings, on, coarse, comm, hidden, prepare)
        contacts = cases.contacts(FINER)
        finer = cases.tried(kept(FINER_STEPS), contacts)
        same = cases.tried(coarse, contacts.thinned(FINER))
        return MovingCompanion(cases.pair.model, scene.mesh.order, cases.static.positions, same, finer)

    return attempted(solved)
