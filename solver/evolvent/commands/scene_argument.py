"""The scene that a command is given: read and checked on all ranks alike."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from mpi4py import MPI

    from evolvent.scene.scene import Scene


def loaded_scene(
    path: Path,
    level: str | None,
    settings: Sequence[str] | None,
    exact: Sequence[str] | None,
    comm: MPI.Comm | None = None,
    warns: bool = True,
) -> Scene:
    """The scene, read on rank 0 and broadcast. Collective; raises SceneError on all ranks.

    exact: names of --exact. comm: the ranks that take part; None: this process alone, without MPI. warns: print a
    warning on each key that has no effect. Old names are warned of in any case.
    """
    from evolvent.scene.scene import load_scene
    from evolvent.scene.schema.dependence import effectless_keys

    overrides, old = with_level(settings, level), list[str]()
    overrides += [f"exact.parts={json.dumps(exact)}"] if exact else []

    def loaded() -> Scene:
        return load_scene(path, overrides, old.append)

    if comm is None:
        scene = loaded()
    else:
        from evolvent.fem.parallel.ranks import on_first

        scene = on_first(comm, loaded)
    warn(old)
    if warns and (comm is None or comm.rank == 0):
        warn(effectless_keys(scene))
    return scene


def with_level(settings: Sequence[str] | None, level: str | None) -> list[str]:
    """Overrides of --set, and that of --level where it is given."""
    return [*(settings or ()), *([f"mesh.level={json.dumps(level)}"] if level is not None else ())]


def require_room(scene: Scene, command: str, force: bool, comm: MPI.Comm | None = None) -> None:
    """Raises SceneError where the machine has too little memory for the command. force: do not check. Collective.

    comm: the ranks that take part; None: this process alone, without MPI.
    """
    from evolvent.check.problem_size import MEMORY_OF, memory_megabytes, require_memory

    if not force:
        require_memory(scene, MEMORY_OF.get(command, memory_megabytes), comm)


def require(holds: bool, message: str) -> None:
    """Raises a usage error unless `holds`. message: with key, found, allowed and remedy."""
    if not holds:
        raise typer.BadParameter(message)


def warn(sentences: Sequence[str]) -> None:
    """Prints the warnings that a command has returned."""
    for sentence in sentences:
        typer.echo(f"evolvent: warning: {sentence}", err=True)
