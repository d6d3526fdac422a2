"""Tables of numbers that somebody measured: CSV files whose header names quantity and unit of every column."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshes.data import Floats
from meshes.errors import InputError


class TableError(InputError):
    """Measured numbers that cannot be used as they are; the message names file, line and column."""


@dataclass(frozen=True)
class Column:
    """A quantity, and what one of each unit is in mm: the header is quantity_unit, such as depth_um."""

    quantity: str
    units: tuple[tuple[str, float], ...] = (("um", 1e-3), ("mm", 1.0))

    @property
    def headers(self) -> dict[str, float]:
        """Header -> factor."""
        return {f"{self.quantity}_{unit}": factor for unit, factor in self.units}


def read_columns(path: Path, wanted: Sequence[Column]) -> list[Floats]:
    """The columns (n,) in mm, in the order wanted; others in the file are ignored. Lines that begin with # are remarks.

    Raises TableError for a file that cannot be read, a column that is missing or named twice, a line of another length,
    and a cell that is empty or no finite number.
    """
    header, numbered = _lines(path)
    places = [_place(path, header, column) for column in wanted]
    values = [[_number(path, n, header, row, at) * factor for at, factor in places] for n, row in numbered]
    return list(np.array(values).T)


def has_column(path: Path, wanted: Column) -> bool:
    """Whether a file has this column. Raises TableError for a file that cannot be read."""
    return any(name in wanted.headers for name in _lines(path)[0])


def _lines(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The header, and the lines below it with their numbers. Raises TableError."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise TableError(f"{path}: wanted a CSV file that can be read, found {error}") from error
    numbered = [(n, row) for n, row in enumerate(csv.reader(text.splitlines()), 1) if any(row) and row[0][:1] != "#"]
    if len(numbered) < 2:
        raise TableError(f"{path}: wanted a header and lines of numbers, found {len(numbered)} lines with anything")
    return [cell.strip() for cell in numbered[0][1]], numbered[1:]


def _place(path: Path, header: list[str], column: Column) -> tuple[int, float]:
    known = column.headers
    found = [(at, known[name]) for at, name in enumerate(header) if name in known]
    if len(found) != 1:
        raise TableError(
            f"{path}: wanted one column named {' or '.join(column.headers)}, found {', '.join(header) or 'no header'}; "
            "name quantity and unit in the first line"
        )
    return found[0]


def _number(path: Path, line: int, header: list[str], row: list[str], at: int) -> float:
    if len(row) != len(header):
        raise TableError(f"{path}, line {line}: wanted {len(header)} cells, found {len(row)}")
    try:
        value = float(row[at])
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise TableError(
            f"{path}, line {line}, {header[at]}: wanted a number, found {row[at]!r}; leave out lines without one"
        )
    return value


def require_ascending(path: Path, name: str, values: Floats) -> None:
    """Raises TableError unless every value is above the one before."""
    falls = np.flatnonzero(np.diff(values) <= 0.0)
    if len(falls):
        at = int(falls[0])
        raise TableError(
            f"{path}: wanted {name} that rises from line to line, found {values[at]:g} mm and then "
            f"{values[at + 1]:g} mm; sort the lines and leave out repeated ones"
        )
