"""Draws the pictures of a finished command again, without touching other files of its folder."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from evolvent.dynamics.figures.all import (
    EXCITATION_PICTURE,
    OPERATION_PICTURE,
    TRANSIENT_PICTURES,
    VIBRATION_PICTURES,
)
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Drawn, draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.results.figures.all import pictures
from evolvent.results.figures.loads_picture import LOADS_PICTURE
from evolvent.results.run_data import RunData, read_run
from evolvent.run.begun_commands import begun_command
from evolvent.run.folder_checks import changed_files
from evolvent.strength.results.pictures import FATIGUE_PICTURE, ROOT_STRESS_PICTURE

RUN = "summary.json"
"""File by which a finished run is recognised."""
FROM_TABLES = (
    LOADS_PICTURE, OPERATION_PICTURE, EXCITATION_PICTURE, *VIBRATION_PICTURES, *TRANSIENT_PICTURES,
    ROOT_STRESS_PICTURE, FATIGUE_PICTURE,
)


def plot_folder(out: Path) -> Drawn:
    """Draws the pictures of whatever commands have written to a folder: of a run and of its wear from scene.toml and
    their results, all others from tables. Pictures are drawn even where the scene asks for none, the animation of a run
    only where it does, that of a transient not: the contact lines are in none of its tables.

    Raises SceneError, ArchiveError, WriteError; FolderError where there is nothing to draw, or where a run is computing
    into the folder.
    """
    _require_finished(out)
    with locked(out):
        drawn = _run(out) if (out / RUN).is_file() else Drawn((), ())
        return _both(drawn, draw(from_tables(FROM_TABLES, out), RunFolder(out)))


def _require_finished(out: Path) -> None:
    """Raises FolderError where there is nothing to draw. os.path, unlike pathlib, takes names that no file can have."""
    is_folder = os.path.isdir(out)
    if is_folder and ((out / RUN).is_file() or any(picture.is_of(out) for picture in FROM_TABLES)):
        return
    begun = begun_command(out) if is_folder else None
    missing = f"no {RUN} in it, nor all tables of another picture" if is_folder else "no such directory"
    found = missing if begun is None else f"{begun.found(out)} of `evolvent {' or '.join(begun.names)}`, but {missing}"
    remedy = f"run `evolvent run SCENE.toml --out {out}` first" if begun is None else begun.remedy(out)
    raise FolderError(
        f"{out}: found {found}; allowed: the --out of a finished run, or of another command that draws; "
        f"remedy: {remedy}"
    )


def _both(first: Drawn, second: Drawn) -> Drawn:
    return Drawn(first.written + second.written, first.failures + second.failures)


def _run(out: Path) -> Drawn:
    """Draws the pictures of a run, and of its wear."""
    drawn = draw(pictures(_with_pictures(read_run(out))), RunFolder(out))
    if sentence := changed_files(out):
        drawn = Drawn(drawn.written, (*drawn.failures, sentence))
    if not (out / "wear.json").is_file():
        return drawn
    from evolvent.wear.results import figures
    from evolvent.wear.results.report import read_worn

    return _both(drawn, draw(figures.pictures(read_worn(out)), RunFolder(out)))


def _with_pictures(run: RunData) -> RunData:
    """The run, with a scene that asks for pictures."""
    wanted = run.scene.output.model_copy(update={"pictures": True})
    return replace(run, scene=run.scene.model_copy(update={"output": wanted}))
