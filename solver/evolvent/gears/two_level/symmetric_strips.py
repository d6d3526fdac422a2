"""The symmetric part of a correction that is known patch by patch.

A patch gives the displacements D under the forces on its own cells. By ½ (D + Dᵀ) those of its own nodes under all
forces near by follow too: half from its patch, half from the patches that its nodes lie in. Where the patches about it
are alike from layer to layer, so is that.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

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
    layers: number of patches, at least 1.
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

    def source_box(self, above: int) -> Ints:
        """First and last + 1 (level, row) (2, 2) with forces, of the patch so many levels above the first."""
        return _box(self.source, self.sources, above)

    def moved_box(self, above: int) -> Ints:
        """First and last + 1 (level, row) (2, 2) of nodes that move, of the patch so many levels above the first."""
        return _box(self.start, self.moved, above)


def _larger(values: Floats, fraction: float) -> slice:
    """Slice from the first to the last value above a fraction of the largest."""
    above = np.flatnonzero(values > fraction * values.max(initial=0.0))
    return slice(int(above[0]), int(above[-1]) + 1) if len(above) else slice(0, 1)


def symmetric_strips(strips: Sequence[Strip], per_layer: int) -> list[Strip]:
    """Strips of ½ (D + Dᵀ), rounded to single precision, from D.

    strips: of D; their sources hold each node once. per_layer: levels of nodes from one patch of a strip to the next.
    """
    result, moved = [], _Moved.of(strips)
    for own in strips:
        near = moved.about(own, per_layer)
        for layers in near.alike():
            others = [(strips[number], layer) for number, layer in near.patches(layers[0])]
            result.append(_symmetric(own, layers, others, per_layer))
    return result


@dataclass(frozen=True, eq=False)
class _Moved:
    """Nodes that the patches of each strip move."""

    start: Ints
    """(s, 2) level and row of the first node that the first patch of each strip moves."""
    size: Ints
    """(s, 2) levels and rows of nodes that each of its patches moves."""
    layers: Ints
    """(s,) its number of patches."""

    @staticmethod
    def of(strips: Sequence[Strip]) -> _Moved:
        start, size = np.array([each.start for each in strips]), np.array([each.moved for each in strips])
        return _Moved(start, size, np.array([each.layers for each in strips]))

    def about(self, own: Strip, per_layer: int) -> _Neighbours:
        """The patches that move the sources of each patch of one of the strips. per_layer: see `symmetric_strips`."""
        (level, row), (q, p) = own.source, own.sources
        here = np.arange(own.layers)[:, None]
        first = np.maximum(0, here + (level - self.start[:, 0] - self.size[:, 0]) // per_layer + 1)
        end = np.minimum(self.layers, here - (self.start[:, 0] - level - q) // per_layer)
        beside = (self.start[:, 1] < row + p) & (self.start[:, 1] + self.size[:, 1] > row)
        return _Neighbours(first, np.where(beside, np.maximum(end - first, 0), 0))


@dataclass(frozen=True, eq=False)
class _Neighbours:
    """The patches that move the sources of each patch of a strip: consecutive ones of each of the strips."""

    first: Ints
    """(layers, strips) the first of these patches, by its place in its strip."""
    count: Ints
    """(layers, strips) their number."""

    def alike(self) -> Iterator[range]:
        """Ranges of consecutive patches whose neighbours are at the same distances."""
        here = np.arange(len(self.first))[:, None]
        around = np.concatenate([self.count, np.where(self.count > 0, self.first - here, 0)], axis=1)
        changes = np.flatnonzero((around[1:] != around[:-1]).any(axis=1)) + 1
        yield from (range(a, b) for a, b in pairwise([0, *changes.tolist(), len(here)]))

    def patches(self, layer: int) -> Iterator[tuple[int, int]]:
        """Number of the strip and place there of each neighbour of a patch."""
        for number in np.flatnonzero(self.count[layer]).tolist():
            first = int(self.first[layer, number])
            yield from ((number, each) for each in range(first, first + int(self.count[layer, number])))


def _symmetric(own: Strip, layers: range, near: Sequence[tuple[Strip, int]], per_layer: int) -> Strip:
    """Strip ½ (D + Dᵀ) of the forces on some patches of a strip. near: those that move the sources of the first."""
    moved, source = own.moved_box(layers[0] * per_layer), own.source_box(layers[0] * per_layer)
    others = [(s.blocks(), s.moved_box(at * per_layer), s.source_box(at * per_layer)) for s, at in near]
    boxes = np.array([moved, *(each for _, _, each in others)])
    low, high, first = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0), source[0]
    change = np.zeros((*own.sources, 3, *(high - low), 3))
    change[(..., *_part(moved - low), slice(None))] += 0.5 * own.blocks()
    for blocks, theirs, forces in others:
        both = np.stack([np.maximum(theirs[0], first), np.minimum(theirs[1], source[1])])
        here = blocks[(..., *_part(both - theirs[0]), slice(None))]
        target = change[_part(both - first)][(..., *_part(forces - low), slice(None))]
        target += 0.5 * np.transpose(here, (3, 4, 5, 0, 1, 2))
    result = change.reshape(len(own.change), -1).astype(np.float32)
    return Strip(result, own.sources, _pair(high - low), _pair(first), _pair(low), len(layers))


def _box(first: tuple[int, int], size: tuple[int, int], above: int) -> Ints:
    low = np.array([first[0] + above, first[1]])
    return np.stack([low, low + size])


def _part(box: Ints) -> tuple[slice, slice]:
    """Slices of levels and rows, from the first to before the last of a box (2, 2)."""
    (level, row), (top, end) = box
    return slice(level, top), slice(row, end)


def _pair(values: Ints) -> tuple[int, int]:
    return int(values[0]), int(values[1])
