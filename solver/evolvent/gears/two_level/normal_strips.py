"""Correction by fine cells of the normal displacements of a swept flank under normal forces, between some of its nodes.

In the frames of the coarse layers the normals are alike from layer to layer, as the patches are. So each strip has one
matrix of numbers, a ninth of its own size, and only the part between the nodes of a position is assembled.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from evolvent.gears.two_level.strips import StripCorrection, first_nodes, node_offset, node_places, turned
from evolvent_meshes.arrays import Floats, Ints, Singles

Indices = NDArray[np.int32]
"""32-bit indices, half the memory of `Ints`."""


@dataclass(frozen=True)
class NormalStrips:
    """Normal part nᵀ S n of the correction S between a flank's nodes.

    correction: S.
    changes: (q·p, Q·P) of each of its strips, in single precision [mm/N].
    """

    correction: StripCorrection
    changes: tuple[Singles, ...]

    @staticmethod
    def of(correction: StripCorrection, normals: Floats) -> NormalStrips:
        """Normal part of a correction. normals: (n, 3) at the nodes."""
        n = turned(normals[correction.numbers], -correction.angle[:, None])
        changes = []
        for strip in correction.strips:
            (q, p), (Q, P) = strip.sources, strip.moved
            (level, row), (start, top) = strip.source, strip.start
            loads, moves = n[level : level + q, row : row + p], n[start : start + Q, top : top + P]
            change = np.einsum("qpaQPb,qpa,QPb->qpQP", strip.blocks(), loads, moves, optimize=True)
            changes.append(change.reshape(q * p, Q * P).astype(np.float32))
        return NormalStrips(correction, tuple(changes))

    def among(self, nodes: Ints, apart: float) -> sp.csr_matrix:
        """Normal correction (k, k) [mm/N] between different nodes (k,), no more than so many coarse layers apart along
        the face."""
        number = np.full(self.correction.size, -1, dtype=np.int32)
        number[nodes] = np.arange(len(nodes), dtype=np.int32)
        parts = list(self._parts(number[self.correction.numbers], apart * self.correction.per_layer))
        rows, columns, values = (np.concatenate(each) for each in zip(*parts, strict=True))
        return sp.csr_matrix((values, (rows, columns)), (len(nodes), len(nodes)))

    def _parts(self, number: Indices, apart: float) -> Iterator[tuple[Indices, Indices, Singles]]:
        """Rows, columns and values of each strip. number: (levels, rows) of the wanted nodes, −1 of others. apart:
        in levels of nodes."""
        correction, number_at, per_row = self.correction, number.ravel(), number.shape[1]
        wanted = (number >= 0)[None]
        for strip, change in zip(correction.strips, self.changes):
            first = first_nodes(strip, wanted, correction.per_layer)
            sources, moved = (
                number_at[node_places(first + node_offset(corner, per_row), size, per_row)]
                for corner, size in ((strip.source, strip.sources), (strip.start, strip.moved))
            )
            rise = _levels(strip.source, strip.sources)[:, None] - _levels(strip.start, strip.moved)
            both = (sources >= 0)[:, :, None] & (moved >= 0)[:, None] & (np.abs(rise) <= apart)
            of_all = sources[:, :, None], moved[:, None], change[None]
            rows, columns, values = (np.broadcast_to(each, both.shape)[both] for each in of_all)
            yield rows, columns, values


def _levels(corner: tuple[int, int], size: tuple[int, int]) -> Ints:
    """Level of each node of a patch with levels and rows of a number, counted from the first node of its strip's first
    patch."""
    return np.repeat(corner[0] + np.arange(size[0]), size[1])
