"""Banded matrices in single precision: products and LU factors (LAPACK gbtrf)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg import get_lapack_funcs

from evolvent.contact.newton.snes import NotConverged
from evolvent_meshes.arrays import Singles

COLUMNS = 128
"""Multiplied at once."""


def times_banded(A: sp.csr_matrix, M: sp.csc_matrix) -> sp.coo_matrix:
    """A M of two matrices with few diagonals, by dense products of a part of each: ten times faster than a sparse
    product."""
    columns, places, values = A.tocsc(), [], []
    for start in range(0, M.shape[1], COLUMNS):
        low, right = _dense(M, start, min(start + COLUMNS, M.shape[1]))
        top, left = _dense(columns, low, low + len(right))
        dense = left @ right
        i, j = np.nonzero(dense)
        places.append((i + top, j + start))
        values.append(dense[i, j])
    rows, across = (np.concatenate(each) for each in zip(*places))
    return sp.coo_matrix((np.concatenate(values), (rows, across)), (A.shape[0], M.shape[1]))


def _dense(A: sp.csc_matrix, start: int, end: int) -> tuple[int, Singles]:
    """First row of what is not zero in columns start to end, and this part of A; scipy's slices take longer than the
    product."""
    ends = A.indptr[start : end + 1]
    rows = A.indices[ends[0] : ends[-1]]
    if not len(rows):
        return 0, np.zeros((0, end - start), dtype=np.float32)
    low, high = int(rows.min()), int(rows.max()) + 1
    part = np.zeros((high - low, end - start), dtype=np.float32)
    part[rows - low, np.repeat(np.arange(end - start), np.diff(ends))] = A.data[ends[0] : ends[-1]]
    return low, part


class BandFactor:
    """LU factor of I + B for a banded B (s, s). Raises NotConverged where it is singular."""

    def __init__(self, B: sp.coo_matrix) -> None:
        offset = B.row.astype(np.int64) - B.col
        self._below, self._above = int(offset.max(initial=0)), int(-offset.min(initial=0))
        middle, size = self._below + self._above, B.shape[0]
        band = np.zeros((middle + self._below + 1, size), dtype=np.float32, order="F")
        band[middle + offset, B.col] = B.data
        band[middle] += 1.0
        gbtrf, self._gbtrs = get_lapack_funcs(("gbtrf", "gbtrs"), (band,))
        self._lu, self._pivots, info = gbtrf(band, self._below, self._above, overwrite_ab=True)
        if info:
            raise NotConverged("contact: wanted a tangent that can be inverted, found a singular one")

    def solve(self, right: Singles) -> Singles:
        """(I + B)⁻¹ right, (s,) or (s, c)."""
        if not right.size:
            return right
        solution, _ = self._gbtrs(self._lu, self._below, self._above, right, self._pivots)
        return np.asarray(solution)
