"""The tangent of the contact system and its inverse.

With M = ∂F/∂J (sparse), A the compliance and H the free rigid motions, a Newton step solves

    T y = b ,   T = [I + M A, −M H; Hᵀ, 0]

Only the columns S in which M is not zero couple anything: with z = A_S f − H_S δ the step is f = b_f − M_S z and

    [I + A_S M_S, H_S; −Hᵀ M_S, 0] (z, δ) = (A_S b_f, b_δ − Hᵀ b_f)

which has |S| + r unknowns. Where a point slides, its traction hardly depends on the tangential jump: ∂τ/∂q is
μλ/|q| (I − t⊗t), 1e-3 where slip is large beside the elastic displacement. Leaving such columns out makes the system
a third as large, 27 times cheaper to factor, and the inverse of a nearby tangent: GMRES with the exact one then needs
about five iterations.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack, lu_solve
from scipy.sparse.linalg import LinearOperator, gmres

from meshes.data import Floats, Ints
from solver.newton import NotConverged
from solver.nitsche import ContactOperator, Law

LOOSE = 0.05  # a point whose traction follows the tangential jump with less than this share of γ_t slides freely
KRYLOV = 30  # iterations after which all columns are kept instead


@dataclass(frozen=True)
class Tangent:
    """T at one state. M: (m, m), A: (m, m), H: (m, r). kept: the columns of M that are not left out at first."""

    M: sp.csr_matrix
    A: Floats
    H: Floats
    kept: Ints

    @staticmethod
    def of(operator: ContactOperator, law: Law, A: Floats, H: Floats) -> Tangent:
        """At the state in which `law` holds at the quadrature points. Raises NotConverged where nothing touches."""
        M = operator.tangent(law)
        k = law.traction.shape[1]
        normal = np.arange(M.shape[0]) % k == 0
        kept = _columns(M) & (normal | np.repeat(_held_nodes(operator, law), k))
        if not kept.any() and H.shape[1]:
            raise NotConverged(
                "no node in contact while a motion is free: bring the bodies together, or hold the motion"
            )
        return Tangent(M, A, H, np.flatnonzero(kept))

    def solve(self, right: Floats) -> Floats:
        """T⁻¹ right, (m + r,), to 1e-5 of it where columns are left out. Raises NotConverged where T is singular."""
        if len(self.kept) == np.count_nonzero(_columns(self.M)):
            return self.nearly(right)
        size = 2 * (len(right),)
        T, nearby = LinearOperator(size, self.times), LinearOperator(size, self.nearly)
        # SciPy's default tolerance, 1e-5: a looser one costs Newton steps
        found, failed = gmres(T, right, x0=self.nearly(right), M=nearby, atol=0.0, restart=KRYLOV, maxiter=1)
        return self.complete.nearly(right) if failed else found

    def times(self, y: Floats) -> Floats:
        """T y."""
        force, motion = np.split(y.ravel(), [len(self.A)])
        return np.concatenate([force + self.M @ (self.A @ force - self.H @ motion), self.H.T @ force])

    def nearly(self, right: Floats) -> Floats:
        """The inverse with the kept columns only, times right."""
        b, load = np.split(right.ravel(), [len(self.A)])
        z = lu_solve(self._factor, np.concatenate([self._A_kept @ b, load - self.H.T @ b]), check_finite=False)
        coupled, motion = np.split(z, [len(self.kept)])
        return np.concatenate([b - self._M_kept @ coupled, motion])

    @property
    def complete(self) -> Tangent:
        """The same with all columns kept."""
        return Tangent(self.M, self.A, self.H, np.flatnonzero(_columns(self.M)))

    @cached_property
    def _M_kept(self) -> sp.csr_matrix:
        return self.M[:, self.kept]

    @cached_property
    def _A_kept(self) -> Floats:
        return self.A[self.kept]

    @cached_property
    def _factor(self) -> tuple[Floats, Ints]:
        """LU of the system for z and δ. Raises NotConverged where it is singular to rounding."""
        s, r = len(self.kept), self.H.shape[1]
        touched = np.flatnonzero(np.diff(self._M_kept.indptr))
        M = self._M_kept[touched]
        B = np.zeros((s + r, s + r), order="F")
        B[:s, :s] = (M.T @ self.A[np.ix_(self.kept, touched)].T).T
        B[np.arange(s), np.arange(s)] += 1.0
        B[:s, s:] = self.H[self.kept]
        B[s:, :s] = -(M.T @ self.H[touched]).T
        size = np.abs(B).sum(axis=0).max(initial=0.0)
        lu, pivots, failed = lapack.dgetrf(B, overwrite_a=True)
        if failed or (s + r and lapack.dgecon(lu, size)[0] < np.finfo(float).eps):
            raise NotConverged(
                "a free rigid motion meets no resistance: wanted a support, or friction that sticks somewhere; "
                "support the body, prescribe the motion, or lower the load"
            )
        return lu, pivots


def _columns(M: sp.csr_matrix) -> np.ndarray:
    """Which columns of M hold anything, (m,) bool."""
    used = np.zeros(M.shape[1], dtype=bool)
    used[M.indices[M.data != 0.0]] = True
    return used


def _held_nodes(operator: ContactOperator, law: Law) -> np.ndarray:
    """(n,) bool: nodes with a point near by whose traction follows the tangential jump."""
    held = np.abs(law.derivative[:, 1:, 1:]).max(axis=(1, 2), initial=0.0) > LOOSE
    near = np.zeros(len(operator.nodes), dtype=bool)
    near[operator.shape[np.flatnonzero(held)].indices] = True
    return near
