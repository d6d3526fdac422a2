"""Files that a user asks a result to write: a table or a picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from evolvent.results.tables.table import csv_text
from evolvent_meshes.files import write_bytes
from evolvent_meshes.input_checks import refuse


def save_rows(path: Path | str, rows: Sequence[Any]) -> Path:
    """Writes rows of a dataclass, one at least, to a CSV file with a column a field, and returns its path. Raises
    InputError for another ending, WriteError."""
    return write_bytes(_ending(path, ".csv"), csv_text([asdict(row) for row in rows]).encode())


def save_picture(path: Path | str, png: bytes) -> Path:
    """Writes a picture to a PNG file, and returns its path. Raises InputError for another ending, WriteError."""
    return write_bytes(_ending(path, ".png"), png)


def _ending(path: Path | str, wanted: str) -> Path:
    path = Path(path)
    if path.suffix.lower() != wanted:
        refuse("path", f"the name of a file that ends in {wanted}", path.name, f"write {path.with_suffix(wanted)}")
    return path
