"""The pictures of a finished run drawn again, and nothing else of its folder touched."""

from __future__ import annotations

from pathlib import Path

from solver.draw import Drawn, draw
from solver.plots import pictures
from solver.run_data import read_run
from solver.run_folder import RunFolder
from solver.run_lock import locked


def plot_folder(out: Path) -> Drawn:
    """Draws what the scene asks for into OUT/pictures, from OUT/scene.toml and OUT/results.

    Raises SceneError, ArchiveError, FolderError where another run is at it, WriteError.
    """
    with locked(out):
        drawn = draw(pictures(read_run(out)), RunFolder(out))
        if not (out / "wear.json").is_file():
            return drawn
        from wear import plots
        from wear.report import read_worn

        worn = draw(plots.pictures(read_worn(out)), RunFolder(out))
        return Drawn(drawn.written + worn.written, drawn.failures + worn.failures)
