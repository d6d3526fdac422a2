"""What fine cells change in the compliance of a swept flank, as products: patch by patch along strips of the face.

Displacements and forces are components in the frames of the coarse layers, which turn with the helix. In them congruent
patches along the face have the same matrix, so that those of one strip, the layers of one row of coarse cells, are one
product.

    C ≈ R C_0 Rᵀ + ½ (D + Dᵀ),   D = Σ (C_fine − R C_coarse Rᵀ) of each patch, under the forces on its own cells
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.arrays import Bools, Floats, Ints, Reals, Singles


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

    change: Floats
    sources: tuple[int, int]
    moved: tuple[int, int]
    source: tuple[int, int]
    start: tuple[int, int]
    layers: int

    def trimmed(self, fraction: float) -> Strip:
        """Without the outer levels and rows that move by less than this fraction of what those moving most do
        (Frobenius norms)."""
        Q, P = self.moved
        change = self.change.reshape(-1, Q, P, 3)
        size = np.einsum("sQPa,sQPa->QP", change, change)
        levels, rows = (_larger(size.max(axis=axis), fraction**2) for axis in (1, 0))
        kept = np.ascontiguousarray(change[:, levels, rows])
        return replace(
            self, change=kept.reshape(len(kept), -1), moved=(kept.shape[1], kept.shape[2]),
            start=(self.start[0] + levels.start, self.start[1] + rows.start),
        )  # fmt: skip

    @cached_property
    def single(self) -> Singles:
        """`change` in single precision."""
        return self.change.astype(np.float32)


def _larger(values: Floats, fraction: float) -> slice:
    """From the first to the last value above a fraction of the largest."""
    above = np.flatnonzero(values > fraction * values.max(initial=0.0))
    return slice(int(above[0]), int(above[-1]) + 1) if len(above) else slice(0, 1)


class StripCorrection:
    """½ (D + Dᵀ) of a flank's n nodes, in the frame of tooth 0.

    lattice: of the nodes.
    per_layer: levels of nodes in a coarse layer.
    angle: (levels,) by which the frames of the layers are turned [rad].
    strips: their sources hold each node once.
    """

    def __init__(self, lattice: FlankLattice, per_layer: int, angle: Floats, strips: Sequence[Strip]) -> None:
        self.lattice, self.per_layer, self.angle, self.strips = lattice, per_layer, angle, tuple(strips)
        self.numbers = np.ascontiguousarray(lattice.nodes.T)  # (levels, rows)

    @property
    def size(self) -> int:
        """n."""
        return self.numbers.size

    def among(self, nodes: Sequence[Ints]) -> LoadedStrips:
        """Between some nodes of each of some teeth, different ones of a tooth."""
        return LoadedStrips(self, nodes)

    def normal(self, normals: Floats) -> sp.csr_matrix:
        """(n, n) normal displacements under normal forces [mm/N], in single precision; normals: (n, 3)."""
        n = turned(normals[self.numbers], -self.angle[:, None])
        rows, columns, values = [], [], []
        for strip in self.strips:
            (q, p), (Q, P) = strip.sources, strip.moved
            (level, row), (start, top) = strip.source, strip.start
            change = strip.change.reshape(q, p, 3, Q, P, 3)
            loads, moves = n[level : level + q, row : row + p], n[start : start + Q, top : top + P]
            scalar = np.einsum("qpaQPb,qpa,QPb->qpQP", change, loads, moves, optimize=True).astype(np.float32)
            for first in range(0, strip.layers * self.per_layer, self.per_layer):
                sources = self.numbers[level + first : level + first + q, row : row + p].ravel()
                moved = self.numbers[start + first : start + first + Q, top : top + P].ravel()
                rows.append(np.repeat(sources, len(moved)))
                columns.append(np.tile(moved, len(sources)))
                values.append(scalar.ravel())
        size = (self.size, self.size)
        D = sp.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), size)
        return ((D + D.T) * np.float32(0.5)).tocsr()


@dataclass(frozen=True)
class _Run:
    """Layers of a strip on one tooth."""

    tooth: int
    layers: range


class LoadedStrips:
    """½ (D + Dᵀ) between some nodes of each of some teeth: the strips that have some of them, with their layers. The
    teeth do not feel each other, but share the products."""

    def __init__(self, whole: StripCorrection, nodes: Sequence[Ints]) -> None:
        self._whole = whole
        place = np.empty(whole.size, dtype=np.int64)
        place[whole.numbers.ravel()] = np.arange(whole.size)
        own = [place[each] for each in nodes]
        self._angle = whole.angle[np.concatenate(own) // whole.numbers.shape[1]]
        self._place = np.concatenate([tooth * whole.size + each for tooth, each in enumerate(own)])
        loaded = np.zeros((len(nodes), whole.size), dtype=bool)
        loaded.ravel()[self._place] = True
        self._shape = (len(nodes), *whole.numbers.shape, 3)
        runs = [(strip, _runs(strip, loaded.reshape(self._shape[:-1]))) for strip in whole.strips]
        self._strips = [(strip, each) for strip, each in runs if each]

    def times(self, forces: Reals) -> Reals:
        """Displacements (k, 3) [mm] under forces (k, 3) [N] on all nodes, tooth by tooth, each in the frame of tooth 0.
        Of the precision of the forces."""
        f = np.zeros(self._shape, forces.dtype)
        f.reshape(-1, 3)[self._place] = turned(forces, -self._angle)
        u = np.zeros_like(f)
        for strip, runs in self._strips:
            _add(strip, runs, self._whole.per_layer, f, u)
        half = forces.dtype.type(0.5)
        return turned(half * u.reshape(-1, 3)[self._place], self._angle).astype(forces.dtype, copy=False)


def _runs(strip: Strip, loaded: Bools) -> list[_Run]:
    """The layers of a strip with forces, `loaded` (teeth, levels, rows), and those between them."""
    (level, row), (q, p) = strip.source, strip.sources
    used = loaded[:, level : level + strip.layers * q, row : row + p].reshape(len(loaded), strip.layers, -1).any(axis=2)
    first, last = used.argmax(axis=1), strip.layers - used[:, ::-1].argmax(axis=1)
    return [_Run(int(t), range(first[t], last[t])) for t in np.flatnonzero(used.any(axis=1))]


def turned(vectors: Reals, angle: Floats) -> Reals:
    """Vectors (..., 3) turned about z by angles (...) [rad]."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=-1)


def _add(strip: Strip, runs: Sequence[_Run], step: int, f: Reals, u: Reals) -> None:
    """Adds (D + Dᵀ) f of some layers of a strip, each `step` levels from the one before, to u; both are C-contiguous
    (teeth, levels, rows, 3)."""
    change = strip.single if f.dtype == np.float32 else strip.change
    own = [_patches(f, run, strip.source, strip.sources, step) for run in runs]
    around = [_patches(f, run, strip.start, strip.moved, step) for run in runs]
    moved, back = _rows(own) @ change, _rows(around) @ change.T
    at = 0
    for run in runs:
        end = at + len(run.layers)
        target = _patches(u, run, strip.source, strip.sources, step)
        target += back[at:end].reshape(target.shape)
        Q, P = strip.moved
        places = moved[at:end].reshape(-1, Q, P, 3)
        for first in range(0, Q, step):  # neighbouring patches meet
            width, (level, row) = min(step, Q - first), strip.start
            target = _patches(u, run, (level + first, row), (width, P), step)
            target += places[:, first : first + width]
        at = end


def _patches(field: Reals, run: _Run, first: tuple[int, int], size: tuple[int, int], step: int) -> Reals:
    """View (layers, Q, P, 3) of the Q levels × P rows of a field at each layer. first: level and row at layer 0."""
    tooth, level, row, _ = field.strides
    start = run.tooth * tooth + (first[0] + run.layers.start * step) * level + first[1] * row
    shape, strides = (len(run.layers), *size, 3), (step * level, level, row, field.itemsize)
    return np.ndarray(shape, field.dtype, field, start, strides)


def _rows(parts: Sequence[Reals]) -> Reals:
    """Patches (layers, Q, P, 3) of all runs as rows."""
    return np.concatenate([part.reshape(len(part), -1) for part in parts])
