"""Correction of normal displacements between the nodes of a position, as dense tiles of nodes near along the face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent_meshes.arrays import Ints, Singles


@dataclass(frozen=True)
class NormalTiles:
    """Symmetric matrix between some nodes (k,) of some teeth, in the order of tooth, level and row: between those of
    one tooth that are no more than some levels apart.

    number: (k,) of each node in this order.
    starts: (t + 1,) first row of each tile, and k.
    first: (t,) first column of each tile.
    tiles: (rows, columns) each [mm/N].
    """

    number: Ints
    starts: Ints
    first: Ints
    tiles: tuple[Singles, ...]

    def add_sandwiched(self, total: Singles, N: sp.csr_matrix, start: int) -> None:
        """Adds N S Nᵀ to a matrix (n, n). N: (n, m) at m of the nodes, from the one with index `start` on."""
        number = self.number[start : start + N.shape[1]]
        first = int(number.min())
        order = np.empty(N.shape[1], dtype=np.int64)
        order[number - first] = np.arange(N.shape[1])
        columns = N[:, order].tocsc()
        dense, rows = np.ascontiguousarray(columns.T.toarray()), _rows_of_columns(columns)
        ends = np.searchsorted(self.starts, [first, first + N.shape[1]])
        for t in range(*ends):
            here = slice(self.starts[t] - first, self.starts[t + 1] - first)
            near = slice(self.first[t] - first, self.first[t] - first + self.tiles[t].shape[1])
            i, j = _span(rows, here), _span(rows, near)
            total[i, j] += (dense[here, i].T @ self.tiles[t]) @ dense[near, j]


def _rows_of_columns(N: sp.csc_matrix) -> tuple[Ints, Ints]:
    """First and last + 1 row of the entries of each column; all of them have some."""
    return np.minimum.reduceat(N.indices, N.indptr[:-1]), np.maximum.reduceat(N.indices, N.indptr[:-1]) + 1


def _span(rows: tuple[Ints, Ints], columns: slice) -> slice:
    return slice(int(rows[0][columns].min()), int(rows[1][columns].max()))
