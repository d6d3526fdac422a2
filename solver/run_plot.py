"""The pictures of a finished run drawn again, and nothing else of its folder touched."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from solver.draw import Drawn, draw
from solver.plots import pictures
from solver.run_checks import changed
from solver.run_data import RunData, read_run
from solver.run_folder import RunFolder
from solver.run_lock import locked


def plot_folder(out: Path) -> Drawn:
    """Draws the pictures into OUT/pictures from OUT/scene.toml and OUT/results, also where the scene asked its run for
    none, and the animation if it asks for it.

    Raises SceneError, ArchiveError, FolderError where another run is at it, WriteError.
    """
    with locked(out):
        drawn = draw(pictures(_with_pictures(read_run(out))), RunFolder(out))
        if sentence := changed(out):
            drawn = Drawn(drawn.written, (*drawn.failures, sentence))
        if not (out / "wear.json").is_file():
            return drawn
        from wear import plots
        from wear.report import read_worn

        worn = draw(plots.pictures(read_worn(out)), RunFolder(out))
        return Drawn(drawn.written + worn.written, drawn.failures + worn.failures)


def _with_pictures(run: RunData) -> RunData:
    """The same run of a scene that asks for pictures."""
    wanted = run.scene.output.model_copy(update={"pictures": True})
    return replace(run, scene=run.scene.model_copy(update={"output": wanted}))
