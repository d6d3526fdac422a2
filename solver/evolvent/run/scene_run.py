"""A scene from start to finish: model, sweep, archive, tables, pictures. The command line calls only this."""

from __future__ import annotations

import time
from contextlib import ExitStack
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_cost import Cost, kept_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.fields.deformation import deformation_of
from evolvent.run.coarse_run import companion_of
from evolvent.run.folder_checks import check_folder, others
from evolvent.run.output import Companions, Part, peak_memory_MB, write_output
from evolvent.run.pitch_run import pitch_of, sweep_scene
from evolvent.run.progress import DEFORMATION, ERROR_BARS, OUTPUT, Progress
from evolvent.run.run_log import logged
from evolvent.run.start import continued, kept_start, nothing_kept
from evolvent.run.wear_run import wear_scene, write_wear
from evolvent.scene.meshing.modifications import modification_warnings
from evolvent.scene.scene import Scene
from evolvent.scene.skips import skipped, switched_off, wanted_output


def run_scene(
    scene: Scene,
    out: Path,
    resume: bool = False,
    quiet: bool = False,
    overwrite: bool = False,
    source: Path | None = None,
) -> None:
    """Computes a scene and writes everything to `out`; the same on any number of ranks.

    resume: go on after the positions, or the blocks of wear, that `out` holds, where it holds none from the start, with
    a warning. overwrite: remove an earlier run's files
    (those that nobody has changed since) once the gears are ready. With neither, `out` may hold no results. source: the
    scene's file, which is never written over. A pitch whose energy does not balance is solved again on deflected
    flanks, as the scene that asks for these. Raises FolderError before anything is touched, NotConverged,
    BalanceError, MeshError, ArchiveError, WearStopped, VolumeLost, WriteError, on all ranks; nothing unconverged is
    ever written.
    """
    with ExitStack() as lock:
        on_first(MPI.COMM_WORLD, lambda: lock.enter_context(locked(out)))
        on_first(MPI.COMM_WORLD, lambda: check_folder(scene, out, resume, overwrite, source))
        _run(scene, out, resume, quiet)


def _run(scene: Scene, out: Path, resume: bool, quiet: bool) -> None:
    """The run in a folder that is its own."""
    comm, begin = MPI.COMM_WORLD, time.perf_counter()
    dolfinx_compat.silence_logs()
    scene = on_first(comm, lambda: continued(scene, Archive(out, scene), resume))
    start = on_first(comm, lambda: kept_start(scene, Archive(out, scene), resume))  # before the first file is touched
    earlier = on_first(comm, lambda: kept_cost(RunFolder(out)) if resume else Cost())
    with logged(RunFolder(out), comm, resume) as log, Progress(hidden=quiet or comm.rank > 0) as progress:
        if left := on_first(comm, lambda: others(out)):
            log.info("%s", left)
        if anew := on_first(comm, lambda: nothing_kept(scene, Archive(out, scene)) if resume else ""):
            log.warning(anew)
        for skip in skipped(scene):
            log.info("skipped, %s: %s", skip.name, skip.sentence)
        for name in switched_off(scene):
            log.info("not skipped: %s", name)
        for sentence in modification_warnings(scene):
            log.warning(sentence)
        if scene.wear is None:
            scene, sweep = sweep_scene(scene, out, start, earlier, comm, progress, log)
        else:
            sweep = wear_scene(scene, Archive(out, scene), resume, earlier, comm, progress, log)
        archive, pitch = Archive(out, scene), pitch_of(scene)
        companion = None
        if wanted_output(scene).error_bars:
            progress.stage(ERROR_BARS)
            companion = companion_of(scene, archive, pitch, comm)
        deformation = None
        if wanted_output(scene).deformation:
            progress.stage(DEFORMATION)
            deformation = deformation_of(scene, archive, comm)
        progress.stage(OUTPUT)
        part = Part(comm.size, begin, comm.allreduce(peak_memory_MB()), earlier)
        more = Companions(companion, deformation)
        on_first(comm, lambda: write_output(scene, archive, sweep, more, part, log))
        if scene.wear is not None:
            on_first(comm, lambda: write_wear(scene, out, log))
        on_first(comm, RunFolder(out).remove_parts)
