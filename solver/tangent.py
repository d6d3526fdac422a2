"""The tangent of the contact system and its inverse.

With M = ∂F/∂J (sparse), A the compliance and H the free rigid motions, a Newton step solves

    T y = b ,   T = [I + M A, −M H; Hᵀ, 0]

Only the columns S in which M is not zero couple anything: with z = A_S f − H_S δ the step is f = b_f − M_S z and

    [I + A_S M_S, H_S; −Hᵀ M_S, 0] (z, δ) = (A_S b_f, b_δ − Hᵀ b_f)

which has |S| + r unknowns. Where a point slides, its traction hardly depends on the tangential jump: ∂τ/∂q is
μλ/|q| (I − t⊗t), 1e-3 where slip is large beside the elastic displacement. Leaving such columns out makes the system
a third as large, 27 times cheaper to factor, and the inverse of a nearby tangent: GMRES with all columns then needs
about five iterations. As it need only be nearby, A may be rounded to single precision in it, which halves the memory
that is read; in the product with T it may not, for its terms nearly cancel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from inspect import signature

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs, lu_solve
from scipy.sparse.linalg import LinearOperator, gmres

from meshes.data import Floats, Ints
from solver.newton import NotConverged
from solver.nitsche import ContactOperator, Law

Singles = NDArray[np.float32]

LOOSE = 0.05  # a point whose traction follows the tangential jump with less than this share of γ_t slides freely
ACCURACY = 1e-7  # of a step where columns are left out: a looser one costs Newton steps, and the last digits
RELATIVE = "rtol" if "rtol" in signature(gmres).parameters else "tol"  # SciPy's name for it until 1.11
KRYLOV = 30  # iterations to a restart
RESTARTS = 3  # after which all columns are kept instead; SciPy may stop short of its tolerance and needs a second


@dataclass(frozen=True)
class Compliances:
    """A (m, m) in double precision, and in single precision where that is asked for."""

    exact: Floats

    @cached_property
    def rounded(self) -> Singles:
        return self.exact.astype(np.float32)


@dataclass(frozen=True)
class Tangent:
    """T at one state. M: (m, m), compliances: A, H: (m, r). kept: the columns of M that are not left out at first;
    whole: whether these are all."""

    M: sp.csr_matrix
    compliances: Compliances
    H: Floats
    kept: Ints
    whole: bool

    @staticmethod
    def of(operator: ContactOperator, law: Law, compliances: Compliances, H: Floats) -> Tangent:
        """At the state in which `law` holds at the quadrature points. Raises NotConverged where nothing touches."""
        M = operator.tangent(law)
        k = law.traction.shape[1]
        normal, used = np.arange(M.shape[0]) % k == 0, _columns(M)
        kept = used & (normal | np.repeat(_held_nodes(operator, law), k))
        if not kept.any() and H.shape[1]:
            raise NotConverged(
                "no node in contact while a motion is free: bring the bodies together, or hold the motion"
            )
        return Tangent(M, compliances, H, np.flatnonzero(kept), bool(np.array_equal(kept, used)))

    def solve(self, right: Floats) -> Floats:
        """T⁻¹ right, (m + r,), to 1e-7 of it where columns are left out. Raises NotConverged where T is singular."""
        if self.whole:
            first = self.nearly(right)
            return first + self.nearly(right - self.times(first))  # f = b − M z cancels digits: refined once
        size = 2 * (len(right),)
        T, nearby = LinearOperator(size, self.times, dtype=float), LinearOperator(size, self.nearly, dtype=float)
        options = {"restart": KRYLOV, "maxiter": RESTARTS, "atol": 0.0, RELATIVE: ACCURACY}
        found, failed = gmres(T, right, x0=self.nearly(right), M=nearby, **options)
        return self.complete.solve(right) if failed else found

    def times(self, y: Floats) -> Floats:
        """T y."""
        force, motion = np.split(y.ravel(), [self.M.shape[0]])
        jump = self.H @ motion - self.compliances.exact @ force
        return np.concatenate([force - self.M @ jump, self.H.T @ force])

    def nearly(self, right: Floats) -> Floats:
        """The inverse with the kept columns only, times right."""
        b, load = np.split(right.ravel(), [self.M.shape[0]])
        known = np.concatenate([self._A_kept @ b.astype(self._A.dtype), (load - self.H.T @ b) / self._balance])
        z = lu_solve(self._factor, known.astype(self._A.dtype), check_finite=False).astype(float)
        coupled, motion = np.split(z, [len(self.kept)])
        return np.concatenate([b - self._M_kept @ coupled, motion])

    @property
    def complete(self) -> Tangent:
        """The same with all columns kept."""
        return Tangent(self.M, self.compliances, self.H, np.flatnonzero(_columns(self.M)), whole=True)

    @property
    def _A(self) -> Floats | Singles:
        """The compliance, as exact as `nearly` has to be."""
        return self.compliances.exact if self.whole else self.compliances.rounded

    @cached_property
    def _M_kept(self) -> sp.csr_matrix:
        return self.M[:, self.kept]

    @cached_property
    def _A_kept(self) -> Floats | Singles:
        return self._A[self.kept]

    @cached_property
    def _balance(self) -> float:
        """What the rows of moments are divided by, to be as large as the others."""
        return float(np.abs(self._M_kept.data).max(initial=0.0)) or 1.0

    @cached_property
    def _factor(self) -> tuple[Floats | Singles, Ints]:
        """LU of the system for z and δ. Raises NotConverged where it is singular to rounding."""
        s, r = len(self.kept), self.H.shape[1]
        touched = np.flatnonzero(np.diff(self._M_kept.indptr))
        M = self._M_kept[touched]
        B = np.zeros((s + r, s + r), order="F", dtype=self._A.dtype)
        B[:s, :s] = (M.T.astype(self._A.dtype) @ self._A[np.ix_(self.kept, touched)].T).T
        B[np.arange(s), np.arange(s)] += 1.0
        B[:s, s:] = self.H[self.kept]
        B[s:, :s] = -(M.T @ self.H[touched]).T / self._balance
        getrf, gecon = get_lapack_funcs(("getrf", "gecon"), (B,))
        size = np.abs(B).sum(axis=0).max(initial=0.0)
        lu, pivots, _ = getrf(B, overwrite_a=True)
        # a rounded factor need not be good: GMRES finds out
        if self.whole and s + r and np.isfinite(size) and gecon(lu, size)[0] < np.finfo(float).eps:
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
