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
        """Solution (f, δ) for a right-hand side, both (u + r,). Raises NotConverged where it is singular."""
        ...


class ActiveCompliance(Protocol):
    """Compliance A between u of its unknowns, in the precision in which Newton steps are iterated."""

    @property
    def dtype(self) -> type:
        """Floating-point type of the iterations of a Newton step."""
        ...

    @property
    def refactored(self) -> bool:
        """Whether each tangent is to have an inverse of its own, which costs as much as a few products; otherwise an
        earlier one serves until it leads to too many iterations."""
        ...

    def times(self, force: Reals) -> Reals:
        """Jumps A f (u,) [mm] under forces f (u,) [N]."""
        ...

    def inverse(self, M: sp.csr_matrix, motions: FreeMotions, kept: Ints) -> Inverse:
        """Approximates [I + M A, −M H; Hᵀ, D]⁻¹.

        M: ∂F/∂J (u, u).
        motions: H (u, r) and D (r, r) of the free rigid motions.
        kept: columns of M that are not left out.
        """
        ...


class JumpCompliance(Protocol):
    """Compliance A (m, m) [mm/N] of a contact system in local jumps, symmetric."""

    @property
    def k(self) -> int:
        """Components a node."""
        ...

    @property
    def matrix(self) -> Floats | None:
        """Matrix A (m, m) [mm/N], None where the compliance is only applied to forces."""
        ...

    @property
    def nbytes(self) -> int:
        """Memory [bytes], without parts shared with the compliances of other positions."""
        ...

    def times(self, force: Floats) -> Floats:
        """Jumps A f (m,) [mm] under forces f (m,) [N]."""
        ...

    def active(self, unknowns: Ints) -> ActiveCompliance:
        """Compliance between some unknowns (u,)."""
        ...

    def normal(self) -> JumpCompliance:
        """Compliance between normal components alone."""
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
        """Memory of the matrix [bytes]."""
        return self.matrix.nbytes

    def times(self, force: Floats) -> Floats:
        """Jumps A f (m,) [mm] under forces f (m,) [N]."""
        return np.asarray(self.matrix @ force)

    def active(self, unknowns: Ints) -> DenseActive:
        """Compliance matrix between some unknowns (u,), in single precision."""
        among = np.empty((len(unknowns), len(unknowns)), dtype=np.float32)
        for row, unknown in zip(among, unknowns):  # takes half the time of np.ix_
            row[:] = self.matrix[unknown][unknowns]
        return DenseActive(among)

    def normal(self) -> DenseCompliance:
        """Compliance matrix between normal components alone."""
        return DenseCompliance(np.ascontiguousarray(self.matrix[:: self.k, :: self.k]), 1)  # BLAS needs that


@dataclass(frozen=True)
class DenseActive:
    """Compliance matrix between active unknowns, in single precision, which halves the memory to read.

    A: (u, u).
    """

    A: Singles
    dtype = np.float32
    refactored = False

    def times(self, force: Reals) -> Reals:
        """Jumps A f (u,) [mm] under forces f (u,) [N]."""
        return np.asarray(self.A @ force)

    def inverse(self, M: sp.csr_matrix, motions: FreeMotions, kept: Ints) -> Inverse:
        """Inverse of the tangent [I + M A, −M H; Hᵀ, D], exact but for the columns of M that are left out."""
        return ReducedTangent.of(M, self.A, motions, kept)
