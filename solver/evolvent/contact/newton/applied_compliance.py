"""Compliance applied to forces without a matrix, with an approximate matrix for preconditioning.

    A ≈ blockdiag(A_1, A_2, ...) + U K Uᵀ

The blocks are weakly coupled contacts, such as the tooth pairs of a gear: normal components only, good to
a few per cent. U are the few smooth modes that they share.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from evolvent.contact.newton.block_inverse import BlockInverse, NearlyNormal, RoughContacts
from evolvent.contact.newton.jump_compliance import DenseCompliance, JumpCompliance
from evolvent.contact.newton.reduced_tangent import FreeMotions
from evolvent_meshes.arrays import Floats, Ints, Reals


class SurfaceCompliance(Protocol):
    """Contribution of one body to the compliance of n nodes, in local jumps with k components."""

    def times(self, force: Reals) -> Reals:
        """Jumps (n, k) [mm] under forces (n, k) [N], of their precision."""
        ...

    def normal(self) -> SurfaceCompliance:
        """Contribution to the compliance between normal components alone."""
        ...

    def nearly(self) -> NearlyNormal:
        """Approximation of the contribution as block matrix and modes, for `NearlyNormal.sum`."""
        ...

    @property
    def nbytes(self) -> int:
        """Memory that the contribution uses alone [bytes]."""
        ...


@dataclass(frozen=True)
class AppliedCompliance:
    """Compliance A as the sum of the contributions of the bodies, applied to forces without a matrix.

    surfaces: one a body.
    k: components a node.
    known: `rough` where it is known, else None.
    """

    surfaces: tuple[SurfaceCompliance, ...]
    k: int
    known: NearlyNormal | None = None
    matrix = None

    @cached_property
    def rough(self) -> NearlyNormal:
        """Approximation of A as block matrix and modes, for preconditioning."""
        return self.known or NearlyNormal.sum([surface.nearly() for surface in self.surfaces]).of_few_modes()

    def times(self, force: Reals) -> Reals:
        """Jumps A f (m,) [mm] under forces f (m,) [N]."""
        f = force.reshape(-1, self.k)
        return np.asarray(sum(surface.times(f) for surface in self.surfaces)).ravel()

    def active(self, unknowns: Ints) -> AppliedActive:
        """Compliance between some unknowns (u,)."""
        return AppliedActive(self, unknowns)

    @property
    def nbytes(self) -> int:
        """Memory [bytes] of the contributions of the bodies and of the approximate matrix."""
        return self.rough.nbytes + sum(surface.nbytes for surface in self.surfaces)

    def normal(self) -> AppliedCompliance:
        """Compliance between normal components alone."""
        rough = self.rough.normal(self.k).of_few_modes()
        return AppliedCompliance(tuple(s.normal() for s in self.surfaces), 1, rough)


@dataclass(frozen=True)
class AppliedActive:
    """Applied compliance between some unknowns (u,)."""

    whole: AppliedCompliance
    unknowns: Ints
    dtype = np.float32
    refactored = True

    def times(self, force: Reals) -> Reals:
        """Jumps A f (u,) [mm] under forces f (u,) [N] on the unknowns."""
        f = np.zeros(self.whole.rough.size, dtype=np.float32)
        f[self.unknowns] = force
        return self.whole.times(f)[self.unknowns]

    def inverse(self, M: sp.csr_matrix, motions: FreeMotions, kept: Ints) -> BlockInverse:
        """Approximate inverse of the tangent [I + M A, −M H; Hᵀ, D], contact by contact. kept: columns of M that are
        not left out."""
        return BlockInverse(self._rough, M, motions, kept)

    @cached_property
    def _rough(self) -> RoughContacts:
        return RoughContacts.of(self.whole.rough, self.unknowns)


COUNTED = 1e-2
"""Fraction of the largest change of the compliance by any mode above which the approximate matrix has a mode."""


@dataclass(frozen=True)
class ModalSurface:
    """Modal contribution Φ diag(s) Φᵀ to an `AppliedCompliance` whose approximate matrix already has it.

    modes: Φ (n·k, m).
    amounts: s (m,), none zero [mm/N per unit amplitudes].
    k: components a node.
    """

    modes: Floats
    amounts: Floats
    k: int

    def times(self, force: Reals) -> Reals:
        """Jumps (n, k) [mm] by the modes under forces (n, k) [N], in the precision of the forces."""
        moved = self.modes @ (self.amounts * (force.ravel() @ self.modes))
        return np.asarray(moved, dtype=force.dtype).reshape(force.shape)

    def normal(self) -> ModalSurface:
        """Modal contribution to the compliance between normal components alone."""
        return ModalSurface(self.modes[:: self.k], self.amounts, 1)

    def nearly(self) -> NearlyNormal:
        """Modes that change the compliance by more than `COUNTED` of the largest change."""
        size = np.abs(self.amounts) * np.sum(self.modes**2, axis=0)
        counted = size > COUNTED * size.max(initial=0.0)
        return NearlyNormal((), self.modes[:, counted], self.amounts[counted])

    @property
    def nbytes(self) -> int:
        """Memory of the modes [bytes]."""
        return self.modes.nbytes


def with_modes(A: JumpCompliance, modes: Floats, amounts: Floats) -> JumpCompliance:
    """A + Φ diag(s) Φᵀ. modes: Φ (n·k, m). amounts: s (m,), none zero."""
    if A.matrix is not None:
        return DenseCompliance(A.matrix + (modes * amounts) @ modes.T, A.k)
    assert isinstance(A, AppliedCompliance)
    if not len(amounts):
        return A
    added = ModalSurface(modes, amounts, A.k)
    return AppliedCompliance((*A.surfaces, added), A.k, A.rough.with_modes(added.nearly()))


def summed(
    parts: Sequence[NDArray[np.float64] | SurfaceCompliance], k: int, known: NearlyNormal | None = None
) -> JumpCompliance:
    """Compliance of bodies that are all matrices (n·k, n·k), or all applied without one. known: its approximate matrix,
    None where that is not known."""
    matrices = [part for part in parts if isinstance(part, np.ndarray)]
    surfaces = [part for part in parts if not isinstance(part, np.ndarray)]
    if not surfaces:
        return DenseCompliance(np.asarray(sum(matrices)), k)
    if matrices:
        raise ValueError("compliance: wanted bodies that are all matrices or all products, found some of each")
    return AppliedCompliance(tuple(surfaces), k, known)
