"""LU factors of banded matrices in single precision (LAPACK gbtrf)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg import get_lapack_funcs

from evolvent.contact.newton.snes import NotConverged
from evolvent_meshes.arrays import Singles

COLUMNS = 128
"""Multiplied at once."""


class BandFactor:
    """LU factor of I + A M for A, M (s, s) with few diagonals. Raises NotConverged where it is singular.

    The product is made of dense products of a part of each, ten times faster than a sparse product, and goes straight
    into the band: with their places, its entries would take five times the memory.
    """

    def __init__(self, A: sp.csr_matrix, M: sp.csc_matrix) -> None:
        columns, size = A.tocsc(), A.shape[0]
        self._below, self._above = _diagonals(columns, M)
        middle = self._below + self._above
        band = np.zeros((middle + self._below + 1, size), dtype=np.float32, order="F")
        for start in range(0, size, COLUMNS):
            low, right = _dense(M, start, min(start + COLUMNS, size))
            top, left = _dense(columns, low, low + len(right))
            product = left @ right
            i, j = np.nonzero(product)
            band[middle + i + top - (j + start), j + start] = product[i, j]
        band[middle] += 1.0
        gbtrf, self._gbtrs = get_lapack_funcs(("gbtrf", "gbtrs"), (band,))
        self._lu, self._pivots, info = gbtrf(band, self._below, self._above, overwrite_ab=True)
        if info:
            raise NotConverged("contact: wanted a tangent that can be inverted, found a singular one")

    def solve(self, right: Singles) -> Singles:
        """Solution (I + B)⁻¹ right, (s,) or (s, c)."""
        if not right.size:
            return right
        solution, _ = self._gbtrs(self._lu, self._below, self._above, right, self._pivots)
        return np.asarray(solution)


def _diagonals(A: sp.csc_matrix, M: sp.csc_matrix) -> tuple[int, int]:
    """How many A M has at most, below and above the main one."""
    size = A.shape[0]
    first, last = np.full(size, size), np.full(size, -1)
    used, columns = np.flatnonzero(np.diff(A.indptr)), np.flatnonzero(np.diff(M.indptr))
    first[used] = np.minimum.reduceat(A.indices, A.indptr[used])
    last[used] = np.maximum.reduceat(A.indices, A.indptr[used])
    above = columns - np.minimum.reduceat(first[M.indices], M.indptr[columns])
    below = np.maximum.reduceat(last[M.indices], M.indptr[columns]) - columns
    return int(below.max(initial=0)), int(above.max(initial=0))


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
