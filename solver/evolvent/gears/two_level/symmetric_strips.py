"""The symmetric part of a correction that is known patch by patch.

A patch gives the displacements D under the forces on its own cells. By ½ (D + Dᵀ) those of its own nodes under all
forces near by follow too: half from its patch, half from the patches that its nodes lie in. Where the patches about it
are alike from layer to layer, so is that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from evolvent_meshes.arrays import Floats, Ints, Reals


@dataclass(frozen=True)
class Strip:
    """Congruent patches at consecutive coarse layers.

    change: (q·p·3, Q·P·3) displacements of Q levels × P rows of nodes by unit forces on q levels × p rows, in the
        frames of the layers [mm/N].
    sources: (q, p).
    moved: (Q, P).
    source: level and row of the first node with forces, at the first layer.
    start: level and row of the first node that moves, at the first layer.
    layers: number of patches.
    """

    change: Reals
    sources: tuple[int, int]
    moved: tuple[int, int]
    source: tuple[int, int]
    start: tuple[int, int]
    layers: int

    def trimmed(self, fraction: float) -> Strip:
        """Strip without the outer levels and rows that move by less than this fraction of those that move most
        (Frobenius norms)."""
        Q, P = self.moved
        change = self.change.reshape(-1, Q, P, 3)
        size = np.einsum("sQPa,sQPa->QP", change, change)
        levels, rows = (_larger(size.max(axis=axis), fraction**2) for axis in (1, 0))
        kept = np.ascontiguousarray(change[:, levels, rows])
        return replace(
            self, change=kept.reshape(len(kept), -1), moved=(kept.shape[1], kept.shape[2]),
            start=(self.start[0] + levels.start, self.start[1] + rows.start),
        )

    def blocks(self) -> Reals:
        """Displacements `change` as (q, p, 3, Q, P, 3)."""
        return self.change.reshape(*self.sources, 3, *self.moved, 3)


def _larger(values: Floats, fraction: float) -> slice:
    """Slice from the first to the last value above a fraction of the largest."""
    above = np.flatnonzero(values > fraction * values.max(initial=0.0))
    return slice(int(above[0]), int(above[-1]) + 1) if len(above) else slice(0, 1)


def symmetric_strips(strips: Sequence[Strip], per_layer: int) -> list[Strip]:
    """Strips of ½ (D + Dᵀ), rounded to single precision, from D.

    strips: of D; their sources hold each node once. per_layer: levels of nodes from one patch of a strip to the next.
    """
    patches = _Patches.of(strips, per_layer)
    result = []
    for _, alike in groupby(range(len(patches.strip)), lambda a: (patches.strip[a], patches.around(a))):
        layers = list(alike)
        result.append(patches.symmetric(strips, layers[0], len(layers)))
    return result


@dataclass(frozen=True)
class _Patches:
    """All patches of all strips, one strip after the other.

    strip: (a,) the strip of each.
    source: (a, 2, 2) first and last + 1 (level, row) with forces.
    moved: (a, 2, 2) the same of those that move.
    """

    strip: Ints
    source: Ints
    moved: Ints

    @staticmethod
    def of(strips: Sequence[Strip], per_layer: int) -> _Patches:
        strip = np.repeat(np.arange(len(strips)), [each.layers for each in strips])
        up = np.concatenate([per_layer * np.arange(each.layers) for each in strips])
        shift = np.stack([up, np.zeros_like(up)], axis=1)[:, None]

        def boxes(first: list[tuple[int, int]], size: list[tuple[int, int]]) -> Ints:
            low = np.array(first)
            return np.asarray(np.stack([low, low + np.array(size)], axis=1)[strip] + shift)

        source = boxes([each.source for each in strips], [each.sources for each in strips])
        return _Patches(strip, source, boxes([each.start for each in strips], [each.moved for each in strips]))

    def moving(self, a: int) -> Ints:
        """Indices of the patches that move some of the sources of patch a, in the order of their strips."""
        low = np.maximum(self.moved[:, 0], self.source[a, 0])
        high = np.minimum(self.moved[:, 1], self.source[a, 1])
        return np.flatnonzero((low < high).all(axis=1))

    def around(self, a: int) -> tuple[tuple[int, int], ...]:
        """Strip and levels above patch a of each patch that moves its sources: two patches of a strip for which this is
        the same are alike."""
        near = self.moving(a)
        above = self.source[near, 0, 0] - self.source[a, 0, 0]
        return tuple(zip(self.strip[near].tolist(), above.tolist()))

    def symmetric(self, strips: Sequence[Strip], a: int, layers: int) -> Strip:
        """Strip ½ (D + Dᵀ) of the forces on patch a, and on those above it that are alike."""
        near = self.moving(a)
        boxes = np.concatenate([self.moved[a : a + 1], self.source[near]])
        low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
        own, (first, _) = strips[self.strip[a]], self.source[a]
        change = np.zeros((*own.sources, 3, *(high - low), 3))
        change[(..., *_part(self.moved[a] - low), slice(None))] += 0.5 * own.blocks()
        for b in near:
            both = np.stack([np.maximum(self.moved[b, 0], first), np.minimum(self.moved[b, 1], self.source[a, 1])])
            here = strips[self.strip[b]].blocks()[(..., *_part(both - self.moved[b, 0]), slice(None))]
            target = change[_part(both - first)][(..., *_part(self.source[b] - low), slice(None))]
            target += 0.5 * np.transpose(here, (3, 4, 5, 0, 1, 2))
        return Strip(
            change.reshape(len(own.change), -1).astype(np.float32), own.sources, _pair(high - low), _pair(first),
            _pair(low), layers,
        )


def _part(box: Ints) -> tuple[slice, slice]:
    """Slices of levels and rows, from the first to before the last of a box (2, 2)."""
    (level, row), (top, end) = box
    return slice(level, top), slice(row, end)


def _pair(values: Ints) -> tuple[int, int]:
    return int(values[0]), int(values[1])
