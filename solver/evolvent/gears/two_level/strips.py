"""Correction of the compliance of a swept flank by fine cells, applied patch by patch along strips of the face.

Displacements and forces are components in the frames of the coarse layers, which turn with the helix. In them congruent
patches along the face have the same matrix, so that those of one strip, the layers of one row of coarse cells, are one
product.

    C ≈ R C_0 Rᵀ + S,   S = ½ (D + Dᵀ),   D = Σ (C_fine − R C_coarse Rᵀ) of each patch under the forces on its own cells
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.symmetric_strips import Strip, symmetric_strips
from evolvent_meshes.arrays import Bools, Floats, Ints, Reals, Singles

Indices = NDArray[np.int32]
"""32-bit indices, half the memory of `Ints`."""


@dataclass(frozen=True, eq=False)
class StripCorrection:
    """Correction S of the compliance between a flank's n nodes, in the frame of tooth 0."""

    lattice: FlankLattice
    """Lattice of the nodes."""
    per_layer: int
    """Levels of nodes in a coarse layer."""
    angle: Floats
    """Rotation (levels,) of the frames of the layers [rad]."""
    strips: tuple[Strip, ...]
    """Strips of S."""

    @staticmethod
    def of(lattice: FlankLattice, per_layer: int, angle: Floats, responses: Sequence[Strip]) -> StripCorrection:
        """The correction from the strips `responses` of D. Raises ValueError where they do not have each node once."""
        held = sum(each.layers * each.sources[0] * each.sources[1] for each in responses)
        if held != lattice.nodes.size:
            raise ValueError(f"patches: wanted sources with each node once, {lattice.nodes.size}, found {held}")
        return StripCorrection(lattice, per_layer, angle, tuple(symmetric_strips(responses, per_layer)))

    @cached_property
    def numbers(self) -> Ints:
        """Numbers (levels, rows) of the nodes."""
        return np.ascontiguousarray(self.lattice.nodes.T)

    @cached_property
    def place(self) -> Indices:
        """Place (n,) of each node among `numbers`."""
        place = np.empty(self.size, dtype=np.int32)
        place[self.numbers.ravel()] = np.arange(self.size, dtype=np.int32)
        return place

    @property
    def size(self) -> int:
        """Number n of nodes."""
        return self.numbers.size

    def among(self, nodes: Sequence[Ints]) -> LoadedStrips:
        """Correction between some nodes of each of some teeth, different ones of a tooth."""
        return LoadedStrips.of(self, nodes)


@dataclass(frozen=True)
class LoadedStrips:
    """Correction S between some nodes (k,) of some teeth: the patches that have some of them. It does not couple teeth,
    but they share the products.

    place: (k,) the nodes in the lattices of all teeth together.
    angle: (k,) of their layers' frames [rad].
    strips: those with such patches.
    counts: how many of each.
    sources: nodes of all these patches, one patch after the other, by their index among the k; k is any other node.
    around: nodes with forces that move them, likewise.
    """

    place: Ints
    angle: Floats
    strips: tuple[Strip, ...]
    counts: tuple[int, ...]
    sources: Indices
    around: Indices

    @staticmethod
    def of(whole: StripCorrection, nodes: Sequence[Ints]) -> LoadedStrips:
        """Correction between some nodes. nodes: of each tooth, different ones."""
        own = np.concatenate([whole.place[each] for each in nodes])
        tooth = np.repeat(np.arange(len(nodes), dtype=np.int32), [len(each) for each in nodes])
        loaded = np.zeros((len(nodes), *whole.numbers.shape), dtype=bool)
        loaded.reshape(len(nodes), -1)[tooth, own] = True
        found = [(strip, first_nodes(strip, loaded, whole.per_layer)) for strip in whole.strips]
        used = [(strip, first) for strip, first in found if len(first)]
        rows, place = whole.numbers.shape[1], own + whole.size * tooth
        index = np.full(len(nodes) * whole.size, len(place), dtype=np.int32)
        index[place] = np.arange(len(place), dtype=np.int32)
        return LoadedStrips(
            place, whole.angle[own // rows],
            tuple(strip for strip, _ in used), tuple(len(first) for _, first in used),
            index[_places([(first + node_offset(s.source, rows), s.sources) for s, first in used], rows)],
            index[_places([(first + node_offset(s.start, rows), s.moved) for s, first in used], rows)],
        )

    @property
    def nbytes(self) -> int:
        """Memory [bytes] without the patches' responses, which belong to the flank."""
        return sum(each.nbytes for each in (self.place, self.angle, self._at, self.sources, self.around))

    def times(self, forces: Reals) -> Reals:
        """Displacements (k, 3) [mm] under forces (k, 3) [N] on all nodes, tooth by tooth, each in the frame of tooth 0.
        Of the precision of the forces."""
        c, s = self._single_turns if forces.dtype == np.float32 else self._turns
        f = np.zeros((len(forces) + 1, 3), forces.dtype)
        f[:-1] = _turned(forces, c, -s)
        near = f.take(self.around, axis=0).ravel()  # four times as fast as indexing
        moved = np.empty(3 * len(self.sources), forces.dtype)
        start = end = 0
        for strip, count in zip(self.strips, self.counts):
            rows, columns = strip.change.shape
            loads = near[start : start + count * columns].reshape(count, columns)
            change = strip.change.astype(forces.dtype, copy=False)
            np.matmul(loads, change.T, out=moved[end : end + count * rows].reshape(count, rows))
            start, end = start + count * columns, end + count * rows
        return _turned(moved.reshape(-1, 3).take(self._at, axis=0), c, s)

    @cached_property
    def _at(self) -> Indices:
        """Where each node (k,) is among the sources, which have it once."""
        at = np.empty(len(self.place) + 1, dtype=np.int32)
        at[self.sources] = np.arange(len(self.sources), dtype=np.int32)
        return at[:-1]

    @cached_property
    def _turns(self) -> tuple[Floats, Floats]:
        """Cosine and sine (k,) of the angles."""
        return np.cos(self.angle), np.sin(self.angle)

    @cached_property
    def _single_turns(self) -> tuple[Singles, Singles]:
        """Cosine and sine (k,) of the angles in single precision."""
        c, s = self._turns
        return c.astype(np.float32), s.astype(np.float32)


def first_nodes(strip: Strip, loaded: Bools, per_layer: int) -> Ints:
    """Distances in places of the patches of a strip with nodes that are `loaded` (teeth, levels, rows) from the first
    patch on the first tooth."""
    (level, row), (q, p), (teeth, levels, rows) = strip.source, strip.sources, loaded.shape
    used = np.zeros((teeth, strip.layers), dtype=bool)
    for up in range(q):
        at = loaded[:, level + up : level + up + (strip.layers - 1) * per_layer + 1 : per_layer, row : row + p]
        used |= at.any(axis=2)
    tooth, layer = np.nonzero(used)
    return np.asarray((tooth * levels + layer * per_layer) * rows, dtype=np.int32)


def node_offset(first: tuple[int, int], rows: int) -> int:
    """Place of the node at a level and row."""
    return first[0] * rows + first[1]


def node_places(first: Ints, size: tuple[int, int], rows: int) -> Ints:
    """Places (m, Q·P) of all nodes of m patches of Q levels × P rows, given by their first nodes (m,)."""
    levels, across = np.arange(size[0])[:, None], np.arange(size[1])
    return np.asarray(first[:, None] + (levels * rows + across).ravel())


def _places(patches: Sequence[tuple[Ints, tuple[int, int]]], rows: int) -> Indices:
    """Places of all nodes of patches, given by their first nodes (m,) and their levels and rows."""
    parts = [node_places(first, size, rows).ravel() for first, size in patches]
    return np.concatenate(parts).astype(np.int32) if parts else np.zeros(0, dtype=np.int32)


def turned(vectors: Floats, angle: Floats) -> Floats:
    """Vectors (..., 3) turned about z by angles (...) [rad]."""
    return np.asarray(_turned(vectors, np.cos(angle), np.sin(angle)))


def _turned(vectors: Reals, c: Reals, s: Reals) -> Reals:
    """Vectors (..., 3) turned about z by angles with cosines c and sines s (...)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    result = np.empty(vectors.shape, vectors.dtype)
    result[..., 0], result[..., 1], result[..., 2] = c * x - s * y, s * x + c * y, z
    return result
