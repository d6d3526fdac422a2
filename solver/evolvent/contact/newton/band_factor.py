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
        part = M[:, start : start + COLUMNS]
        if not part.nnz:
            continue
        low, high = part.indices.min(), part.indices.max() + 1
        among = columns[:, low:high]
        if not among.nnz:
            continue
        top, bottom = among.indices.min(), among.indices.max() + 1
        dense = among[top:bottom].toarray() @ part[low:high].toarray().astype(np.float32)
        i, j = np.nonzero(dense)
        places.append((i + top, j + start))
        values.append(dense[i, j])
    rows = np.concatenate([i for i, _ in places]) if places else np.zeros(0, dtype=np.int64)
    across = np.concatenate([j for _, j in places]) if places else np.zeros(0, dtype=np.int64)
    data = np.concatenate(values) if values else np.zeros(0, dtype=np.float32)
    return sp.coo_matrix((data, (rows, across)), (A.shape[0], M.shape[1]))


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
