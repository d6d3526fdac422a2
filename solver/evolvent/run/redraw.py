"""Draws the pictures of a finished run again, without touching other files of its folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Drawn, draw
from evolvent.results.figures.all import pictures
from evolvent.results.run_data import RunData, read_run
from evolvent.run.folder_checks import changed_files


def plot_folder(out: Path) -> Drawn:
    """Draws the pictures of a run from its scene.toml and its results.

    out: folder of the run. Pictures are drawn even where the scene asks for none, the animation only where it does.

    Raises SceneError, ArchiveError, WriteError; FolderError where a run is computing into the folder.
    """
    with locked(out):
        drawn = draw(pictures(_with_pictures(read_run(out))), RunFolder(out))
        if sentence := changed_files(out):
            drawn = Drawn(drawn.written, (*drawn.failures, sentence))
        if not (out / "wear.json").is_file():
            return drawn
        from evolvent.wear.results import figures
        from evolvent.wear.results.report import read_worn

        worn = draw(figures.pictures(read_worn(out)), RunFolder(out))
        return Drawn(drawn.written + worn.written, drawn.failures + worn.failures)


def _with_pictures(run: RunData) -> RunData:
    """The same run of a scene that asks for pictures."""
    wanted = run.scene.output.model_copy(update={"pictures": True})
    return replace(run, scene=run.scene.model_copy(update={"output": wanted}))
