"""LU factors of banded matrices in single precision (LAPACK gbtrf)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.lib.stride_tricks import as_strided
from scipy.linalg import get_lapack_funcs

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tiled_band import WIDTH, TiledBand, dense_rows
from evolvent_meshes.arrays import Singles


class BandFactor:
    """LU factor of I + A M for A, M (s, s) with few diagonals. Raises NotConverged where it is singular.

    The product is made of dense products of tiles, ten times faster than a sparse product, and is added to the band
    straight away: with their places, its entries would take five times the memory.
    """

    def __init__(self, A: TiledBand, M: sp.csc_matrix) -> None:
        size = A.size
        self._below, self._above = _diagonals(A, M)
        middle = self._below + self._above
        # so high that a tile, zero outside the band, never meets an entry of the band twice
        height = max([middle + self._below + 1] + [tile.shape[1] + 2 for tile in A.tiles])
        band = np.zeros((size, height), dtype=np.float32)
        columns = as_strided(band.ravel()[middle:], (size, size), (4 * height - 4, 4))  # of I + A M
        for start in range(0, size, WIDTH):
            low, part = dense_rows(M, start, min(start + WIDTH, size))
            high = low + part.shape[1]
            for t in range(low // WIDTH, -(-high // WIDTH)):
                a, b = max(low, t * WIDTH), min(high, t * WIDTH + WIDTH)
                tile, top = A.tiles[t][a - t * WIDTH : b - t * WIDTH], A.top[t]
                columns[start : start + WIDTH, top : top + tile.shape[1]] += part[:, a - low : b - low] @ tile
        band[:, middle] += 1.0
        gbtrf, self._gbtrs = get_lapack_funcs(("gbtrf", "gbtrs"), (band,))
        self._lu, self._pivots, info = gbtrf(band.T, self._below, self._above, overwrite_ab=True)
        if info:
            raise NotConverged("contact: wanted a tangent that can be inverted, found a singular one")

    def solve(self, right: Singles) -> Singles:
        """Solution (I + B)⁻¹ right, (s,) or (s, c)."""
        if not right.size:
            return right
        solution, _ = self._gbtrs(self._lu, self._below, self._above, right, self._pivots)
        return np.asarray(solution)


def _diagonals(A: TiledBand, M: sp.csc_matrix) -> tuple[int, int]:
    """How many A M has at most, below and above the main one."""
    columns = np.flatnonzero(np.diff(M.indptr))
    above = columns - np.minimum.reduceat(A.first[M.indices], M.indptr[columns])
    below = np.maximum.reduceat(A.last[M.indices], M.indptr[columns]) - columns
    return int(below.max(initial=0)), int(above.max(initial=0))
