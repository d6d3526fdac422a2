"""The compliance of a ring of sectors between some nodes of some teeth, as products."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent_meshes.arrays import Floats, Ints, Reals


@dataclass(frozen=True)
class RingWindow:
    """Teeth t with m_t nodes each, tooth by tooth, vectors in the frames of their own sectors.

    own: one a tooth, (m_t·d, m_t·d) compliance of its sector [mm/N].
    modes: one a tooth, (m_t·d, r), of the coupling of sectors.
    coupling: (teeth·r, teeth·r), displacements of modes by forces on modes [mm/N].
    """

    own: tuple[Reals, ...]
    modes: tuple[Reals, ...]
    coupling: Reals

    @property
    def nbytes(self) -> int:
        """Memory [bytes], its copy in single precision included."""
        return sum(each.nbytes + 4 * each.size for each in (*self.own, *self.modes, self.coupling))

    def times(self, forces: Reals) -> Reals:
        """Displacements (Σm_t, d) under forces (Σm_t, d), of their precision."""
        if forces.dtype == np.float32 != self.coupling.dtype:
            return self._single.times(forces)
        parts = [part.ravel() for part in np.split(forces, self._ends // forces.shape[1])]
        amplitudes = self.coupling @ np.concatenate([f @ U for f, U in zip(parts, self.modes)])
        each = np.split(amplitudes, len(self.own))
        moved = [C @ f + U @ a for C, U, f, a in zip(self.own, self.modes, parts, each)]
        return np.concatenate(moved).reshape(forces.shape)

    def leading(self, tolerance: float) -> tuple[Floats, Floats]:
        """Modes V (Σm_t·d, s) and amounts κ (s,): V κ Vᵀ is the coupling of all teeth without modes below `tolerance`
        of the largest."""
        λ, Q = np.linalg.eigh(0.5 * (self.coupling + self.coupling.T))
        kept = np.abs(λ) > tolerance * np.abs(λ).max()
        parts = np.split(Q[:, kept], len(self.own))
        return np.concatenate([U @ part for U, part in zip(self.modes, parts)]), λ[kept]

    @property
    def _ends(self) -> Ints:
        return np.cumsum([len(C) for C in self.own])[:-1]

    @cached_property
    def _single(self) -> RingWindow:
        own, modes = (tuple(each.astype(np.float32) for each in group) for group in (self.own, self.modes))
        return RingWindow(own, modes, self.coupling.astype(np.float32))
