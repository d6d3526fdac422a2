"""Output of a run once its positions are archived: tables, fields and pictures."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from evolvent.fem.backend import dolfinx_compat
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost, write_cost
from evolvent.results.archive.scene_files import write_scene
from evolvent.results.drawing.picture_files import Drawn, draw
from evolvent.results.error_bars.estimation import Companion, with_errors
from evolvent.results.fields.deformation import Deformation
from evolvent.results.fields.paraview import write_fields
from evolvent.results.mesh_facts import NARROW, MeshFacts, cells_across
from evolvent.results.run_data import RunData, run_data
from evolvent.results.tables.headlines import has_error_bars, headlines
from evolvent.results.tables.summary_rows import RunFacts
from evolvent.results.tables.tables import summary, write_summary, write_tables
from evolvent.run.context import RunContext
from evolvent.run.pitch_run import SweepRecord
from evolvent.run.run_log import RunLog
from evolvent.scene.scene import Scene
from evolvent.scene.skips import skipped, wanted_output
from evolvent.wear.results.worn_lines import worn_lines

SUMMARY, WEAR, FIELDS = "summary.json", "wear.json", "fields for ParaView"


@dataclass(frozen=True)
class ExtraResults:
    """Results beside the positions; None where the scene does not ask for them, or where they are archived."""

    companion: Companion | None
    """Coarse companion for the error bars."""
    deformation: Deformation | None
    """Displacement and stress of the teeth in contact."""


def write_output(
    run: RunContext, scene: Scene, record: SweepRecord, extra: ExtraResults, memory_MB: float, said: Sequence[str] = ()
) -> None:
    """Writes the tables, which mark the run as complete, and only then fields and pictures, which may fail.

    On rank 0 alone. record: of the sweep or wear study. memory_MB: largest resident memory of all ranks together.
    said: warnings of how the positions were solved.
    Raises WriteError, FolderError.
    """
    begin, archive = time.perf_counter(), run.archive(scene)
    data = run_data(scene, archive.read_gears(), archive.read_positions(scene.gear_pair()))
    data = with_errors(data, archive, extra.companion)
    write_scene(scene, archive.files)  # a resumed run may ask for other output
    error_bars = 0.0 if extra.companion is None else extra.companion.seconds

    def cost() -> Cost:
        timings = replace(record.timings, error_bars=error_bars, output=time.perf_counter() - begin, total=run.seconds)
        return run.cost(timings, memory_MB)

    write_cost(archive.files, cost())  # the error bars are archived, so their cost is too
    tables = summary(data, facts_of(data, record.meshes, run.comm.size, cost()), said)
    write_tables(archive.files, tables)
    show(replace(data, scene=scene.model_copy(update={"output": wanted_output(scene)})), run)
    if extra.deformation is not None:
        from evolvent.results.fields.deformed_fields import write_deformed  # VTK takes a second to import

        run.log.info("fields: %s", write_deformed(data, extra.deformation, archive.files))
    total = cost()  # with fields and pictures
    write_summary(archive.files, replace(tables, timings_s=total.timings))
    write_cost(archive.files, total)
    for sentence in tables.warnings:
        run.log.warning(sentence)
    run.log.info("done in %.1f s, %.0f MB", run.seconds, memory_MB)


def last_lines(out: Path, scene: Scene) -> str:
    """Last lines that a run prints: its key figures, and where all results are."""
    figures = headlines(out / SUMMARY) if (out / SUMMARY).exists() else []
    if scene.wear is not None and (out / WEAR).exists():
        figures = worn_lines(out / WEAR, figures, scene)
    return "\n".join([*figures, whereabouts(out, scene)])


def whereabouts(out: Path, scene: Scene) -> str:
    """The last line of a run: where its figures, tables, pictures and fields are.

    Named is what exists and what the scene asks for; other files belong to an earlier part of the run.
    """
    wanted = wanted_output(scene)
    asked = {"pictures": wanted.pictures or wanted.animation, FIELDS: wanted.fields or wanted.deformation}
    kinds = {
        _figures(out): (SUMMARY,),
        "tables": ("positions.csv", "teeth.csv", "wear.csv"),
        "figures of wear": (WEAR,),
        "pictures": ("pictures",),
        FIELDS: ("fields/contact.pvd",),
    }
    kinds = {kind: names for kind, names in kinds.items() if asked.get(kind, True)}
    existing = {kind: [str(out / name) for name in names if (out / name).exists()] for kind, names in kinds.items()}
    return "done: " + "; ".join(f"{kind} in {', '.join(paths)}" for kind, paths in existing.items() if paths)


def _figures(out: Path) -> str:
    """Description of summary.json in words: figures, with error bars or without."""
    return "figures with error bars" if (out / SUMMARY).exists() and has_error_bars(out / SUMMARY) else "figures"


def show(data: RunData, run: RunContext) -> None:
    """Writes fields and pictures, as the scene asks. Raises WriteError, FolderError."""
    if data.scene.output.fields:
        run.log.info("fields: %s", write_fields(data, run.folder))
    if data.scene.output.pictures or data.scene.output.animation:
        # pyvista and matplotlib take a second to import
        from evolvent.results.figures.all import pictures

        log_pictures(draw(pictures(data), run.folder), run.log)


def log_pictures(drawn: Drawn, log: RunLog) -> None:
    """Logs the pictures that were written, and warns of those that could not be drawn."""
    for path in drawn.written:
        log.info("picture: %s", path)
    for failure in drawn.failures:
        log.warning(failure)


def facts_of(data: RunData, meshes: MeshRecord, ranks: int, cost: Cost) -> RunFacts:
    """Facts of a run for its summary, besides results: versions, ranks, mesh, cost."""
    return RunFacts(
        versions=dolfinx_compat.versions(),
        ranks=ranks,
        dofs=meshes.dofs,
        flank_dofs=meshes.flank_dofs,
        cells=meshes.cells,
        mesh=MeshFacts(meshes.min_scaled_jacobian, cells_across(data), cells_across(data, NARROW)),
        skipped=skipped(data.scene),
        timings_s=cost.timings,
        peak_memory_MB=cost.memory_MB,
    )
