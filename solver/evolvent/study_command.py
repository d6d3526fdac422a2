"""The command `evolvent study`. It starts processes of its own, and takes no part in mpirun."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from evolvent.failures import STATUSES, reported
from evolvent.fem.parallel.mpi_start import world
from evolvent.options import Force, LevelOption, Overrides, Quiet, given_path
from evolvent.scene_argument import require, with_level

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
        int | None, typer.Option("--workers", metavar="N", help="Worker processes on this machine; one by default.")
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
        cores = len(os.sched_getaffinity(0))
        few = f"--workers: found {workers}; allowed: a whole number from 1 on; remedy: write --workers {cores}"
        require(workers is None or workers >= 1, few)
        from evolvent.fem.backend.dolfinx_compat import versions
        from evolvent.run.study.plan.study_file import load_study
        from evolvent.run.study.plan.study_scenes import study_scenes
        from evolvent.run.study.results.figures import gathered_figures
        from evolvent.run.study.study_run import Study, run_study
        from evolvent.run.study.workers import local_workers, scheduled_workers

        loaded, count = load_study(file), workers or 1
        figures, overrides = gathered_figures(loaded, str(file)), with_level(settings, level)
        planned = Study(loaded, study_scenes(loaded, file, overrides, versions()["evolvent"]), figures)
        if scheduler is not None:
            at_once, context = 1, partial(scheduled_workers, scheduler, out.resolve())
        else:
            at_once, context = count, partial(local_workers, count)
        for sentence in run_study(planned, out.resolve(), context, 0 if force else at_once, overwrite, quiet):
            typer.echo(f"evolvent: warning: {sentence}", err=True)
        if not quiet:
            typer.echo(f"done: {out / 'study.csv'}, a row for each of {len(planned.scenes)} scenes")
