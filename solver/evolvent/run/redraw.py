"""Draws the pictures of a finished run or transient again, without touching other files of its folder."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from evolvent.dynamics.results.transient.kept_tables import PICTURE, START_PICTURE, KeptTables
from evolvent.dynamics.results.transient.rows import TRANSIENT
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Drawn, Picture, draw
from evolvent.results.figures.all import pictures
from evolvent.results.run_data import RunData, read_run
from evolvent.run.folder_checks import changed_files

RUN = "summary.json"
DRAWN_AGAIN = RUN, TRANSIENT
"""Files that say that there is something to draw: of `evolvent run`, of `evolvent transient`."""


def plot_folder(out: Path) -> Drawn:
    """Draws the pictures of a run from its scene.toml and its results, that of a transient from its tables, or both.

    out: folder with one of `DRAWN_AGAIN`. Pictures are drawn even where the scene asks for none, the animation of a run
    only where it does, that of a transient not: the contact lines are in none of its tables.

    Raises SceneError, ArchiveError, WriteError; FolderError where there is neither, or where a run is computing into
    the folder.
    """
    _require_finished(out)
    with locked(out):
        drawn = _run(out) if (out / RUN).is_file() else Drawn((), ())
        return _both(drawn, _transient(out)) if (out / TRANSIENT).is_file() else drawn


def _require_finished(out: Path) -> None:
    """Raises FolderError where there is nothing to draw. os.path, unlike pathlib, takes names that no file can have."""
    if any(os.path.isfile(out / name) for name in DRAWN_AGAIN):
        return
    missing = f"no {RUN} in it, and no {TRANSIENT}" if os.path.isdir(out) else "no such directory"
    begun = " --resume" if os.path.exists(out / "results/state.npz") else ""
    raise FolderError(
        f"{out}: found {missing}; allowed: the --out of a finished run or transient; remedy: run `evolvent run "
        f"SCENE.toml --out {out}{begun}` first"
    )


def _both(first: Drawn, second: Drawn) -> Drawn:
    return Drawn(first.written + second.written, first.failures + second.failures)


def _run(out: Path) -> Drawn:
    """Those of a run, and of its wear."""
    drawn = draw(pictures(_with_pictures(read_run(out))), RunFolder(out))
    if sentence := changed_files(out):
        drawn = Drawn(drawn.written, (*drawn.failures, sentence))
    if not (out / "wear.json").is_file():
        return drawn
    from evolvent.wear.results import figures
    from evolvent.wear.results.report import read_worn

    return _both(drawn, draw(figures.pictures(read_worn(out)), RunFolder(out)))


def _transient(out: Path) -> Drawn:
    tables = KeptTables.read(out)

    def drawn() -> bytes:
        from evolvent.dynamics.figures.transient import transient_picture  # matplotlib takes a second to import

        return transient_picture(tables.title, tables.rows, tables.teeth, tables.facts)

    def start_drawn() -> bytes:
        from evolvent.dynamics.figures.transient_start import start_picture

        return start_picture(tables.title, tables.started)

    started = [Picture(START_PICTURE, start_drawn)] if tables.started else []
    return draw([Picture(PICTURE, drawn), *started], RunFolder(out))


def _with_pictures(run: RunData) -> RunData:
    """The same run of a scene that asks for pictures."""
    wanted = run.scene.output.model_copy(update={"pictures": True})
    return replace(run, scene=run.scene.model_copy(update={"output": wanted}))
