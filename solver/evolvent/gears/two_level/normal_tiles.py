"""Correction of normal displacements between the nodes of a position, as dense tiles of nodes near along the face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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

    def part(self, rows: tuple[int, int], columns: tuple[int, int]) -> Singles:
        """Rows and columns from the first to before the last of each pair, zero where no tile is."""
        (low, high), (left, right) = rows, columns
        result = np.zeros((high - low, right - left), dtype=np.float32)
        for t in range(np.searchsorted(self.starts, low, side="right") - 1, np.searchsorted(self.starts, high)):
            start, first, tile = self.starts[t], self.first[t], self.tiles[t]
            i, top = max(low, start), min(high, start + len(tile))
            j, end = max(left, first), min(right, first + tile.shape[1])
            if j < end:
                inner = tile[i - start : top - start, j - first : end - first]
                result[i - low : top - low, j - left : end - left] = inner
        return result
