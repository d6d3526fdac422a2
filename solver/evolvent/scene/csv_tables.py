"""Tables of numbers that somebody measured: CSV files whose header names quantity and unit of every column."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evolvent.scene.text_files import UnreadableText, read_text
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

LARGEST_FILE = 20
"""Megabytes of a table."""
LONGEST_FOUND = 60
"""Characters that are shown of what was found."""
LARGEST_NUMBER = 1e15
"""mm, a billion km: beyond it squares and sums go wrong."""


class TableError(InputError):
    """Measured numbers that cannot be used as they are.

    place: file, line and column; wanted, found, remedy: phrases without a full stop.
    """

    def __init__(self, place: object, wanted: str, found: str, remedy: str) -> None:
        super().__init__(f"{place}: found {found}; allowed: {wanted}; remedy: {remedy}")
        self.place, self.wanted, self.found, self.remedy = str(place), wanted, found, remedy

    def __reduce__(self) -> tuple[type[TableError], tuple[str, str, str, str]]:
        return TableError, (self.place, self.wanted, self.found, self.remedy)


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
    values = [[_number(path, n, header, row, *place) for place in places] for n, row in numbered]
    return list(np.array(values).T)


def has_column(path: Path, wanted: Column) -> bool:
    """Whether a file has this column. Raises TableError for a file that cannot be read."""
    return any(name in wanted.headers for name in _lines(path)[0])


def _lines(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The header, and the lines below it with their numbers. Raises TableError."""
    try:
        lines = read_text(path, "CSV", LARGEST_FILE).splitlines()
        rows = enumerate(csv.reader(lines, strict=True), 1)
        numbered = [(n, row) for n, row in rows if any(row) and row[0][:1] != "#"]
    except UnreadableText as error:
        raise TableError(path, error.allowed, error.found, error.remedy) from error
    except csv.Error as error:
        raise TableError(path, "a CSV file of numbers", f"no CSV: {error}", "save the table as CSV again") from error
    if len(numbered) < 2:
        remedy = "name quantity and unit of each column in the first line, and put the numbers below"
        raise TableError(path, "a header and lines of numbers", f"{len(numbered)} lines with anything", remedy)
    return [cell.strip() for cell in numbered[0][1]], numbered[1:]


def _place(path: Path, header: list[str], column: Column) -> tuple[int, float]:
    known = column.headers
    found = [(at, known[name]) for at, name in enumerate(header) if name in known]
    if len(found) != 1:
        names = ", ".join(header)[:LONGEST_FOUND] or "no header"
        remedy = "name quantity and unit in the first line, separated by commas"
        raise TableError(path, f"one column named {' or '.join(known)}", names, remedy)
    return found[0]


def _number(path: Path, line: int, header: list[str], row: list[str], at: int, factor: float) -> float:
    """A cell's number times its unit's factor."""
    if len(row) != len(header):
        remedy = "separate columns by commas, and write decimals with a point"
        raise TableError(f"{path}, line {line}", f"{len(header)} cells a line", f"{len(row)} cells", remedy)
    try:
        value = float(row[at]) if "_" not in row[at] else np.nan  # Python takes 1_000 for a thousand
    except ValueError:
        value = np.nan
    if not abs(value * factor) <= LARGEST_NUMBER:
        found, wanted = repr(row[at][:LONGEST_FOUND]), f"a number of at most {LARGEST_NUMBER / factor:g}"
        raise TableError(f"{path}, line {line}, {header[at]}", wanted, found, "leave out lines without one")
    return value * factor


def require_ascending(path: Path, name: str, values: Floats) -> None:
    """Raises TableError unless every value is above the one before."""
    falls = np.flatnonzero(np.diff(values) <= 0.0)
    if len(falls):
        at = int(falls[0])
        found = f"{values[at]:g} mm and then {values[at + 1]:g} mm"
        remedy = "sort the lines and leave out repeated ones"
        raise TableError(path, f"{name} that rises from line to line", found, remedy)
