"""Root strength of a scene's gears, from start to finish. `evolvent strength` calls only this."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparer, prepare_model
from evolvent.gears.meshing.modifications import modification_warnings, tip_edge_warnings
from evolvent.gears.meshing.undercut import undercut_warnings
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.picture_files import draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.results.tables.run_warnings import RELIEVE
from evolvent.run.companion import Attempt, attempted
from evolvent.run.folder_checks import require_new, writing_to
from evolvent.run.progress import ERROR_BARS, OUTPUT, Progress
from evolvent.run.strength.pitch_roots import PitchRoots, pitch_roots, scene_root_meshes
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.strength import StrengthSection
from evolvent.scene.skips import wanted_output, with_deflected_flanks
from evolvent.strength.peak_positions import Roots
from evolvent.strength.results.gauge_table import GAUGES, gauge_rows
from evolvent.strength.results.pictures import ROOT_STRESS_PICTURE, STRENGTH_SCENE
from evolvent.strength.results.tables import (
    ROOT_STRESS,
    STRENGTH,
    FrictionRoots,
    formula_rows,
    formula_warnings,
    root_stress_rows,
    strength_rows,
)
from evolvent.strength.root_surface import compression_side, tension_side
from evolvent.strength.standard.root_stress import RootLoad
from evolvent.strength.strain_gauges import Gauge, gauge_places
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData

WRITTEN = (
    STRENGTH_SCENE.name, STRENGTH.name, ROOT_STRESS.name, GAUGES.name, f"pictures/{ROOT_STRESS_PICTURE.name}",
)
NO_DEEP_TEETH = 12
"""Tolerance class where the scene gives none: Y_DT is 1."""


def run_strength(
    scene: Scene, out: Path, overwrite: bool = False, quiet: bool = False, prepare: Preparer = prepare_model
) -> list[str]:
    """Computes the pitch with roots finer than a run's, and the stress there, and writes scene, tables and picture to
    `out`. Returns a sentence where a picture could not be drawn, error bars not be estimated, or a factor is
    extrapolated. Collective.

    scene: its wear is left out. overwrite: replace what an earlier call has written. prepare: prepares gears that other
    calls share.

    Raises InputError where the standard does not cover the gears or a strain gauge does not lie on a root, before
    anything is computed; FolderError, MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    scene = scene.model_copy(update={"wear": None})
    loads = _loads_of_standard(scene)
    on_first(comm, lambda: _check_gauges(scene))
    dolfinx_compat.silence_logs()
    checked = writing_to(out, comm, lambda: require_new(out, WRITTEN, STRENGTH.name, overwrite))
    with checked, Progress(hidden=hidden) as progress:
        fine_mesh, coarse_mesh = scene_root_meshes(scene)
        fine = pitch_roots(scene, fine_mesh, comm, progress, prepare=prepare)
        asked, scene = scene, with_deflected_flanks(scene) if fine.deflected else scene
        coarse = Attempt[PitchRoots]()
        if wanted_output(scene).error_bars:
            again = partial(pitch_roots, scene, coarse_mesh, comm, progress, ERROR_BARS, fine.angles, prepare)
            coarse = attempted(again)
        progress.stage(OUTPUT)
        found = _by_friction(scene, fine.roots, None if coarse.value is None else coarse.value.roots)
        said = on_first(comm, lambda: _written(scene, loads, found, out))
    said = [*([] if scene is asked else [ON_DEFLECTED]), *said, *chart_warnings(scene), *formula_warnings(loads)]
    return [*said, *_about_tip_edges(scene, fine), *filter(None, [coarse.reason])]


def _about_tip_edges(scene: Scene, found: PitchRoots) -> Iterator[str]:
    """Warnings of `run` on flanks and tips, and on what tip edges that bear mean for the roots."""
    problem = gear_problem(scene)
    yield from (*undercut_warnings(problem), *modification_warnings(problem), *tip_edge_warnings(problem))
    if found.tip_edges:
        yield (
            f"{found.tip_edges}: what an edge bears its neighbours do not, so that shares of the load and stresses at "
            f"the roots rest on contact of edges; {RELIEVE}."
        )


def _loads_of_standard(scene: Scene) -> tuple[RootLoad, RootLoad]:
    """Loads of the roots of pinion and wheel for the standard. Raises InputError where its formulas do not hold for
    them."""
    problem, section = gear_problem(scene), scene.strength or StrengthSection()
    pinion, wheel = (RootLoad(problem.pair, member, problem.pinion_torque) for member in Member)
    for load in (pinion, wheel):
        tuple(formula_rows(load, section.editions, section.tolerance_class or NO_DEEP_TEETH))
    return pinion, wheel


def _scene_gauges(scene: Scene) -> list[Gauge]:
    given = None if scene.strength is None else scene.strength.gauges
    if given is None:
        return []
    columns = given.gear, given.side, given.angle_deg, given.height_mm, given.length_mm
    return [
        Gauge(Member.named(gear), side == "loaded", math.radians(angle), z, length, number)
        for number, (gear, side, angle, z, length) in enumerate(zip(*columns, strict=True), 1)
    ]


def _check_gauges(scene: Scene) -> None:
    """Raises InputError where a gauge does not lie on a root, before anything is solved."""
    problem, gauges = gear_problem(scene), _scene_gauges(scene)
    for member in sorted({gauge.member for gauge in gauges}):
        made = scene_root_meshes(scene)[0](problem, member)
        mesh = made if isinstance(made, MeshData) else made.mesh
        for gauge in gauges:
            if gauge.member is member:
                side = tension_side if gauge.loaded_side else compression_side
                gauge_places(gauge, side(mesh, problem.pair.gears[member]))


def _by_friction(scene: Scene, fine: Roots, coarse: Roots | None) -> list[FrictionRoots]:
    return [
        FrictionRoots(friction, own, None if coarse is None else coarse[index], scene.mesh.order)
        for index, (friction, own) in enumerate(zip(scene.contact.friction, fine))
    ]


def _written(scene: Scene, loads: Sequence[RootLoad], found: Sequence[FrictionRoots], out: Path) -> list[str]:
    """Writes all files, in place of those of an earlier call. On rank 0 alone."""
    section = scene.strength or StrengthSection()
    tolerance = section.tolerance_class or NO_DEEP_TEETH
    rows = [row for load in loads for row in strength_rows(load, found, section.editions, tolerance)]
    strains = list(gauge_rows(_scene_gauges(scene), found, scene.materials()))
    folder = RunFolder(out)
    folder.remove(WRITTEN)
    folder.write_text(STRENGTH_SCENE.name, scene.resolved_toml())
    STRENGTH.write(folder, rows)
    ROOT_STRESS.write(folder, root_stress_rows(found))
    GAUGES.write(folder, strains)
    pictures = [ROOT_STRESS_PICTURE] if wanted_output(scene).pictures else []
    return list(draw(from_tables(pictures, out), folder).failures)
