"""The way in which every scene is computed: folder, log, solution, tables, pictures, cost. All commands call this."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.results.archive.run_cost import Cost, write_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.archive.scene_files import write_scene
from evolvent.results.drawing.picture_files import Drawn, draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.run.call import DEFAULT, Call, Options, opened_call
from evolvent.run.computation import Computation, Results, Solved
from evolvent.run.folder_checks import check_folder, foreign_files, nothing_to_resume
from evolvent.run.progress import OUTPUT
from evolvent.run.run_log import RunLog
from evolvent.scene.skips import wanted_output


def compute(what: Computation[Solved], out: Path, options: Options = DEFAULT) -> list[str]:
    """Computes a scene and writes everything to `out`. Returns all warnings, a sentence each. Collective; the results
    do not depend on the number of ranks.

    Raises InputError and FolderError before any file is touched; NotConverged, SearchError, BalanceError, MeshError,
    ArchiveError, WriteError and what else the computation raises; all on all ranks.
    """
    comm, folder = MPI.COMM_WORLD, RunFolder(out)
    on_first(comm, what.require_level)
    on_first(comm, what.check)
    shown = replace(options, quiet=options.quiet or what.is_list)
    with ExitStack() as lock:
        on_first(comm, lambda: lock.enter_context(locked(out)))
        on_first(comm, lambda: check_folder(what, out, options))
        dolfinx_compat.silence_logs()
        with opened_call(what.command, what.outputs.results, folder, comm, shown) as call:  # no file is touched yet
            on_first(comm, lambda: _log_beginning(call, what))
            solved = what.solve(replace(call, options=options))
            call.progress.stage(OUTPUT)
            memory = call.memory_MB()
            on_first(comm, lambda: _write(call, what, solved, memory))
            on_first(comm, folder.remove_parts)
            return on_first(comm, lambda: call.log.warnings)


def _log_beginning(call: Call, what: Computation[Solved]) -> None:
    """Logs what is known before anything is computed. On rank 0 alone."""
    if left := foreign_files(call.folder.out):
        call.log.info("%s", left)
    if call.resume and (anew := nothing_to_resume(what, call.folder.out)):
        call.log.warning(anew)
    for sentence in what.warnings():
        call.log.warning(sentence)


def _write(call: Call, what: Computation[Solved], solved: Solved, memory: float) -> None:
    """Writes the tables, and only then pictures and fields, which may fail. On rank 0 alone. memory: largest of all
    ranks together [MB]."""
    begin, folder = time.perf_counter(), call.folder
    call.log.open()
    results = what.results(call, solved)

    def cost() -> Cost:
        timings = replace(results.timings, output=time.perf_counter() - begin, total=call.seconds)
        return call.cost(timings, memory)

    write_scene(results.scene, folder)  # a resumed call may ask for other output
    write_cost(folder, cost())  # the error bars are stored, so their cost is too
    for each in results.tables:
        each.write(folder)
    folder.remove(set(what.outputs.tables) - {each.name for each in results.tables})
    _log_pictures(_drawn(call, what, results), call.log)
    results.complete(cost)
    write_cost(folder, cost())
    for sentence in results.warnings:
        call.log.warning(sentence)
    call.log.info("done in %.1f s, %.0f MB", call.seconds, memory)


def _drawn(call: Call, what: Computation[Solved], results: Results) -> Drawn:
    """Draws the pictures that the scene asks for."""
    own = what.outputs.pictures if wanted_output(what.scene).pictures else ()
    return draw([*from_tables(own, call.folder.out), *results.pictures], call.folder)


def _log_pictures(drawn: Drawn, log: RunLog) -> None:
    """Logs the pictures that were written, and warns of those that could not be drawn."""
    for path in drawn.written:
        log.info("picture: %s", path)
    for failure in drawn.failures:
        log.warning(failure)
