"""Facts, fields and last lines of a run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from evolvent.fem.backend import dolfinx_compat
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.fields.deformation import Deformation
from evolvent.results.fields.paraview import write_fields
from evolvent.results.mesh_facts import NARROW, MeshFacts, cells_across
from evolvent.results.run_data import RunData
from evolvent.results.tables.headlines import has_error_bars, headlines
from evolvent.results.tables.summary_rows import RunFacts
from evolvent.scene.scene import Scene
from evolvent.scene.skips import skipped, wanted_output
from evolvent.wear.results.worn_lines import worn_lines

SUMMARY, WEAR, FIELDS = "summary.json", "wear.json", "fields for ParaView"


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


def write_fields_of(data: RunData, deformation: Deformation | None, folder: RunFolder) -> Iterator[Path]:
    """Writes the fields that the scene asks for; gives the file to open of each series. Raises WriteError, FolderError.
    """
    if data.scene.output.fields:
        yield write_fields(data, folder)
    if deformation is not None:
        from evolvent.results.fields.deformed_fields import write_deformed  # VTK takes a second to import

        yield write_deformed(data, deformation, folder)


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
