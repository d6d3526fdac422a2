"""The commands of `evolvent` that compute a scene into a folder; all ranks take part in them.

One factory, `_command`, makes them from the computations of `evolvent.run.kinds.all`: their options, how they end and
what they print are alike.
"""

from __future__ import annotations

import inspect
import os

import typer

from evolvent.commands.command import Command
from evolvent.commands.exit import STATUSES, reported
from evolvent.commands.options import (
    CacheSize,
    ExactParts,
    Force,
    LevelOption,
    NoCache,
    Overrides,
    Overwrite,
    Percents,
    PetscOptions,
    Quiet,
    ResultsFolder,
    Resume,
    SceneFile,
    results_folder,
    torque_list,
    use_cache,
)
from evolvent.commands.scene_argument import loaded_scene, require, require_room
from evolvent.fem.parallel.mpi_start import world
from evolvent.run.kinds.all import KINDS, Kind, kind_of
from evolvent.scene.load_cases import with_list

# commands import what they need beyond the scene: their help must not wait for PETSc or pyvista

BOTH = (
    "--overwrite: found --resume and --overwrite; allowed: one of them; remedy: --resume keeps what --overwrite removes"
)
"""Message on two options that exclude each other."""
PETSC_OPTIONS = "EVOLVENT_PETSC_OPTIONS"
"""Environment variable that evolvent.fem.backend.petsc reads."""


def _command(kind: Kind) -> Command:
    """The command of a computation."""

    def command(
        scene: SceneFile,
        out: ResultsFolder,
        percents: Percents = None,
        level: LevelOption = None,
        settings: Overrides = None,
        exact: ExactParts = None,
        force: Force = False,
        resume: Resume = False,
        overwrite: Overwrite = False,
        quiet: Quiet = False,
        no_cache: NoCache = False,
        cache_size: CacheSize = None,
        petsc: PetscOptions = None,
    ) -> None:
        with reported(parallel=True, advice=f"; `evolvent {kind.name} ... --resume` continues"):
            loaded = loaded_scene(scene, level, settings, exact, world())
            require(not (resume and overwrite), BOTH)
            use_cache(no_cache, cache_size)
            if petsc is not None:
                os.environ[PETSC_OPTIONS] = petsc  # before PETSc starts
            computation = kind_of(kind.name, loaded).load()
            what = computation.of(with_list(loaded, percents or (), kind.percents) if kind.percents else loaded)
            for each in what.sized:
                require_room(each, what.command, force, world())
            from evolvent.run.call import Options
            from evolvent.run.compute import compute

            compute(what, out, Options(resume, overwrite, quiet, scene))
            if not quiet and world().rank == 0:
                for line in what.lines(out):
                    typer.echo(line)
                if existing := [str(out / each) for each in what.files if (out / each).exists()]:
                    typer.echo("done: " + ", ".join(existing))

    shown = ",".join(f"{percent:g}" for percent in kind.percents)
    own = {"out": {"annotation": results_folder(kind.folder)}, "percents": {"annotation": torque_list(shown)}}
    signature = inspect.signature(command, eval_str=True)
    parameters = [each.replace(**own.get(each.name, {})) for each in signature.parameters.values()
                  if each.name != "percents" or kind.percents]
    command.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {each.name: each.annotation for each in parameters}
    command.__doc__ = kind.help
    epilog = "\n".join(["\b", "Examples:", *(f"  {line}" for line in kind.examples.split("\n")), "", STATUSES])
    return Command(kind.name, command, epilog, parallel=True)


COMPUTING = tuple(_command(kind) for kind in KINDS if kind.command == kind.name)
"""The commands of this file, in the order of the help."""
