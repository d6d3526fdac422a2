"""A scene from start to finish: gears, positions or wear, archive, tables, pictures. `evolvent run` calls only this."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path

from mpi4py import MPI

from evolvent.dynamics.body_sentences import bodies_said
from evolvent.dynamics.figures.all import OPERATION_PICTURE
from evolvent.dynamics.operating_point import OperatingPoint, Operation
from evolvent.dynamics.operation_figures import OperationFigures, operation_warnings
from evolvent.dynamics.results.operation import write_operation
from evolvent.dynamics.under_mesh_force import UnderMeshForce
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparer, prepare_model
from evolvent.gears.meshing.modifications import modification_warnings, tip_edge_warnings
from evolvent.gears.meshing.undercut import undercut_warnings
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.results.fields.deformation import deformation_of
from evolvent.run.coarse_run import companion_of
from evolvent.run.context import RunContext, run_context
from evolvent.run.folder_checks import check_folder, foreign_files
from evolvent.run.output import ExtraResults, log_pictures, write_output
from evolvent.run.pitch_run import sweep_scene
from evolvent.run.progress import DEFORMATION, ERROR_BARS, OUTPUT, VIBRATION
from evolvent.run.start import ResumePoint, elastic_point, no_results_warning, resume_point, scene_to_solve
from evolvent.run.wear_run import wear_scene, write_wear
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.output import SkipName
from evolvent.scene.skips import Skipped, one_mesh_reason, skipped, skips, switched_off, wanted_output
from evolvent.scene.vibration_limits import doubtful

DEFLECTED_FLANKS: SkipName = "deflected-flanks"
NOTHING_LEFT = "complete: nothing to compute, tables and pictures are written again"
"""Message of a resumed run that was complete."""


def run_scene(
    scene: Scene,
    out: Path,
    resume: bool = False,
    quiet: bool = False,
    overwrite: bool = False,
    source: Path | None = None,
    prepare: Preparer | None = None,
) -> None:
    """Computes a scene and writes everything to `out`. Collective; the results do not depend on the number of ranks.

    resume: continue after the positions, or the blocks of wear, in `out`; where there are none, begin with a warning.
    overwrite: once the gears are condensed, with wear once the unworn pair is solved, remove the files of an earlier
    run that nobody has changed since. With neither, `out` must not hold results. quiet: no progress is displayed.
    source: the scene's file, which is never overwritten. prepare: prepares gears that other runs share.

    A pitch whose energy does not balance is solved again on deflected flanks. Unconverged positions are never written.
    Raises FolderError before any file is touched; NotConverged, SearchError, BalanceError, MeshError, ArchiveError,
    WearStopped, VolumeLost, WriteError; all on all ranks.
    """
    comm, begin, folder = MPI.COMM_WORLD, time.perf_counter(), RunFolder(out)
    with ExitStack() as lock:
        on_first(comm, lambda: lock.enter_context(locked(out)))
        on_first(comm, lambda: check_folder(scene, out, resume, overwrite, source))
        dolfinx_compat.silence_logs()
        solved = on_first(comm, lambda: scene_to_solve(scene, Archive(out, scene), resume))
        completed = on_first(comm, lambda: resume_point(solved, Archive(out, solved), resume))
        point, vibrating = elastic_point(solved, comm), None
        with run_context(folder, comm, resume, quiet, begin, prepare) as run:  # no file has been touched yet
            if point is not None:
                for sentence in doubtful(solved.planned_vibration()):
                    run.log.warning(sentence)
                vibrating = UnderMeshForce(point, prepare or prepare_model, partial(run.progress.stage, VIBRATION))
                run = replace(run, prepare=vibrating)
            _log_beginning(run, solved)
            _compute(run, scene, solved, completed, point)
            if vibrating is not None and vibrating.operation is not None:
                _write_operation(run, solved, vibrating.operation)


def _log_beginning(run: RunContext, scene: Scene) -> None:
    """Logs the facts of a run that are known before anything is computed."""
    if left := run.on_first(lambda: foreign_files(run.folder.out)):
        run.log.info("%s", left)
    if anew := run.on_first(lambda: no_results_warning(scene, run.archive(scene)) if run.resume else ""):
        run.log.warning(anew)
    _log_skips(run, [skip for skip in skipped(scene) if skip.name != DEFLECTED_FLANKS])
    for name in switched_off(scene):
        run.log.info("not skipped: %s", name)
    if sentence := one_mesh_reason(scene):
        run.log.info("%s", sentence)
    problem = gear_problem(scene)
    for sentence in (*undercut_warnings(problem), *modification_warnings(problem), *tip_edge_warnings(problem)):
        run.log.warning(sentence)


def _log_skips(run: RunContext, made: Sequence[Skipped]) -> None:
    """Logs which parts of the computation are left out."""
    for skip in made:
        run.log.info("skipped, %s: %s", skip.name, skip.sentence)


def _compute(
    run: RunContext, asked: Scene, scene: Scene, completed: ResumePoint | None, point: OperatingPoint | None
) -> None:
    """Computes and writes everything that the scene asks for. asked: the user's scene; scene: the same, on
    deflected flanks where the run to be resumed is; point: operating point of its vibration, where it has one."""
    said: list[str] = []
    if scene.wear is None:
        scene, record = sweep_scene(run, scene, completed)
        _log_skips(run, [skip for skip in skipped(scene) if skip.name == DEFLECTED_FLANKS])  # known only now
        if skips(asked, DEFLECTED_FLANKS) and not skips(scene, DEFLECTED_FLANKS):
            said.append(ON_DEFLECTED)
    else:
        record = wear_scene(run, scene, point)
    companion = None
    if wanted_output(scene).error_bars:
        run.progress.stage(ERROR_BARS)
        companion = companion_of(run, scene)
    deformation = None
    if wanted_output(scene).deformation:
        run.progress.stage(DEFORMATION)
        deformation = deformation_of(scene, run.archive(scene), run.comm)
    if not record.timings.total and companion is None and deformation is None:
        run.log.info("%s", NOTHING_LEFT)
        run.progress.note(NOTHING_LEFT)
    run.progress.stage(OUTPUT)
    memory = run.memory_MB()
    run.on_first(lambda: write_output(run, scene, record, ExtraResults(companion, deformation), memory, said))
    if scene.wear is not None:
        run.on_first(lambda: write_wear(run, scene))
    run.on_first(run.folder.remove_parts)


def _write_operation(run: RunContext, scene: Scene, operation: Operation) -> None:
    """Writes the mesh force under which contact was computed, and the vibration that it comes from. Collective."""

    def written() -> None:
        assert scene.dynamics is not None
        loaded = gear_problem(scene)
        radius = loaded.pair.gears[loaded.torque_on].base_radius
        write_operation(run.folder, operation, scene.dynamics.direction, radius)
        if wanted_output(scene).pictures:
            log_pictures(draw(from_tables([OPERATION_PICTURE], run.folder.out), run.folder), run.log)

        speed = operation.speed
        for sentence in (
            *bodies_said(operation.drive, speed, speed), *operation_warnings([OperationFigures.of(operation)])
        ):
            run.log.warning(sentence)

    run.on_first(written)
