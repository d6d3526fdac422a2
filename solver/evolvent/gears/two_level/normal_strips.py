"""Correction by fine cells of the normal displacements of a swept flank under normal forces, between some of its nodes.

In the frames of the coarse layers the normals are alike from layer to layer, as the patches are. So each strip has one
matrix of numbers, a ninth of its own size, and only the part between the nodes of a position is assembled.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.gears.two_level.normal_tiles import NormalTiles
from evolvent.gears.two_level.strips import Indices, LoadedStrips, StripCorrection, turned
from evolvent_meshes.arrays import Floats, Ints, Singles


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

    def among(self, loaded: LoadedStrips) -> NormalTiles:
        """Normal correction [mm/N] between the nodes (k,) of `loaded`."""
        order = np.argsort(loaded.place)
        place, number = loaded.place[order], np.full(len(order) + 1, -1, dtype=np.int32)
        number[order] = np.arange(len(order), dtype=np.int32)
        starts, first, ends = self._tiles(place)
        widths, heights = ends - first, np.diff(starts)
        offsets = np.append(0, np.cumsum(widths * heights))
        row = np.arange(len(place)) - np.repeat(starts[:-1], heights)
        base = np.repeat(offsets[:-1] - first, heights) + row * np.repeat(widths, heights)
        values = np.zeros(offsets[-1], dtype=np.float32)
        for rows, columns, change in self._entries(loaded, number):
            values[base[rows] + columns] = change
        tiles = [values[a:b].reshape(-1, w) for a, b, w in zip(offsets, offsets[1:], widths)]
        return NormalTiles(number[:-1].astype(np.int64), starts, first, tuple(tiles))

    def _tiles(self, place: Ints) -> tuple[Ints, Ints, Ints]:
        """First row of each tile and their number, first column and last + 1 of each: tiles are as many levels high as
        a layer, and have as many more below and above as are coupled. place: (k,) sorted."""
        levels, rows = self.correction.numbers.shape
        tooth, level = np.divmod(place // rows, levels)
        layer = level // self.correction.per_layer
        starts = np.flatnonzero(np.diff(tooth * levels + layer, prepend=-1))
        high = self.correction.per_layer
        low = layer[starts] * high
        bottom, top = np.maximum(low - self._reach, 0), np.minimum(low + high + self._reach, levels)
        first, ends = (np.searchsorted(place, (tooth[starts] * levels + each) * rows) for each in (bottom, top))
        return np.append(starts, len(place)), first, ends

    def _entries(self, loaded: LoadedStrips, number: Indices) -> Iterator[tuple[Indices, Indices, Singles]]:
        """Rows, columns and values of each strip. number: (k + 1,) of the nodes in the tiles' order, −1 for none."""
        start = end = 0
        for strip, count in zip(loaded.strips, loaded.counts):
            change = self._change[id(strip)]
            q, p = change.shape
            sources = number[loaded.sources[start : start + count * q]].reshape(count, q)
            moved = number[loaded.around[end : end + count * p]].reshape(count, p)
            start, end = start + count * q, end + count * p
            used, near = np.flatnonzero((sources >= 0).any(axis=0)), np.flatnonzero((moved >= 0).any(axis=0))
            sources, moved = sources[:, used], moved[:, near]
            both = (sources >= 0)[:, :, None] & (moved >= 0)[:, None]
            of_all = sources[:, :, None], moved[:, None], change[np.ix_(used, near)][None]
            rows, columns, values = (np.broadcast_to(each, both.shape)[both] for each in of_all)
            yield rows, columns, values

    @cached_property
    def _reach(self) -> int:
        """Levels of nodes over which the correction couples."""
        rises = [
            np.abs(_levels(s.source, s.sources)[:, None] - _levels(s.start, s.moved)).max()
            for s in self.correction.strips
        ]
        return int(max(rises))

    @cached_property
    def _change(self) -> dict[int, Singles]:
        """The matrix of each strip, by its identity."""
        return {id(strip): change for strip, change in zip(self.correction.strips, self.changes)}


def _levels(corner: tuple[int, int], size: tuple[int, int]) -> Ints:
    """Level of each node of a patch with levels and rows of a number, counted from the first node of its strip's first
    patch."""
    return np.repeat(corner[0] + np.arange(size[0]), size[1])
