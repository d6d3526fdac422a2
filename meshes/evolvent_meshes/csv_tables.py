"""Tables of measured numbers: CSV files whose header names quantity and unit of every column."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.text_files import UnreadableText, read_text

LARGEST_FILE = 20
"""Largest size of a table [MB]."""
LONGEST_FOUND = 60
"""Largest number of characters of a cell in a message."""
LARGEST_NUMBER = 1e15
"""Largest number [mm]: beyond it, squares and sums lose their digits."""


class TableError(InputError):
    """A table that cannot be used.

    place:  file, line and column.
    wanted, found, remedy: phrases without a full stop.
    """

    def __init__(self, place: object, wanted: str, found: str, remedy: str) -> None:
        super().__init__(f"{place}: found {found}; allowed: {wanted}; remedy: {remedy}")
        self.place, self.wanted, self.found, self.remedy = str(place), wanted, found, remedy

    def __reduce__(self) -> tuple[type[TableError], tuple[str, str, str, str]]:
        return TableError, (self.place, self.wanted, self.found, self.remedy)


@dataclass(frozen=True)
class Column:
    """A column of a table; its header is quantity_unit, such as depth_um.

    quantity: name without unit.
    units:    unit, and its size in mm.
    """

    quantity: str
    units: tuple[tuple[str, float], ...] = (("um", 1e-3), ("mm", 1.0))

    @property
    def headers(self) -> dict[str, float]:
        """Header -> size of its unit [mm]."""
        return {f"{self.quantity}_{unit}": factor for unit, factor in self.units}


def read_columns(path: Path, wanted: Sequence[Column]) -> list[Floats]:
    """The wanted columns, each (n,) [mm]. Other columns and lines that begin with # are ignored.

    Raises TableError for a file that cannot be read, a column that is missing or given twice, a line with another
    number of cells, and a cell that holds no finite number.
    """
    header, numbered = _lines(path)
    places = [_place(path, header, column) for column in wanted]
    values = [[_number(path, n, header, row, *place) for place in places] for n, row in numbered]
    return list(np.array(values).T)


def has_column(path: Path, wanted: Column) -> bool:
    """Whether a file has a column. Raises TableError for a file that cannot be read."""
    return any(name in wanted.headers for name in _lines(path)[0])


def _lines(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The header, and the numbered lines below it. Raises TableError."""
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
    """Index of a column in the file, and the size of its unit [mm]. Raises TableError."""
    known = column.headers
    places = [(at, known[name]) for at, name in enumerate(header) if name in known]
    if len(places) != 1:
        names = ", ".join(header)[:LONGEST_FOUND] or "no header"
        remedy = "name quantity and unit in the first line, separated by commas"
        raise TableError(path, f"one column named {' or '.join(known)}", names, remedy)
    return places[0]


def _number(path: Path, line: int, header: list[str], row: list[str], at: int, factor: float) -> float:
    """The number in a cell [mm]. Raises TableError."""
    if len(row) != len(header):
        remedy = "separate columns by commas, and write decimals with a point"
        raise TableError(f"{path}, line {line}", f"{len(header)} cells a line", f"{len(row)} cells", remedy)
    try:
        value = float(row[at]) if "_" not in row[at] else np.nan  # Python reads 1_000 as a thousand
    except ValueError:
        value = np.nan
    if not abs(value * factor) <= LARGEST_NUMBER:
        found, wanted = repr(row[at][:LONGEST_FOUND]), f"a number of at most {LARGEST_NUMBER / factor:g}"
        raise TableError(f"{path}, line {line}, {header[at]}", wanted, found, "leave out lines without one")
    return value * factor


def require_ascending(path: Path, column: Column, name: str, values: Floats) -> None:
    """Raises TableError unless every value [mm] of a file's column is above the previous one. name: of the quantity."""
    falls = np.flatnonzero(np.diff(values) <= 0.0)
    if len(falls):
        header = _lines(path)[0]
        at, factor = _place(path, header, column)
        unit = header[at].removeprefix(f"{column.quantity}_")
        first, second = (f"{value / factor:g} {unit}" for value in values[falls[0] : falls[0] + 2])
        remedy = "sort the lines and leave out repeated ones"
        raise TableError(path, f"{name} that rises from line to line", f"{first} and then {second}", remedy)
