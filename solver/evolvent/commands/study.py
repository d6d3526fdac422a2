"""The command `evolvent study`. It starts processes of its own, and takes no part in mpirun."""

from __future__ import annotations

import os
from contextlib import AbstractContextManager, closing
from pathlib import Path
from typing import Annotated

import typer

from evolvent.commands.command import Command
from evolvent.commands.exit import STATUSES, reported
from evolvent.commands.options import (
    CacheSize,
    Force,
    LevelOption,
    NoCache,
    Overrides,
    Quiet,
    given_count,
    given_path,
    use_cache,
)
from evolvent.commands.scene_argument import require, warn, with_level
from evolvent.fem.parallel.mpi_start import world

MOST_PER_CORE = 4
"""Largest number of worker processes for each core."""
MEGABYTES = 250.0
"""Memory of a worker process that computes nothing: what it has imported."""
STUDY_EPILOG = f"""\b
Examples:
  evolvent study demos/studies/zhang2023_torque.toml --out out/torque --workers 2
  evolvent study demos/studies/zhang2023_torque.toml --out out/torque --scheduler tcp://10.0.0.1:8786

Exit status 0 also where some scenes were refused or have failed: a warning counts them, study.csv says why. 3 where
none is done, 2 where the values of all of them are refused.

{STATUSES}"""


def study(
    file: Annotated[
        Path,
        typer.Argument(metavar="STUDY.toml", help="The study file; docs/studies.md lists its keys.", parser=given_path),
    ],
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Where table, pictures and scenes go.", parser=given_path)
    ],
    workers: Annotated[
        int | None,
        typer.Option("--workers", metavar="N", help="Worker processes on this machine; one by default.",
                     parser=given_count),
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Use the workers of a running Dask scheduler.")
    ] = None,
    level: LevelOption = None,
    settings: Overrides = None,
    force: Force = False,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace the table of another study in DIR; its scenes stay.")
    ] = False,
    quiet: Quiet = False,
    no_cache: NoCache = False,
    cache_size: CacheSize = None,
) -> None:
    """Compute many scenes.

    Parameters vary as a grid, side by side, or as a Latin hypercube; one table and pictures gather the figures. Scenes
    that are in DIR already are not computed again.
    """
    with reported(advice="; the same command goes on"):
        ranks = f"study: found {world().size} MPI ranks; allowed: one; remedy: leave out mpirun, give --workers"
        require(world().size == 1, ranks)
        both = "--workers: found --scheduler, too; allowed: one of them; remedy: a scheduler has its own workers"
        require(workers is None or scheduler is None, both)
        if workers is not None and not force:
            _require_room(workers)
        use_cache(no_cache, cache_size)
        from evolvent.fem.backend.dolfinx_compat import versions
        from evolvent.run.study.local_workers import LocalWorkers
        from evolvent.run.study.plan.study_file import load_study
        from evolvent.run.study.plan.study_scenes import study_scenes
        from evolvent.run.study.results.figures import gathered_figures
        from evolvent.run.study.study_run import Study, run_study
        from evolvent.run.study.task_groups import SceneWorkers

        old: list[str] = []
        loaded = load_study(file, old.append)
        figures, overrides = gathered_figures(loaded, str(file)), with_level(settings, level)
        planned = Study(loaded, study_scenes(loaded, file, overrides, versions()["evolvent"], old.append), figures)
        warn(old)
        at_once = min(workers or 1, len(planned.scenes))

        def computing() -> AbstractContextManager[SceneWorkers]:
            if scheduler is None:
                return closing(LocalWorkers(at_once))
            from evolvent.run.study.scheduled_workers import scheduled_workers  # Dask takes a second to import

            return scheduled_workers(scheduler, out.absolute())

        warn(run_study(planned, out.absolute(), computing, 0 if force else at_once, overwrite, quiet))
        if not quiet:
            typer.echo(f"done: {out / 'study.csv'}, a row for each of {len(planned.scenes)} scenes")


def _require_room(workers: int) -> None:
    """Raises a usage error where so many worker processes are far beyond this machine's cores, or its memory."""
    from evolvent.fem.parallel.machine import machine_megabytes

    cores, memory = len(os.sched_getaffinity(0)), machine_megabytes()
    most = max(1, min(MOST_PER_CORE * cores, int(memory / MEGABYTES)))
    allowed = f"up to {most}, for {cores} cores and {memory / 1e3:.3g} GB of memory"
    many = f"--workers: found {workers}; allowed: {allowed}; remedy: write --workers {min(cores, most)}, or add --force"
    require(workers <= most, many)


STUDY = Command("study", study, STUDY_EPILOG)
"""The command as it is registered."""
