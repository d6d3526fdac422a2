"""Contact fatigue of a scene's flanks, from start to finish. `evolvent fatigue` calls only this."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparer, prepare_model
from evolvent.gears.pressure.contact_cells import coarse_contact
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED, certified_pitch
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.picture_files import draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.results.error_bars.estimation import estimated_errors
from evolvent.results.mesh_facts import cells_across
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import about_spacing
from evolvent.run.coarse_run import as_run, solve_companion
from evolvent.run.folder_checks import require_new, writing_to
from evolvent.run.pitch_run import pitch_of
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.fatigue import FatigueSection
from evolvent.scene.skips import wanted_output, with_deflected_flanks
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, FlankFatigue, flank_fatigue
from evolvent.strength.fatigue.flank_loads import FlankLoads, LoadedPosition
from evolvent.strength.results.fatigue_facts import FATIGUE_FACTS, fatigue_facts, warnings_of
from evolvent.strength.results.fatigue_rows import FATIGUE, FATIGUE_DEPTH, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_SECTION
from evolvent.strength.results.fatigue_tables import depth_rows, fatigue_rows, life_rows, map_rows, section_rows
from evolvent.strength.results.friction_fatigue import FrictionFatigue, zone_ends
from evolvent.strength.results.pictures import FATIGUE_PICTURE, FATIGUE_SCENE

TABLES = FATIGUE, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_DEPTH, FATIGUE_SECTION, FATIGUE_FACTS
WRITTEN = FATIGUE_SCENE.name, *(table.name for table in TABLES), f"pictures/{FATIGUE_PICTURE.name}"


def run_fatigue(
    scene: Scene, out: Path, overwrite: bool = False, quiet: bool = False, prepare: Preparer = prepare_model
) -> list[str]:
    """Computes the pitch and the fatigue of the flanks, and writes scene, tables and picture to `out`. Returns a
    sentence where a picture could not be drawn, error bars not be estimated, or figures do not hold. Collective.

    scene: its wear is left out. overwrite: replace what an earlier call has written. prepare: prepares gears that other
    calls share.

    Raises FolderError, MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    scene = scene.model_copy(update={"wear": None})
    dolfinx_compat.silence_logs()
    checked = writing_to(out, comm, lambda: require_new(out, WRITTEN, FATIGUE.name, overwrite))
    with checked, Progress(hidden=hidden) as progress:
        solved, run = _solved(scene, comm, progress, prepare)
        on_others = [ON_DEFLECTED] if solved is not scene else []
        companion = None
        if wanted_output(scene).error_bars:
            progress.stage(ERROR_BARS)
            companion = solve_companion(solved, pitch_of(solved), comm, prepare)
        progress.stage(OUTPUT)

        def written() -> list[str]:
            assert run is not None
            errors = run.errors if companion is None else estimated_errors(run, companion)
            said = [errors.missing] if companion is not None and errors.missing else []
            coarse = None if companion is None else companion.run
            return [*on_others, *said, *_written(replace(run, errors=errors), coarse, out)]

        return on_first(comm, written)


def _solved(
    scene: Scene, comm: MPI.Comm, progress: Progress, prepare: Preparer
) -> tuple[Scene, RunData | None]:
    """The scene, on deflected flanks if its pitch needs them, and the run of the pitch on rank 0. Collective."""
    progress.stage(MESHING)
    model = prepare(gear_problem(scene), comm, meshed=lambda: progress.stage(CONDENSING)).model
    pitch = pitch_of(scene)
    progress.stage(POSITIONS, len(pitch.angles))
    solved = certified_pitch(model, pitch, scene.contact.friction, comm, progress.position)
    return with_deflected_flanks(scene) if solved.deflected else scene, as_run(scene, model, solved, comm)


def _positions(run: RunData, index: int) -> list[LoadedPosition]:
    """Loaded positions of the pitch at the friction coefficient with this index."""
    return [
        LoadedPosition(k, each[index].result, each[index].cut, run.flank.z) for k, each in enumerate(run.positions)
    ]


def _fatigue(run: RunData, index: int, error: float, coarse: RunData | None) -> FrictionFatigue:
    """Fatigue of both flanks at the friction coefficient with this index. error: of the largest pressure [MPa]."""
    gears = _flanks(run, index, run.inner_path)
    ends = zone_ends(run.pair, run.inner_path)
    largest = float(gears[0].loads.peak.max(initial=0.0)) or float("nan")
    beside = None if coarse is None else _flanks(coarse, index, run.inner_path)
    return FrictionFatigue(run.frictions[index], gears, error / largest, ends, beside)


def _flanks(run: RunData, index: int, inner: tuple[float, float]) -> tuple[FlankFatigue, FlankFatigue]:
    """Fatigue of the flanks of pinion and wheel. inner: roll distances [mm] between the tip-edge zones."""
    section, friction = run.scene.fatigue or FatigueSection(), run.frictions[index]
    loads = FlankLoads.joined([each.loads(inner) for each in _positions(run, index)])
    pinion, wheel = _materials(run)
    first = flank_fatigue(loads, friction, section.depths, pinion)
    # both flanks bear the same tractions
    return first, first if wheel == pinion else flank_fatigue(loads, friction, section.depths, wheel)


def _materials(run: RunData) -> tuple[FatigueMaterial, FatigueMaterial]:
    section = run.scene.fatigue or FatigueSection()
    pinion, wheel = (
        FatigueMaterial(
            each.poissons_ratio, each.lame[1], section.yield_stress_MPa, section.tension_factor,
            section.compression_factor, section.normal_factor,
        )
        for each in run.scene.materials()
    )
    return pinion, wheel


def _written(run: RunData, coarse: RunData | None, out: Path) -> list[str]:
    """Writes all files, in place of those of an earlier call. run: with its error bars. On rank 0 alone."""
    section = run.scene.fatigue or FatigueSection()
    found = [_fatigue(run, k, run.errors.bar("max_pressure_MPa", k), coarse) for k in range(len(run.frictions))]
    facts = [
        fatigue_facts(run.pair, each, _positions(run, k), run.inner_path, _materials(run))
        for k, each in enumerate(found)
    ]
    folder = RunFolder(out)
    folder.remove(WRITTEN)
    folder.write_text(FATIGUE_SCENE.name, run.scene.resolved_toml())
    FATIGUE.write(folder, fatigue_rows(run.pair, found))
    FATIGUE_LIFE.write(folder, life_rows(found, section.exponents))
    FATIGUE_MAP.write(folder, map_rows(run.pair, found))
    FATIGUE_DEPTH.write(folder, depth_rows(run.pair, found))
    FATIGUE_SECTION.write(folder, section_rows(run.pair, found))
    FATIGUE_FACTS.write(folder, facts)
    pictures = [FATIGUE_PICTURE] if wanted_output(run.scene).pictures else []
    failures = draw(from_tables(pictures, out), folder).failures
    said = [*failures, *chart_warnings(run.scene), *coarse_contact(cells_across(run))]
    said += about_spacing(run, friction_rows(run), ["max_pressure_MPa"])
    return [*said, *(sentence for pair in zip(facts, found) for sentence in warnings_of(*pair))]
