"""Load over the face: the face load factor K_Hβ of ISO 6336-1:2006, 7.2.2, from the computed contact.

K_Hβ is the largest load per unit of face width over its mean. The load here is the normal force of all tooth pairs in
a layer of the mesh over the layer's extent along z, averaged over the positions of the pitch; the mean is the whole
normal force over the common face width, and K_Hβ is 1 in plane strain. Hence it

- is of the mean over the mesh cycle: at single positions, and on single teeth, the load may be less even;
- is of a layer's mean: where the load rises towards an end of the face it is lower than the limit there, by half of
  what it rises over the end layer;
- has the teeth, the gear bodies, the flanks' modifications and `pair.misalignment_um` in it, but no deflection of
  shafts, bearings and housing, which the standard's f_sh and f_ma have.

Where one gear is wider, a layer may lie on the common face in part: only that part of its extent counts. A part
shorter than half of the layer is taken together with the next layer: the end of the narrower gear presses an edge into
the wider one, and the mean over a strip of hundredths of a millimetre would say more of the mesh than of the pair.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats, Ints

LEAST_SHARE = 0.5
"""Smallest part of a layer on the common face that counts as a layer of its own."""


@dataclass(frozen=True)
class FaceLoad:
    """Normal force of all tooth pairs per unit of face width, at p positions in the l layers that bear load on the
    common face."""

    ends: Floats
    """(l, 2) lower and upper end of each layer on the common face [mm], ascending; −0.5 and 0.5 in 2D."""
    load: Floats
    """(p, l) normal force per face width [N/mm]."""
    mean: Floats
    """(p,) whole normal force over the common face width [N/mm]."""

    @property
    def z(self) -> Floats:
        """(l,) middle of each layer on the common face [mm]."""
        return np.asarray(self.ends.mean(axis=1))

    def relative(self, kept: Ints | None = None, weights: Floats | None = None) -> Floats:
        """Load (l,) of each layer over the mean load, both averaged over the mesh cycle.

        kept: (k,) positions that are averaged, by default all; weights: (k,) of these, by default the same for all.
        """
        rows = slice(None) if kept is None else kept
        *load, mean = np.average(np.column_stack([self.load, self.mean])[rows], axis=0, weights=weights)
        return np.array(load) / mean

    def factor(self, kept: Ints | None = None, weights: Floats | None = None) -> float:
        """The face load factor K_Hβ (≥ 1). kept, weights: see `relative`."""
        return float(self.relative(kept, weights).max())

    def on_layers(self, ends: Floats) -> Floats:
        """Relative load (m,) averaged over other layers, for the comparison of two meshes. ends: (m, 2) [mm]."""
        force = self.relative() * np.diff(self.ends, axis=1)[:, 0]
        after = np.cumsum(force)
        below = np.interp(ends, self.ends.ravel(), np.column_stack([after - force, after]).ravel())
        return np.asarray(np.diff(below, axis=1)[:, 0] / np.diff(ends, axis=1)[:, 0])


def face_load(run: RunData, index: int) -> FaceLoad:
    """The load over the face at the friction coefficient with this index."""
    cuts = [each[index].cut for each in run.positions]
    cut = Slices.joined(cuts)
    position = np.repeat(np.arange(len(cuts)), [len(each.z) for each in cuts])
    _, first, layer = np.unique(np.round(cut.z, 6), return_index=True, return_inverse=True)
    force = np.zeros((len(cuts), len(first)))
    length = cut.width / np.cos(run.pair.pinion.base_helix_angle)
    np.add.at(force, (position, layer), cut.line_load * length)
    common = 1.0 if run.plane else run.pair.face_width
    half = 0.5 * cut.width[first]
    ends = np.clip(np.column_stack([cut.z[first] - half, cut.z[first] + half]), -0.5 * common, 0.5 * common)
    starts = _starts(np.diff(ends, axis=1)[:, 0] / (2.0 * half))
    lower, upper = ends[starts, 0], np.append(ends[starts[1:] - 1, 1], ends[-1, 1])
    load = np.add.reduceat(force, starts, axis=1) / (upper - lower)
    return FaceLoad(np.column_stack([lower, upper]), load, force.sum(axis=1) / common)


def _starts(shares: Floats) -> Ints:
    """Indices (m,) of the layers with which the m layers begin that remain where short parts at both ends of the common
    face join the next layer. shares: (l,) part of each layer on the common face."""
    long = np.flatnonzero(shares >= LEAST_SHARE)
    return np.concatenate([[0], long[1:]]) if len(long) else np.zeros(1, dtype=np.int64)
