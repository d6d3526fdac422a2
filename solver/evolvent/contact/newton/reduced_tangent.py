"""Inverse of the tangent T = [I + M A, −M H; Hᵀ, 0] with only some columns S of M.

With z = A_S f − H_S δ the solution of T (f, δ) = (b, c) is f = b − M_S z, and

    [I + A_S M_S, H_S; −Hᵀ M_S, 0] (z, δ) = (A_S b, c − Hᵀ b)

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
class ReducedTangent:
    """The parts of a tangent that its inverse needs, all of the same precision.

    columns: S (s,).
    M: M_S (m, s).
    A: A_S (s, m).
    H: (m, r).
    """

    columns: Ints
    M: sp.csr_matrix
    A: Reals
    H: Reals

    @staticmethod
    def of(M: sp.csr_matrix, A: Reals, H: Reals, columns: Ints) -> ReducedTangent:
        """From M and A, (m, m), H (m, r) and the columns to keep."""
        return ReducedTangent(columns, M[:, columns], A[columns], H)

    def solve(self, right: Reals) -> Reals:
        """(f, δ) for a right-hand side, both (m + r,) or (m + r, c). Raises NotConverged where the system is singular
        to double precision."""
        b, load = np.split(right, [len(self.H)])
        if not len(self.columns) + len(load):  # nothing touches and nothing is free
            return b
        known = np.concatenate([self.A @ b, (load - self.H.T @ b) / self._balance])
        z, motion = np.split(lu_solve(self._factor, known, check_finite=False), [len(self.columns)])
        return np.concatenate([b - self.M @ z, motion])

    @cached_property
    def _balance(self) -> float:
        """Divisor of the rows of Hᵀ, so that they are as large as the others."""
        return float(np.abs(self.M.data).max(initial=0.0)) or 1.0

    @cached_property
    def _factor(self) -> tuple[Reals, Ints]:
        s, r = len(self.columns), self.H.shape[1]
        touched = np.flatnonzero(np.diff(self.M.indptr))
        M = self.M[touched]
        B = np.zeros((s + r, s + r), order="F", dtype=self.A.dtype)
        B[:s, :s] = (M.T @ self.A[:, touched].T).T
        B[np.arange(s), np.arange(s)] += 1.0
        B[:s, s:] = self.H[self.columns]
        B[s:, :s] = -(M.T @ self.H[touched]).T / self._balance
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
