"""Upper triangle of a dense symmetric matrix in strips of rows.

It takes half the memory of the square, and matrix products on strips run as fast as on the square.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats, Ints

RowRun = tuple[int, int, int]
"""Consecutive rows: first row in the target, first row in the source, their number."""

HEIGHT = 512
"""Rows of a strip: enough for products at full speed, a sixteenth more than the triangle of 8,000 rows."""


@dataclass(frozen=True)
class PackedTriangle:
    """Upper triangle of a symmetric matrix (size × size).

    size: rows and columns.
    strips: (rows, size − first row) each, from the diagonal of the strip's first row on; entries below the diagonal
        within a strip are undefined.
    """

    size: int
    strips: tuple[Floats, ...]

    @staticmethod
    def zeros(size: int, empty: Callable[[int, int], Floats]) -> PackedTriangle:
        """A triangle of zeros in arrays made by empty(rows, columns)."""
        strips = [empty(min(HEIGHT, size - row), size - row) for row in range(0, size, HEIGHT)]
        for strip in strips:
            strip[:] = 0.0
        return PackedTriangle(size, tuple(strips))

    @staticmethod
    def view(square: Floats) -> PackedTriangle:
        """Views of the upper triangle of a square matrix."""
        size = len(square)
        return PackedTriangle(size, tuple(square[row : row + HEIGHT, row:] for row in range(0, size, HEIGHT)))

    @property
    def starts(self) -> range:
        """First row of each strip."""
        return range(0, self.size, HEIGHT)

    def subtract_product(self, half: Floats) -> None:
        """Subtracts a product: self −= halfᵀ half for half (k × size)."""
        for start, strip in zip(self.starts, self.strips):
            strip -= half[:, start : start + len(strip)].T @ half[:, start:]

    def add_trailing(self, target: PackedTriangle, places: Ints) -> None:
        """Add the trailing rows and columns, as many as there are places, to the rows and columns `places` (sorted) of
        a target."""
        runs = _runs(places, self.size - len(places))
        for i, (to, origin, count) in enumerate(runs):
            row = to % HEIGHT
            _add(target.strips[to // HEIGHT][row : row + count], to - row, *self._rows(origin, count), runs[i:])

    def add_leading(self, square: Floats, beside: Floats, places: Ints, outside: Ints) -> None:
        """Add the leading rows to the rows `places` (sorted) of two blocks side by side.

        square: upper triangle of a square block; it takes the leading columns, at `places`.
        beside: the block to its right; it takes the other columns, at its columns `outside` (sorted).
        """
        runs, columns = _runs(places, 0), _runs(outside, len(places))
        for i, (to, origin, count) in enumerate(runs):
            added = self._rows(origin, count)
            _add(square[to : to + count], 0, *added, runs[i:])
            _add(beside[to : to + count], 0, *added, columns)

    def _rows(self, first: int, count: int) -> tuple[Floats, int]:
        """Rows within one strip, and the number of their first column."""
        row = first % HEIGHT
        return self.strips[first // HEIGHT][row : row + count], first - row


def _runs(places: Ints, first: int) -> list[RowRun]:
    """Runs that take the rows from `first` on to the sorted `places`; none crosses the end of a strip on either side.
    """
    origins = np.arange(first, first + len(places))
    begins = (np.diff(places, prepend=-2) != 1) | (places % HEIGHT == 0) | (origins % HEIGHT == 0)
    starts = np.flatnonzero(begins)
    counts = np.diff(np.append(starts, len(places)))
    return list(zip(places[starts].tolist(), origins[starts].tolist(), counts.tolist()))


def _add(target: Floats, left: int, added: Floats, origin: int, columns: list[RowRun]) -> None:
    """Adds columns, target[:, columns] += added; `left` and `origin` are the numbers of their first columns.

    Runs are long where nodes are numbered along the mesh.
    """
    for to, source, count in columns:
        target[:, to - left : to - left + count] += added[:, source - origin : source - origin + count]
