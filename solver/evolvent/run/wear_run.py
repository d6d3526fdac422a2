"""A scene whose flanks wear: each block of cycles is archived at once, the worn pair is written at the reports."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.dynamics.operation_figures import operation_warnings
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.solution.certificates import certify, certify_pitch
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost, Timings, write_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.run_data import archived_run
from evolvent.results.tables.tables import summary, write_tables
from evolvent.run.call import Call
from evolvent.run.kept_pitch import checked_meshes, timings_of
from evolvent.run.output import facts_of
from evolvent.run.progress import CYCLES
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.wear import WearSection
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import StudyCheckpoint, StudyState, checkpoint_of, study_states
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.meshed_pair import GearMeshMotion
from evolvent.wear.gears.pitch_state import PitchState
from evolvent.wear.gears.solver import FIRST_BLOCK, REFRESH
from evolvent.wear.results.archive import read_checkpoint, worn_folder, write_checkpoint, write_pitch, write_worn
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData


def wear_scene(call: Call, scene: Scene, operating: OperatingPoint | None) -> tuple[MeshRecord, Timings]:
    """Solves and stores all blocks of a scene with [wear]; returns its meshes, and the wall time. Collective; raises
    what `compute` does.

    The folder gets the unworn pair, as a run leaves it, and a subfolder worn_N with the pair after N cycles for each
    report. operating: where the pair vibrates as it wears; None: it wears under the constant torque.
    """
    wear, begin, archive = scene.wear, time.perf_counter(), call.archive(scene)
    assert wear is not None
    kept = call.on_first(lambda: read_checkpoint(archive) if call.resume else None)
    if kept is not None:
        call.log.info("resumed after %.6g of %.6g cycles", kept.cycles, wear.cycles)
        if kept.cycles >= wear.cycles:
            meshes = call.on_first(lambda: checked_meshes(gear_problem(scene), archive))
            call.on_first(lambda: call.begin(scene, resumed=True))
            return meshes, Timings()
    preparation = call.gears(gear_problem(scene))
    preparing = timings_of(preparation)
    if kept is not None:
        call.on_first(lambda: call.begin(scene, resumed=True))
    pitch, μ = uniform_pitch(scene.pinion.teeth, scene.sweep.positions), scene.contact.friction[0]
    motion = mesh_motion_of(call, scene)
    gears = GearWear(preparation.model, pitch, μ, law_of(wear), call.comm, motion, operating)
    meshes = MeshRecord.of([MeshedGear.of(body) for body in preparation.model.bodies])
    call.progress.stage(CYCLES, round(wear.cycles), round(kept.cycles if kept else 0.0))
    for stage in study_states(gears, wear.reports, settings_of(wear), kept):
        certify_positions(stage.state.evaluation)
        study = checkpoint_of(gears, stage)
        cost = call.cost(preparing.then_solved(time.perf_counter() - begin), call.memory_MB())
        call.on_first(partial(_write, call, scene, gears, meshes, stage, study, cost))
        call.log.info(_log_line(stage))
        call.progress.reach(round(study.cycles))
    for sentence in operation_warnings(stage.vibrations):
        call.log.warning(sentence)
    return meshes, preparing.then_solved(time.perf_counter() - begin)


def law_of(wear: WearSection) -> Archard:
    """Archard's law with the wear coefficients of pinion and wheel."""
    return Archard(wear.pinion_mm2_per_N, wear.wheel_mm2_per_N)


def settings_of(wear: WearSection) -> BlockSettings:
    """Settings of the block stepping: first block, tolerance, explicit or implicit."""
    first = wear.first_block_cycles or FIRST_BLOCK * wear.cycles
    return BlockSettings(first, wear.tolerance, wear.blocks == "implicit")


def mesh_motion_of(call: Call, scene: Scene) -> GearMeshMotion:
    """Settings of the mesh updates in a wear study, and the function that condenses the gears after one."""
    assert scene.wear is not None
    given, module = scene.wear.refresh_um, scene.pair.normal_module_mm

    def condensed(mesh: Callable[[Member], MeshData]) -> GearModel:
        model = prepare_model(gear_problem(scene), call.comm, lambda _, member: mesh(member), as_meshed=True).model
        call.log.info("the meshes have followed the wear; both gears are condensed again")
        return model

    return GearMeshMotion(REFRESH * module if given is None else 1e-3 * given, condensed)


def certify_positions(state: PitchState) -> None:
    """Raises BalanceError where a position or the pitch is out of balance. The study itself certifies worn volumes."""
    certify(state.positions)
    certify_pitch([result] for result in state.positions)


def _write(
    call: Call, scene: Scene, gears: GearWear, meshes: MeshRecord, stage: StudyState, study: StudyCheckpoint, cost: Cost
) -> None:
    """Writes the worn pair at a report; then the state of the study, whose file marks the block as complete."""
    state, archive = stage.state, call.archive(scene)
    if stage.report and state.cycles == 0.0:
        call.begin(scene)
        write_pitch(archive, meshes.shapes, state.evaluation.positions)
    elif stage.report:
        folder = worn_folder(archive.out, state.cycles)
        RunFolder(folder).clear()
        worn = write_worn(scene, folder, gears, state.depth)
        worn_archive = Archive(folder, worn)
        write_pitch(worn_archive, meshes.shapes, state.evaluation.positions)
        data = archived_run(worn_archive)
        write_tables(worn_archive.files, summary(data, facts_of(data, meshes, call.comm.size, cost)))
        write_cost(worn_archive.files, cost)
    write_checkpoint(archive, study)
    write_cost(archive.files, cost)


def _log_line(stage: StudyState) -> str:
    """Cycles, error and depths of a block."""
    if not stage.rows:
        return "the pair at the beginning is solved"
    row = stage.rows[-1]
    return (
        f"{row.cycles:.6g} cycles: a block of {row.block_cycles:.6g}, error {row.error:.3f}, {row.refused} refused, "
        f"{row.searched} positions searched; deepest {row.deepest_pinion_um:.3f} and {row.deepest_wheel_um:.3f} µm"
    )
