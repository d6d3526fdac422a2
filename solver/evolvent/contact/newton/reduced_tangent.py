"""Inverse of the tangent T = [I + M A, −M H; Hᵀ, D] with only some columns S of M.

With z = A_S f − H_S δ the solution of T (f, δ) = (b, c) is f = b − M_S z, and

    [I + A_S M_S, H_S; −Hᵀ M_S, D] (z, δ) = (A_S b, c − Hᵀ b)

which has |S| + r unknowns.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import get_lapack_funcs, lu_solve

from evolvent.contact.newton.snes import NotConverged
from evolvent_meshes.arrays import Ints, Reals


class FreeMotion(NotConverged):
    """A rigid motion of a body that nothing resists."""


@dataclass(frozen=True)
class FreeMotions:
    """Free rigid motions of bodies: the jumps that they cause, and the forces that resist them."""

    jumps: Reals
    """H (m, r), jumps by unit amplitudes."""
    resistance: Reals
    """D (r, r), forces against unit amplitudes, symmetric; zero in statics, where contact alone holds them."""

    @staticmethod
    def unresisted(jumps: Reals) -> FreeMotions:
        """Free rigid motions in statics, without inertia. jumps: H (m, r)."""
        return FreeMotions(jumps, np.zeros((jumps.shape[1],) * 2, dtype=jumps.dtype))

    @property
    def count(self) -> int:
        """Number r of free rigid motions."""
        return self.jumps.shape[1]

    def of(self, unknowns: Ints, dtype: type) -> FreeMotions:
        """Free rigid motions with some of the jumps (u,), in a precision."""
        return FreeMotions(self.jumps[unknowns].astype(dtype), self.resistance.astype(dtype))

    def balance(self, force: Reals, motion: Reals) -> Reals:
        """Residual Hᵀ f + D δ (r,) of the balance of forces on the free rigid motions."""
        return self.jumps.T @ force + self.resistance @ motion


@dataclass(frozen=True)
class ReducedTangent:
    """The parts of a tangent that its inverse needs, all of the same precision.

    columns: S (s,).
    M: M_S (m, s).
    A: A_S (s, m).
    motions: H (m, r) and D (r, r).
    """

    columns: Ints
    M: sp.csr_matrix
    A: Reals
    motions: FreeMotions

    @staticmethod
    def of(M: sp.csr_matrix, A: Reals, motions: FreeMotions, columns: Ints) -> ReducedTangent:
        """Reduced tangent from M and A, (m, m), the free rigid motions and the columns to keep."""
        return ReducedTangent(columns, M[:, columns], A[columns], motions)

    def solve(self, right: Reals) -> Reals:
        """Solution (f, δ) for a right-hand side, both (m + r,) or (m + r, c). Raises NotConverged where the system is
        singular to double precision."""
        H = self.motions.jumps
        b, load = np.split(right, [len(H)])
        if not len(self.columns) + len(load):  # nothing touches and nothing is free
            return b
        known = np.concatenate([self.A @ b, (load - H.T @ b) / self._balance])
        z, motion = np.split(lu_solve(self._factor, known, check_finite=False), [len(self.columns)])
        return np.concatenate([b - self.M @ z, motion])

    @cached_property
    def _balance(self) -> float:
        """Divisor of the rows of Hᵀ and D, so that they are as large as the others."""
        largest = float(np.abs(self.M.data).max(initial=0.0))
        return max(largest, float(np.abs(self.motions.resistance).max(initial=0.0))) or 1.0

    @cached_property
    def _factor(self) -> tuple[Reals, Ints]:
        s, r, H = len(self.columns), self.motions.count, self.motions.jumps
        touched = np.flatnonzero(np.diff(self.M.indptr))
        M = self.M[touched]
        B = np.zeros((s + r, s + r), order="F", dtype=self.A.dtype)
        B[:s, :s] = (M.T @ self.A[:, touched].T).T
        B[np.arange(s), np.arange(s)] += 1.0
        B[:s, s:] = H[self.columns]
        B[s:, :s] = -(M.T @ H[touched]).T / self._balance
        B[s:, s:] = self.motions.resistance / self._balance
        getrf, gecon = get_lapack_funcs(("getrf", "gecon"), (B,))
        size = np.abs(B).sum(axis=0).max(initial=0.0)
        lu, pivots, _ = getrf(B, overwrite_a=True)
        # a factor in single precision need not be good: the iterations it preconditions show that
        if B.dtype == float and s + r and np.isfinite(size) and gecon(lu, size)[0] < np.finfo(float).eps:
            raise FreeMotion(
                "contact: wanted supports, or friction that sticks, against every free rigid motion, found one that "
                "meets no resistance; support the body, prescribe the motion, or lower the load"
            )
        return lu, pivots
