"""Matrices with few diagonals as dense tiles of columns, in single precision."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent_meshes.arrays import Ints, Singles

WIDTH = 64
"""Columns of a tile."""


@dataclass(frozen=True)
class TiledBand:
    """Matrix A (n, n) with few diagonals.

    tiles: (columns, rows) the transpose of each WIDTH columns, between the first and the last of their rows.
    top: first row of each tile.
    first: (n,) row of the first entry of each column, n where it has none.
    last: (n,) row of the last entry, −1 where it has none.
    """

    tiles: tuple[Singles, ...]
    top: tuple[int, ...]
    first: Ints
    last: Ints

    @staticmethod
    def of(A: sp.csc_matrix) -> TiledBand:
        """Tiles of a matrix (n, n)."""
        found = [dense_rows(A, start, min(start + WIDTH, A.shape[1])) for start in range(0, A.shape[1], WIDTH)]
        return TiledBand(tuple(tile for _, tile in found), tuple(top for top, _ in found), *ends_of_columns(A))

    @property
    def size(self) -> int:
        """Number n of rows."""
        return len(self.first)


def ends_of_columns(A: sp.csc_matrix) -> tuple[Ints, Ints]:
    """Rows of the first and of the last entry of each column, (n,) each; number of rows and −1 where it has none."""
    first, last = np.full(A.shape[1], A.shape[0]), np.full(A.shape[1], -1)
    used = np.flatnonzero(np.diff(A.indptr))
    first[used] = np.minimum.reduceat(A.indices, A.indptr[used])
    last[used] = np.maximum.reduceat(A.indices, A.indptr[used])
    return first, last


def dense_rows(A: sp.csc_matrix, start: int, end: int) -> tuple[int, Singles]:
    """First row of what is not zero in columns start to end, and the transpose of this part of A; scipy's slices take
    longer than a product with it."""
    ends = A.indptr[start : end + 1]
    rows = A.indices[ends[0] : ends[-1]]
    if not len(rows):
        return 0, np.zeros((end - start, 0), dtype=np.float32)
    low, high = int(rows.min()), int(rows.max()) + 1
    part = np.zeros((end - start, high - low), dtype=np.float32)
    part[np.repeat(np.arange(end - start), np.diff(ends)), rows - low] = A.data[ends[0] : ends[-1]]
    return low, part
