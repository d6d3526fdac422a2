"""The coarse companion of a run: the same scene and positions on meshes of twice the element size, for error bars.

It has a quarter of the run's degrees of freedom, an eighth in the limit of fine meshes (a half in 2D). Condensing it is
at least ten times cheaper, so most of its cost are the positions. In processor time it took 12 % of a helical run of
100,000 degrees of freedom, less of larger ones, and half of a 2D run, which takes seconds. It solves all friction
coefficients, because each has its own history and its own error; with a shared search they cost little.
"""

from __future__ import annotations

import time
from dataclasses import replace

from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_model import Mesher, prepare_model
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.meshing.flank_levels import LevelledSector
from evolvent.gears.meshing.levelled_meshes import SectorMesh, is_two_level, levelled_mesh
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state
from evolvent.results.archive.error_bar_data import read_error_bars
from evolvent.results.archive.gear_shapes import gear_shape
from evolvent.results.error_bars.estimation import Companion
from evolvent.results.run_data import RunData, run_data
from evolvent.run.context import RunContext
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.section import SectorResolution

COARSENING = 2.0
"""Element size of the companion over that of the run."""
LEAST_LAYERS = 2
"""Layers of elements over the face width, at least: both ends of the face need their own."""


def companion_of(run: RunContext, scene: Scene) -> Companion | None:
    """The solved companion, None where its error bars are in the archive already. Collective."""
    if run.on_first(lambda: read_error_bars(run.archive(scene))) is not None:
        return None
    companion = solve_companion(scene, pitch_of(scene), run.comm)
    if companion.failure:
        run.log.info("%s", companion.failure)
    run.log.info("coarse companion for the error bars in %.1f s", companion.seconds)
    return companion


def solve_companion(scene: Scene, pitch: Pitch, comm: MPI.Comm) -> Companion:
    """Meshes, condenses and sweeps the companion. Collective.

    An error of meshing or solving becomes `Companion.failure`: a run is not lost for its error bars. Every other
    exception is a bug and is raised.
    """
    begin, run, failure = time.perf_counter(), None, ""
    try:
        run = solved_run(scene, pitch, comm, companion_mesh)
    except EvolventError as error:  # the same on all ranks: `solved_run` fails on all together
        failure = f"The coarse companion that error bars come from could not be solved: {error}"
    return Companion(run, failure, time.perf_counter() - begin)


def coarser(fine: SectorResolution) -> SectorResolution:
    """The same grading with elements of `COARSENING` times the size, as far as counts can be divided."""

    def half(count: int, least: int = 1) -> int:
        return max(least, round(count / COARSENING))

    neck = half(fine.neck_elements)
    low, middle, high = (COARSENING * depth for depth in fine.layer_depths)
    return replace(
        fine,
        profile_elements=3 * half(fine.profile_elements // 3, 2),
        face_elements=half(fine.face_elements, LEAST_LAYERS),
        layer_depths=(low, middle, high),
        neck_elements=neck,
        fillet_elements=half(fine.fillet_elements, neck + 1),
        back_elements=half(fine.back_elements, neck + 1),
        core_elements=half(fine.core_elements),
        rim_elements=half(fine.rim_elements),
    )


def coarser_levels(fine: LevelledSector) -> LevelledSector:
    """As many levels on a sector with elements of `COARSENING` times the size: so those of every level are as much
    larger, in the body and in the contact."""
    return replace(fine, coarse=coarser(fine.coarse))


def companion_mesh(problem: GearProblem, member: Member) -> SectorMesh:
    """The coarse sector of the pinion or the wheel, in levels where the run's is. Raises MeshError."""
    if is_two_level(problem):
        return levelled_mesh(problem, member, adapted=coarser_levels)
    return gear_mesh(problem, member, adapted=coarser)


def solved_run(scene: Scene, pitch: Pitch, comm: MPI.Comm, mesh: Mesher) -> RunData | None:
    """A scene solved on the sectors that `mesh` makes, without writing anything: the run on rank 0, None on the others.

    Collective. Raises NotConverged, SearchError, MeshError, NotPositiveDefinite, OutOfMemory, on all ranks.
    """
    model, frictions = prepare_model(gear_problem(scene), comm, mesh).model, scene.contact.friction
    swept = list(sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm))

    def assembled() -> RunData:
        shapes = [gear_shape(MeshedGear.of(body)) for body in model.bodies]
        return run_data(scene, (shapes[0], shapes[1]), one_pitch(swept))

    return together(comm, lambda: assembled() if comm.rank == 0 else None)
