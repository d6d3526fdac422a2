"""Upper triangle of a dense symmetric matrix in strips of rows: half the memory of the square, and products as fast."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats, Ints

Run = tuple[int, int, int]
"""Consecutive rows: where they go, where they come from, how many."""

HEIGHT = 512  # rows of a strip: enough for products at full speed, a sixteenth more than the triangle of 8,000 rows


@dataclass(frozen=True)
class Triangle:
    """Rows 0 … size − 1 in strips, each (rows × size − its first row): from the diagonal of its first row on. What is
    below the diagonal within a strip is of any value."""

    size: int
    strips: tuple[Floats, ...]

    @staticmethod
    def zeros(size: int, empty: Callable[[int, int], Floats]) -> Triangle:
        """A triangle of zeros in arrays made by empty(rows, columns)."""
        strips = [empty(min(HEIGHT, size - row), size - row) for row in range(0, size, HEIGHT)]
        for strip in strips:
            strip[:] = 0.0
        return Triangle(size, tuple(strips))

    @staticmethod
    def within(square: Floats) -> Triangle:
        """Views of the upper triangle of a square matrix."""
        size = len(square)
        return Triangle(size, tuple(square[row : row + HEIGHT, row:] for row in range(0, size, HEIGHT)))

    @property
    def starts(self) -> range:
        """First row of each strip."""
        return range(0, self.size, HEIGHT)

    def subtract_product(self, half: Floats) -> None:
        """self −= halfᵀ half for half (k × size)."""
        for start, strip in zip(self.starts, self.strips):
            strip -= half[:, start : start + len(strip)].T @ half[:, start:]

    def add_last(self, target: Triangle, places: Ints) -> None:
        """Adds the last rows and columns of this to the `places` (sorted) of a target, as many as there are places."""
        runs = _runs(places, self.size - len(places))
        for i, (to, origin, count) in enumerate(runs):
            row = to % HEIGHT
            _add(target.strips[to // HEIGHT][row : row + count], to - row, *self._rows(origin, count), runs[i:])

    def add_first(self, square: Floats, beside: Floats, places: Ints, outside: Ints) -> None:
        """Adds the first rows of this to the rows `places` (sorted) of the upper triangle of a square matrix, and of
        the matrix beside it, there to the columns `outside` (sorted)."""
        runs, columns = _runs(places, 0), _runs(outside, len(places))
        for i, (to, origin, count) in enumerate(runs):
            added = self._rows(origin, count)
            _add(square[to : to + count], 0, *added, runs[i:])
            _add(beside[to : to + count], 0, *added, columns)

    def _rows(self, first: int, count: int) -> tuple[Floats, int]:
        """Rows within one strip, and the number of its first column."""
        row = first % HEIGHT
        return self.strips[first // HEIGHT][row : row + count], first - row


def _runs(places: Ints, first: int) -> list[Run]:
    """The sorted places that rows from `first` on go to, as runs that end where a strip does on either side."""
    origins = np.arange(first, first + len(places))
    begins = (np.diff(places, prepend=-2) != 1) | (places % HEIGHT == 0) | (origins % HEIGHT == 0)
    starts = np.flatnonzero(begins)
    counts = np.diff(np.append(starts, len(places)))
    return list(zip(places[starts].tolist(), origins[starts].tolist(), counts.tolist()))


def _add(target: Floats, left: int, added: Floats, origin: int, columns: list[Run]) -> None:
    """target[:, columns] += added, whose first columns are number `left` and number `origin`: nodes that are numbered
    along the mesh come in long runs."""
    for to, source, count in columns:
        target[:, to - left : to - left + count] += added[:, source - origin : source - origin + count]
