"""The compliance of a contact system in local jumps: as a matrix, or as products with forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.reduced_tangent import FreeMotions, ReducedTangent
from evolvent_meshes.arrays import Floats, Ints, Reals, Singles


class Inverse(Protocol):
    """An inverse of a tangent, exact or approximate."""

    def solve(self, right: Reals) -> Reals:
        """(f, δ) for a right-hand side, both (u + r,). Raises NotConverged where it is singular."""
        ...


class ActiveCompliance(Protocol):
    """A among u of its unknowns, in the precision in which Newton steps are iterated."""

    @property
    def dtype(self) -> type:
        """Of the iterations."""
        ...

    @property
    def refactored(self) -> bool:
        """Whether each tangent is to have an inverse of its own, which costs as much as a few products; otherwise an
        earlier one serves until it leads to too many iterations."""
        ...

    def times(self, force: Reals) -> Reals:
        """A f (u,) [mm]."""
        ...

    def inverse(self, M: sp.csr_matrix, motions: FreeMotions, kept: Ints) -> Inverse:
        """Approximates [I + M A, −M H; Hᵀ, D]⁻¹.

        M: ∂F/∂J (u, u).
        motions: H (u, r) and D (r, r) of the free rigid motions.
        kept: columns of M that are not left out.
        """
        ...


class JumpCompliance(Protocol):
    """A (m, m) [mm/N], symmetric."""

    @property
    def k(self) -> int:
        """Components a node."""
        ...

    @property
    def matrix(self) -> Floats | None:
        """Its entries, None where it is known by products only."""
        ...

    @property
    def nbytes(self) -> int:
        """Memory [bytes], without what it shares with those of other positions."""
        ...

    def times(self, force: Floats) -> Floats:
        """A f (m,) [mm] under forces f (m,) [N]."""
        ...

    def active(self, unknowns: Ints) -> ActiveCompliance:
        """A among some unknowns (u,)."""
        ...

    def normal(self) -> JumpCompliance:
        """A of the normal components."""
        ...


@dataclass(frozen=True)
class DenseCompliance:
    """A compliance as a matrix.

    matrix: A (m, m).
    k: components a node.
    """

    matrix: Floats
    k: int

    @property
    def nbytes(self) -> int:
        """See `JumpCompliance.nbytes`."""
        return self.matrix.nbytes

    def times(self, force: Floats) -> Floats:
        """See `JumpCompliance.times`."""
        return np.asarray(self.matrix @ force)

    def active(self, unknowns: Ints) -> DenseActive:
        """See `JumpCompliance.active`."""
        among = np.empty((len(unknowns), len(unknowns)), dtype=np.float32)
        for row, unknown in zip(among, unknowns):  # takes half the time of np.ix_
            row[:] = self.matrix[unknown][unknowns]
        return DenseActive(among)

    def normal(self) -> DenseCompliance:
        """See `JumpCompliance.normal`."""
        return DenseCompliance(np.ascontiguousarray(self.matrix[:: self.k, :: self.k]), 1)  # BLAS needs that


@dataclass(frozen=True)
class DenseActive:
    """Its part among the active unknowns: single precision halves the memory that is read.

    A: (u, u).
    """

    A: Singles
    dtype = np.float32
    refactored = False

    def times(self, force: Reals) -> Reals:
        """See `ActiveCompliance.times`."""
        return np.asarray(self.A @ force)

    def inverse(self, M: sp.csr_matrix, motions: FreeMotions, kept: Ints) -> Inverse:
        """See `ActiveCompliance.inverse`; exact but for the columns left out."""
        return ReducedTangent.of(M, self.A, motions, kept)
