"""The compliance of a ring of sectors between some nodes of some teeth, as products."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from evolvent_meshes.arrays import Floats, Ints, Reals, Singles


@dataclass(frozen=True, eq=False)
class TeethCoupling:
    """Coupling of some teeth through all sectors between them, whatever nodes of their flanks touch.

    matrix: (teeth·r, teeth·r), displacements of modes by forces on modes [mm/N].
    """

    matrix: Floats

    def of(self, dtype: Any) -> Reals:
        """The matrix in a precision."""
        return self._single if dtype == np.float32 else self.matrix

    @cached_property
    def principal(self) -> tuple[Floats, Floats]:
        """Eigenvalues λ (teeth·r,) and eigenvectors Q (teeth·r, teeth·r)."""
        λ, Q = np.linalg.eigh(0.5 * (self.matrix + self.matrix.T))
        return λ, Q

    @cached_property
    def _single(self) -> Singles:
        return self.matrix.astype(np.float32)


@dataclass(frozen=True)
class RingWindow:
    """Teeth t with m_t nodes each, tooth by tooth, vectors in the frames of their own sectors.

    own: one a tooth, (m_t·d, m_t·d) compliance of its sector [mm/N].
    modes: one a tooth, (m_t·d, r), of the coupling of sectors.
    coupling: of these teeth.
    """

    own: tuple[Floats, ...]
    modes: tuple[Floats, ...]
    coupling: TeethCoupling

    @property
    def nbytes(self) -> int:
        """Memory [bytes], its copy in single precision included, without the coupling, which belongs to the gear."""
        return sum(each.nbytes + 4 * each.size for each in (*self.own, *self.modes))

    def times(self, forces: Reals) -> Reals:
        """Displacements (Σm_t, d) under forces (Σm_t, d), of their precision."""
        own, modes = self._single if forces.dtype == np.float32 else (self.own, self.modes)
        parts = [part.ravel() for part in np.split(forces, self._ends // forces.shape[1])]
        amplitudes = self.coupling.of(forces.dtype) @ np.concatenate([f @ U for f, U in zip(parts, modes)])
        each = np.split(amplitudes, len(own))
        moved = [C @ f + U @ a for C, U, f, a in zip(own, modes, parts, each)]
        return np.concatenate(moved).reshape(forces.shape)

    def leading(self, tolerance: float) -> tuple[Floats, Floats]:
        """Modes V (Σm_t·d, s) and amounts κ (s,): V κ Vᵀ is the coupling of all teeth without modes below `tolerance`
        of the largest."""
        λ, Q = self.coupling.principal
        kept = np.abs(λ) > tolerance * np.abs(λ).max()
        parts = np.split(Q[:, kept], len(self.own))
        return np.concatenate([U @ part for U, part in zip(self.modes, parts)]), λ[kept]

    @property
    def _ends(self) -> Ints:
        return np.cumsum([len(C) for C in self.own])[:-1]

    @cached_property
    def _single(self) -> tuple[tuple[Singles, ...], tuple[Singles, ...]]:
        """Compliances and modes in single precision."""
        own, modes = (tuple(each.astype(np.float32) for each in group) for group in (self.own, self.modes))
        return own, modes
