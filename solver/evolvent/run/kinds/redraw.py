"""Draws the pictures of a finished computation again, without touching other files of its folder."""

from __future__ import annotations

import os
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from evolvent.results.archive.run_folder import LOCK, FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Drawn, draw
from evolvent.run.computation import Computation
from evolvent.run.folder_checks import STUDY, begun_command, changed_files
from evolvent.run.kinds.all import kind_of
from evolvent.scene.scene import kept_scene


def plot_folder(out: Path) -> Drawn:
    """Draws the pictures of the computation that has written to a folder. Pictures are drawn even where the scene asks
    for none; animations only where it does, that of a transient not: the contact lines are in none of its tables.

    Raises SceneError, ArchiveError, WriteError; FolderError where there is nothing to draw, or where something is
    computed into the folder.
    """
    with locked(out) if _is_used(out) else nullcontext():  # first, as a running call has not ended
        what = _finished(out)
        drawn = draw(what.pictures(out), RunFolder(out))
        changed = changed_files(what, out)
        return replace(drawn, failures=(*drawn.failures, changed)) if changed else drawn


def _is_used(out: Path) -> bool:
    """Whether a call has begun in a folder, or runs there. Others are not locked: a lock removes what is empty."""
    return os.path.isdir(out) and bool(os.path.lexists(os.path.join(out, LOCK)) or begun_command(out))


def _finished(out: Path) -> Computation[object]:
    """The computation of a folder. Raises FolderError where none has ended there. os.path, unlike pathlib, takes names
    that no file can have."""
    command = begun_command(out) if os.path.isdir(out) else ""
    if command == "study":
        raise _nothing_to_draw(
            out, f"a study ({STUDY})", f"`evolvent study STUDY.toml --out {out}` draws its pictures again, `evolvent "
            f"plot {out / 'scenes/NAME'}` those of a scene"
        )
    if not command:
        found = "no results in it" if os.path.isdir(out) else "no such directory"
        raise _nothing_to_draw(out, found, f"run `evolvent run SCENE.toml --out {out}` first")
    again = f"run `evolvent {command} SCENE.toml --out {out} --resume` first"
    if not (out / "scene.toml").is_file():
        found = f"results of `evolvent {command}` without their scene.toml, as earlier versions left them"
        raise _nothing_to_draw(out, found, again)
    scene = kept_scene(out / "scene.toml")
    what: Computation[object] = kind_of(command, scene).load().of(scene)
    if not (out / what.outputs.tables[0]).is_file():
        found = f"results of `evolvent {command}`, but no {what.outputs.tables[0]}"
        raise _nothing_to_draw(out, found, again)
    return what


def _nothing_to_draw(out: Path, found: str, remedy: str) -> FolderError:
    return FolderError(
        f"{out}: found {found}; allowed: the --out of a finished command that draws; remedy: {remedy}"
    )
