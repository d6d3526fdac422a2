"""Files that a user asks a result to write: a table or a picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from evolvent.results.tables.table import csv_text
from evolvent_meshes.files import write_bytes
from evolvent_meshes.input_checks import refuse

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save_rows(path: Path | str, rows: Sequence[Any]) -> Path:
    """Writes rows of a dataclass, one at least, to a CSV file with a column a field, and returns its path; creates
    missing folders. Raises InputError for another ending, WriteError."""
    return write_bytes(_ending(path, ".csv"), csv_text([asdict(row) for row in rows]).encode())


def save_picture(path: Path | str, figure: Callable[..., Figure], *content: object) -> Path:
    """Draws the figure of some content to a PNG file, and returns its path; creates missing folders. Raises InputError
    for another ending, WriteError."""
    from evolvent.results.drawing.style import png_of  # matplotlib takes a second to import

    return write_bytes(_ending(path, ".png"), png_of(figure, *content))


def _ending(path: Path | str, ending: str) -> Path:
    wanted = f"the name of a file that ends in {ending}"
    if not isinstance(path, Path | str) or not Path(path).name:
        refuse("path", wanted, path, f'write "name{ending}"')
    path = Path(path)
    if path.suffix.lower() != ending:
        refuse("path", wanted, path.name, f"write {path.with_suffix(ending)}")
    return path
