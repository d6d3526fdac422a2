"""A run's coarse companion: the same scene on meshes of twice the element size, at the same positions.

It has a quarter of the degrees of freedom, towards an eighth with more of them (a half in 2D), so condensing it is ten
times cheaper and more; what is felt are its positions. In processor time it took 12 % of a helical run of 100,000
degrees of freedom, less of larger ones, and half of a 2D run, which takes seconds. All friction coefficients are
solved: each has its own history and its own error, and beside a shared search they cost little.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import replace

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first, together
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state
from evolvent.results.archive.archive import Archive, gear_shape
from evolvent.results.archive.error_bar_data import kept_errors
from evolvent.results.run_data import Companion, RunData, run_data
from evolvent.scene.meshing.sector_meshes import gear_mesh
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.section import SectorResolution

Mesher = Callable[[Scene, Member], MeshData]
"""Makes the sector of a scene's pinion (0) or wheel (1)."""
COARSENING = 2.0
LEAST_LAYERS = 2  # of a gear's face width: the ends of the face need their own

LOG = logging.getLogger("evolvent")



def companion_of(scene: Scene, archive: Archive, pitch: Pitch, comm: MPI.Comm) -> Companion | None:
    """The companion solved, or None where its error bars are in the archive already. All ranks must call it."""
    if on_first(comm, lambda: kept_errors(archive)) is not None:
        return None
    companion = solve_companion(scene, pitch, comm)
    LOG.info("coarse companion for the error bars in %.1f s", companion.seconds)
    return companion


def solve_companion(scene: Scene, pitch: Pitch, comm: MPI.Comm) -> Companion:
    """Meshes, condenses and sweeps the companion; all ranks must call it. Raises nothing that a solver raises: a run
    is not lost for its error bars."""
    begin, run, failure = time.perf_counter(), None, ""
    try:
        run = solved_run(scene, pitch, comm, companion_mesh)
    except Exception as error:  # alike on all ranks: the parts below fail together
        failure = f"The coarse companion that error bars come from could not be solved: {error}"
        LOG.info("%s", failure)
    return Companion(run, failure, time.perf_counter() - begin)


def coarser(fine: SectorResolution) -> SectorResolution:
    """The same grading with elements of twice the size, as far as counts can be halved."""

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


def companion_mesh(scene: Scene, member: Member) -> MeshData:
    """The coarse sector of the pinion or the wheel. Raises MeshError."""
    return gear_mesh(scene, member, adapted=coarser)


def solved_run(scene: Scene, pitch: Pitch, comm: MPI.Comm, mesh: Mesher) -> RunData | None:
    """A scene on meshes of one's own, nothing written: the run on rank 0. Raises NotConverged, MeshError,
    NotPositiveDefinite, OutOfMemory."""
    model, frictions = prepare_model(scene, comm, mesh).model, scene.contact.friction
    swept = list(sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm))

    def joined() -> RunData:
        shapes = [gear_shape(body.mesh, body.flank.nodes) for body in model.bodies]
        return run_data(scene, (shapes[0], shapes[1]), one_pitch(swept))

    return together(comm, lambda: joined() if comm.rank == 0 else None)
