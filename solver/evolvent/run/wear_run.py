"""A scene whose flanks wear: block after block, each kept as soon as it is done; the worn pair written out at reports.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import GearModel, Preparation, prepare_model
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.archive import Archive, Meshes
from evolvent.results.archive.run_cost import Cost, Timings, keep_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import keep_scene
from evolvent.results.drawing.picture_files import draw
from evolvent.results.run_data import run_data
from evolvent.results.tables.tables import summary, write_tables
from evolvent.run.output import Sweep, certify, certify_pitch, facts_of, peak_memory_MB, tell, timings_of
from evolvent.run.progress import CONDENSING, CYCLES, MESHING, Progress
from evolvent.run.run_log import RunLog
from evolvent.run.start import clear, same_meshes
from evolvent.scene.scene import Scene
from evolvent.scene.schema.wear import Wear
from evolvent.scene.skips import wanted_output
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import StudyCheckpoint, StudyState, checkpoint_of, study_states
from evolvent.wear.gears.gear_wear import GearWear, PitchState
from evolvent.wear.gears.pair_geometry import GearMeshMotion
from evolvent.wear.results.archive import read_checkpoint, worn_folder, write_checkpoint, write_pitch, write_worn
from evolvent.wear.results.report import read_worn, write_report
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData

FIRST = 1e-2  # of all cycles: the first block where the scene does not say
REFRESH = 5e-3
"""Modules of wear that meshes may lack where the scene does not say. He's pair worn by 6 µm, 2e-3 modules, has the same
depths within 8e-4 of their volume (2.5e-3 with tip relief) whether its meshes follow each 0.5 µm or not at all."""


def wear_scene(
    scene: Scene, archive: Archive, resume: bool, earlier: Cost, comm: MPI.Comm, progress: Progress, log: RunLog
) -> Sweep:
    """All blocks of a scene with [wear]; in OUT the pair at the beginning as a sweep leaves it, in OUT/worn_N that
    after N cycles. earlier: what earlier parts of the run have cost. Raises what run_scene does."""
    wear, begin = scene.wear, time.perf_counter()
    assert wear is not None
    kept = on_first(comm, lambda: read_checkpoint(archive) if resume else None)
    if kept is not None:
        log.info("resumed after %.6g of %.6g cycles", kept.cycles, wear.cycles)
        if kept.cycles >= wear.cycles:
            meshes = on_first(comm, lambda: same_meshes(scene, archive))
            log.begin()
            return Sweep(meshes, Timings())

    def meshed() -> None:
        log.begin()
        progress.stage(CONDENSING)

    progress.stage(MESHING)
    preparation = prepare_model(scene, comm, meshed=meshed)
    log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.seconds)
    pinion, wheel = preparation.model.bodies
    pitch = uniform_pitch(scene.pinion.teeth, scene.sweep.positions)
    motion = mesh_motion_of(scene, comm)
    gears = GearWear(preparation.model, pitch, scene.contact.friction[0], law_of(wear), comm, motion)
    meshes = pinion.mesh, wheel.mesh
    progress.stage(CYCLES, round(wear.cycles), round(kept.cycles if kept else 0.0))
    for stage in study_states(gears, wear.reports, settings_of(wear), kept):
        certify_positions(stage.state.evaluation)
        study = checkpoint_of(gears, stage)
        spent = _timings(preparation, time.perf_counter() - begin)
        cost = earlier + Cost(spent, comm.allreduce(peak_memory_MB()))
        on_first(comm, partial(_write, scene, archive, gears, meshes, stage, study, comm.size, cost))
        log.info(_line(stage))
        progress.reach(round(study.cycles))
    return Sweep(meshes, _timings(preparation, time.perf_counter() - begin))


def _timings(preparation: Preparation, seconds: float) -> Timings:
    """Of a study that has taken so long; what was not preparing were its blocks."""
    timings = timings_of(preparation)
    return replace(timings, positions=seconds - timings.total, total=seconds)


def write_wear(scene: Scene, out: Path, log: RunLog) -> None:
    """Figures and pictures of the finished study, beside those of the pair at the beginning. Raises WriteError."""
    study = read_worn(out)
    write_report(study, RunFolder(out))
    if wanted_output(scene).pictures:
        from evolvent.wear.results.figures import (
            pictures,  # matplotlib takes a second: only where a scene wants pictures
        )

        tell(draw(pictures(study), RunFolder(out)), log)


def law_of(wear: Wear) -> Archard:
    """Of pinion and wheel."""
    return Archard(wear.pinion_mm2_per_N, wear.wheel_mm2_per_N)


def settings_of(wear: Wear) -> BlockSettings:
    """How the scene wants its blocks."""
    first = wear.first_block_cycles or FIRST * wear.cycles
    return BlockSettings(first, wear.tolerance, wear.blocks == "implicit")


def mesh_motion_of(scene: Scene, comm: MPI.Comm) -> GearMeshMotion:
    """When and how the meshes follow."""
    assert scene.wear is not None
    given, module = scene.wear.refresh_um, scene.pair.normal_module_mm

    def condensed(mesh: Callable[[Member], MeshData]) -> GearModel:
        model = prepare_model(scene, comm, lambda _, index: mesh(index)).model
        logging.getLogger("evolvent").info("the meshes have followed the wear; both gears are condensed anew")
        return model

    return GearMeshMotion(REFRESH * module if given is None else 1e-3 * given, condensed)


def certify_positions(state: PitchState) -> None:
    """What a run asks of a pitch. Raises BalanceError; the volume is certified where it is found."""
    certify(state.positions)
    certify_pitch([result] for result in state.positions)


def _write(
    scene: Scene, archive: Archive, gears: GearWear, meshes: Meshes, stage: StudyState, study: StudyCheckpoint,
    ranks: int, cost: Cost,
) -> None:  # fmt: skip
    """The pair where it is asked for; then what the study goes on from, whose being there says that it is whole."""
    state = stage.state
    if stage.report and state.cycles == 0.0:
        clear(archive.files)
        write_pitch(archive, meshes, state.evaluation.positions)
        keep_scene(scene, archive.files)
    elif stage.report:
        folder = worn_folder(archive.out, state.cycles)
        RunFolder(folder).clear()
        worn = write_worn(scene, folder, gears, state.depth)
        own = Archive(folder, worn)
        write_pitch(own, meshes, state.evaluation.positions)
        data = run_data(worn, own.read_gears(), own.read_positions(worn.gear_pair()))
        write_tables(own.files, summary(data, facts_of(data, meshes, ranks, cost)))
        keep_cost(own.files, cost)
    write_checkpoint(archive, study)
    keep_cost(archive.files, cost)


def _line(stage: StudyState) -> str:
    """One line of the log."""
    if not stage.rows:
        return "the pair at the beginning is solved"
    row = stage.rows[-1]
    return (
        f"{row.cycles:.6g} cycles: a block of {row.block_cycles:.6g}, error {row.error:.3f}, {row.refused} refused, "
        f"{row.searched} positions searched; deepest {row.deepest_pinion_um:.3f} and {row.deepest_wheel_um:.3f} µm"
    )
