"""What a run writes once its positions are there, fields, pictures, tables; and the certificates they need before."""

from __future__ import annotations

import resource
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import Preparation
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.archive import Archive, Meshes
from evolvent.results.archive.run_cost import Cost, Timings, keep_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import keep_scene
from evolvent.results.contact_slices import balance_error, pitch_imbalance
from evolvent.results.drawing.picture_files import Drawn, draw
from evolvent.results.error_bars.estimation import with_errors
from evolvent.results.fields.deformation import Deformation
from evolvent.results.fields.paraview import write_fields
from evolvent.results.mesh_facts import NARROW, MeshFacts, cells_across
from evolvent.results.run_data import Companion, RunData, run_data
from evolvent.results.tables.summary_rows import RunFacts
from evolvent.results.tables.tables import summary, write_summary, write_tables
from evolvent.run.run_log import RunLog
from evolvent.scene.scene import Scene
from evolvent.scene.skips import skipped, wanted_output
from evolvent_meshes.errors import ResultError
from evolvent_meshes.mesh.quality import scaled_jacobians

BALANCE_LIMIT = 1e-2
"""A pitch whose energy does not balance better is an error, not a result."""
STORED_LIMIT = 0.1
"""A position whose teeth store or give back more of the input power bends them too far for small strain."""
REMEDY = (
    "where a tip's edge bears relieve it (tip_relief_um) or lower the torque, else refine the sweep (sweep.positions) "
    "or the mesh (mesh.level)"
)

FIELDS = "fields for ParaView"


class BalanceError(ResultError):
    """A converged position or pitch that fails its balance certificate."""


class PitchImbalance(BalanceError):
    """All positions hold, but energy is not kept over the pitch."""


@dataclass(frozen=True)
class Sweep:
    """What sweeping took: the meshes it stood on, and wall seconds."""

    meshes: Meshes
    timings: Timings


@dataclass(frozen=True)
class Companions:
    """What was solved beside a run: its coarse companion and the insides of its teeth, None where not asked for."""

    coarse: Companion | None
    deformation: Deformation | None


@dataclass(frozen=True)
class Part:
    """A run, or the last part of a resumed one."""

    ranks: int
    """MPI processes."""
    begin: float
    """When it began, as time.perf_counter() tells [s]."""
    memory_MB: float
    """Largest resident memory, summed over the ranks."""
    earlier: Cost
    """What earlier parts have cost."""

    def cost(self, timings: Timings) -> Cost:
        """Of the run up to now, of whose last part these are the times but for the total."""
        return self.earlier + Cost(replace(timings, total=time.perf_counter() - self.begin), self.memory_MB)


def timings_of(preparation: Preparation) -> Timings:
    """What preparing took."""
    parts = preparation.mesh_seconds, preparation.assemble_seconds, preparation.condense_seconds
    return Timings(*parts, total=preparation.mesh_seconds + preparation.seconds)


def write_output(
    scene: Scene, archive: Archive, sweep: Sweep, more: Companions, part: Part, log: RunLog
) -> None:
    """The tables, which say that the run is complete; then fields and pictures, whose failing costs nothing else.

    Raises WriteError, FolderError.
    """
    started = time.perf_counter()
    data = run_data(scene, archive.read_gears(), archive.read_positions(scene.gear_pair()))
    companion = more.coarse
    data = with_errors(data, archive, companion)
    keep_scene(scene, archive.files)  # a resumed run may ask for other output

    timings = replace(sweep.timings, error_bars=0.0 if companion is None else companion.seconds)

    def cost() -> Cost:
        return part.cost(replace(timings, output=time.perf_counter() - started))

    keep_cost(archive.files, cost())  # the error bars are kept, so is what they have cost
    found = summary(data, facts_of(data, sweep.meshes, part.ranks, cost()))
    write_tables(archive.files, found)
    show(replace(data, scene=scene.model_copy(update={"output": wanted_output(scene)})), archive.files, log)
    if more.deformation is not None:
        from evolvent.results.fields.deformed_fields import write_deformed  # VTK takes a second

        log.info("fields: %s", write_deformed(data, more.deformation, archive.files))
    whole = cost()  # pictures took time, too
    write_summary(archive.files, replace(found, timings_s=whole.timings))
    keep_cost(archive.files, whole)
    for sentence in found.warnings:
        log.warning(sentence)
    log.info("done in %.1f s, %.0f MB", time.perf_counter() - part.begin, part.memory_MB)


def whereabouts(out: Path, scene: Scene) -> str:
    """The last line of a run: where its figures, tables, pictures and fields are, of those that are there and that the
    scene asks for; others were left by an earlier part of the run."""
    wanted = wanted_output(scene)
    asked = {"pictures": wanted.pictures or wanted.animation, FIELDS: wanted.fields or wanted.deformation}
    kinds = {
        "figures with error bars": ("summary.json",),
        "tables": ("positions.csv", "teeth.csv", "wear.csv"),
        "figures of wear": ("wear.json",),
        "pictures": ("pictures",),
        FIELDS: ("fields/contact.pvd",),
    }
    kinds = {kind: names for kind, names in kinds.items() if asked.get(kind, True)}
    found = {kind: [str(out / name) for name in names if (out / name).exists()] for kind, names in kinds.items()}
    return "done: " + "; ".join(f"{kind} in {', '.join(paths)}" for kind, paths in found.items() if paths)


def show(data: RunData, folder: RunFolder, log: RunLog) -> None:
    """Fields and pictures, as the scene asks. Raises WriteError, FolderError."""
    if data.scene.output.fields:
        log.info("fields: %s", write_fields(data, folder))
    if data.scene.output.pictures or data.scene.output.animation:
        from evolvent.results.figures.all import (
            pictures,  # pyvista and matplotlib take a second: only where a scene wants pictures
        )

        tell(draw(pictures(data), folder), log)


def tell(drawn: Drawn, log: RunLog) -> None:
    """Which pictures there are, and which could not be drawn."""
    for path in drawn.written:
        log.info("picture: %s", path)
    for failure in drawn.failures:
        log.warning(failure)


def facts_of(data: RunData, meshes: Meshes, ranks: int, cost: Cost) -> RunFacts:
    """Of a run."""
    return RunFacts(
        versions=dolfinx_compat.versions(),
        ranks=ranks,
        dofs=sum(mesh.points.shape[0] * mesh.dimension for mesh in meshes),
        cells=sum(len(mesh.cells) for mesh in meshes),
        mesh=mesh_facts(data, meshes),
        skipped=skipped(data.scene),
        timings_s=cost.timings,
        peak_memory_MB=cost.memory_MB,
    )


def mesh_facts(data: RunData, meshes: Meshes) -> MeshFacts:
    """Of a run's meshes."""
    quality = min(float(scaled_jacobians(mesh).min()) for mesh in meshes)
    return MeshFacts(quality, cells_across(data), cells_across(data, NARROW))


def certify(results: Iterable[PositionResult]) -> None:
    """Raises BalanceError where the forces of one of the positions do not balance, or its teeth store too much."""
    for result in results:
        error = balance_error(result)
        if not error <= STORED_LIMIT:
            raise BalanceError(
                f"pinion at {result.stand.angle:.4f} rad, μ = {result.friction}: wanted a balance error of at most "
                f"{STORED_LIMIT}, found {error:.2e}; {REMEDY}"
            )


def certify_pitch(positions: Iterable[Sequence[PositionResult]]) -> None:
    """Of all positions of a pitch, with a result for each friction coefficient. Raises PitchImbalance where the
    energy does not balance."""
    for results in zip(*positions, strict=True):
        error = pitch_imbalance(results)
        if not error <= BALANCE_LIMIT:
            raise PitchImbalance(
                f"the pitch at μ = {results[0].friction}: wanted an energy balance within {BALANCE_LIMIT} of the "
                f"input, found {error:.2e}; {REMEDY}"
            )


def peak_memory_MB() -> float:
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
