"""A scene solved in memory, on meshes of one's own choice."""

from __future__ import annotations

from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_model import Mesher, prepare_model
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.results.archive.gear_shapes import gear_shape
from evolvent.results.run_data import RunData, run_data
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.skips import with_deflected_flanks


def solved_run(scene: Scene, pitch: Pitch, comm: MPI.Comm, mesh: Mesher) -> RunData | None:
    """A scene solved on the sectors that `mesh` makes, without writing anything: the run on rank 0, None on the others.

    Collective. Raises NotConverged, SearchError, BalanceError, MeshError, NotPositiveDefinite and OutOfMemory, on all
    ranks.
    """
    model = prepare_model(gear_problem(scene), comm, mesh).model
    solved = certified_pitch(model, pitch, scene.contact.friction, comm)
    scene = with_deflected_flanks(scene) if solved.deflected else scene

    def assembled() -> RunData:
        shapes = [gear_shape(MeshedGear.of(body)) for body in model.bodies]
        return run_data(scene, (shapes[0], shapes[1]), solved.positions)

    return together(comm, lambda: assembled() if comm.rank == 0 else None)
