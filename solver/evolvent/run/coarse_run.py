"""The coarse companion of a run: the same scene and positions on meshes of twice the element size, for error bars.

It has a quarter of the run's degrees of freedom, an eighth in the limit of fine meshes (a half in 2D). Condensing it is
at least ten times cheaper, so most of its cost are the positions. In processor time it took 12 % of a helical run of
100,000 degrees of freedom, less of larger ones, and half of a 2D run, which takes seconds. It solves all friction
coefficients, because each has its own history and its own error; with a shared search they cost little.

Where flanks have levels of their own, condensing the companion costs as many patches as the run, of as many cells, and
its positions a quarter: on Yang's pair at standard a third of the processor time of six positions with friction.
"""

from __future__ import annotations

from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_model import GearModel, Mesher, Preparation, Preparer, prepare_model
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.solution.certified_pitch import CertifiedPitch, certified_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.results.archive.error_bar_data import read_error_bars
from evolvent.results.archive.gear_shapes import gear_shape
from evolvent.results.error_bars.estimation import Companion
from evolvent.results.run_data import RunData, run_data
from evolvent.run.companion import attempted
from evolvent.run.context import RunContext
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.skips import with_deflected_flanks


def companion_of(run: RunContext, scene: Scene) -> Companion | None:
    """The solved companion, None where its error bars are archived. Collective."""
    if run.on_first(lambda: read_error_bars(run.archive(scene))) is not None:
        return None
    companion = solve_companion(scene, pitch_of(scene), run.comm, run.prepare)
    if companion.failure:
        run.log.info("%s", companion.failure)
    run.log.info("coarse companion for the error bars in %.1f s", companion.seconds)
    return companion


def solve_companion(scene: Scene, pitch: Pitch, comm: MPI.Comm, prepare: Preparer | None = None) -> Companion:
    """Meshes, condenses and sweeps the companion. Collective. prepare: see `RunContext`.

    An error of meshing or solving becomes `Companion.failure`, see `attempted`.
    """
    found = attempted(lambda: solved_run(scene, pitch, comm, companion_mesh, prepare))
    return Companion(found.value, found.reason, found.seconds)


def solved_run(
    scene: Scene, pitch: Pitch, comm: MPI.Comm, mesh: Mesher, prepare: Preparer | None = None
) -> RunData | None:
    """A scene solved on the sectors that `mesh` makes, without writing anything: the run on rank 0, None on the others.

    prepare: see `RunContext`. Collective. Raises NotConverged, SearchError, BalanceError, MeshError,
    NotPositiveDefinite and OutOfMemory, on all ranks.
    """
    preparation: Preparation = (prepare or prepare_model)(gear_problem(scene), comm, mesh)
    solved = certified_pitch(preparation.model, pitch, scene.contact.friction, comm)
    return as_run(scene, preparation.model, solved, comm)


def as_run(scene: Scene, model: GearModel, solved: CertifiedPitch, comm: MPI.Comm) -> RunData | None:
    """The run of a pitch that was not written, with the scene that asks for its flanks: on rank 0, None on the others.
    Collective."""
    scene = with_deflected_flanks(scene) if solved.deflected else scene

    def assembled() -> RunData:
        shapes = [gear_shape(MeshedGear.of(body)) for body in model.bodies]
        return run_data(scene, (shapes[0], shapes[1]), solved.positions)

    return together(comm, lambda: assembled() if comm.rank == 0 else None)
