"""Linear solves T y = b of the Newton steps of one contact system, which reuse factors from step to step.

If a third of the columns gives an approximate tangent (tangent.py), its inverse as a preconditioner leads GMRES to
T⁻¹ b in about five iterations. They run in single precision, which halves the memory that is read, and on the active
unknowns only: outside the nodes in contact T is the identity. Terms of T y nearly cancel, so that single precision
gives about five digits; for more, the residual is computed with all of A in double precision and solved for again.

Tangents of one system are similar, also at other friction coefficients: an earlier factor costs a few more iterations
and is reused until these are too many.
"""

from __future__ import annotations

from dataclasses import dataclass
from inspect import signature

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gmres

from evolvent.contact.newton.reduced_tangent import ReducedTangent
from evolvent.contact.newton.tangent import Tangent
from evolvent_meshes.arrays import Floats, Ints

Singles = NDArray[np.float32]

RELATIVE = "rtol" if "rtol" in signature(gmres).parameters else "tol"  # SciPy's name of the argument until 1.11
SINGLE = 1e-4  # relative accuracy that single precision always reaches
KRYLOV = 30  # iterations before a restart
RESTARTS = 3  # SciPy may stop short of its tolerance and need a second one
REUSE_ITERATIONS = 10  # at most, with an earlier factor; a new factor costs as much
NEARLY = 2.0  # times the wanted residual: an earlier factor that came so close is still good
REFINEMENTS = 6  # after which all columns are factored instead


@dataclass(frozen=True)
class ActiveUnknowns:
    """The u of m unknowns that are not zero, with A and H restricted to them.

    unknowns: (u,) their indices.
    A: (u, u) compliance.
    H: (u, r) rigid motions.
    """

    unknowns: Ints
    A: Singles
    H: Singles

    @staticmethod
    def of(unknowns: Ints, A: Floats, H: Floats) -> ActiveUnknowns:
        """From A (m, m) and H (m, r)."""
        among = np.empty((len(unknowns), len(unknowns)), dtype=np.float32)
        for row, unknown in zip(among, unknowns):  # takes half the time of np.ix_
            row[:] = A[unknown][unknowns]
        return ActiveUnknowns(unknowns, among, H[unknowns].astype(np.float32))

    def matrix(self, M: sp.csr_matrix) -> sp.csr_matrix:
        """M restricted to the active unknowns, (u, u); it has no other entries."""
        place = np.zeros(M.shape[1], dtype=M.indices.dtype)
        place[self.unknowns] = np.arange(len(self.unknowns))
        ends = np.append(0, np.cumsum(np.diff(M.indptr)[self.unknowns]))
        size = len(self.unknowns)
        return sp.csr_matrix((M.data.astype(np.float32), place[M.indices], ends), (size, size))

    def restrict(self, y: Floats) -> Singles:
        """y (m + r,) restricted to the active unknowns, (u + r,)."""
        return np.concatenate([y[self.unknowns], y[len(y) - self.H.shape[1] :]]).astype(np.float32)

    def extend(self, y: Singles, size: int) -> Floats:
        """y (u + r,) extended by zeros to `size` = m + r."""
        whole = np.zeros(size)
        whole[self.unknowns], whole[size - self.H.shape[1] :] = np.split(y, [len(self.unknowns)])
        return whole


class NewtonSteps:
    """Solver for tangents that share the compliance A (m, m) [mm/N] and the rigid motions H (m, r)."""

    def __init__(self, A: Floats, H: Floats) -> None:
        self.A, self.H = A, H
        self._active = ActiveUnknowns.of(np.zeros(0, dtype=int), A, H)
        self._factored: ReducedTangent | None = None

    def solve(self, tangent: Tangent, right: Floats, accuracy: float) -> Floats:
        """T⁻¹ right, (m + r,), to `accuracy` of |right| if columns are left out, else to rounding. Raises NotConverged
        where T is singular."""
        if tangent.whole:
            return tangent.solve(right)
        self._activate(tangent, right)
        M, wanted = self._active.matrix(tangent.M), accuracy * float(np.linalg.norm(right))
        y, residual = np.zeros_like(right), right
        for _ in range(REFINEMENTS):
            size, is_new = float(np.linalg.norm(residual)), self._factored is None
            if size <= wanted:
                return y
            step, reached = self._by_gmres(M, tangent.kept, self._active.restrict(residual), max(wanted / size, SINGLE))
            y = y + self._active.extend(step, len(right))
            if reached and wanted >= SINGLE * size:
                return y
            if is_new and not reached:
                break
            residual = right - tangent.times(y)
        return tangent.solve(right)

    def _activate(self, tangent: Tangent, right: Floats) -> None:
        """Adds the unknowns whose rows or columns in M or whose entries of `right` are not zero to the active ones."""
        before = np.zeros(len(self.A), dtype=bool)
        before[self._active.unknowns] = True
        needed = right[: len(before)] != 0.0
        needed |= np.diff(tangent.M.indptr) > 0
        needed[tangent.M.indices] = True
        if (needed & ~before).any():
            self._active, self._factored = ActiveUnknowns.of(np.flatnonzero(needed | before), self.A, self.H), None

    def _by_gmres(self, M: sp.csr_matrix, kept: Ints, right: Singles, relative: float) -> tuple[Singles, bool]:
        """y (u + r,), and whether its residual is at most `relative` of `right`; an earlier factor that did not lead
        there is dropped."""
        active, earlier = self._active, self._factored is not None
        factored = self._factored or ReducedTangent.of(M, active.A, active.H, np.searchsorted(active.unknowns, kept))

        def times(y: Singles) -> Singles:
            force, motion = np.split(y.ravel(), [len(active.unknowns)])
            return np.concatenate([force - M @ (active.H @ motion - active.A @ force), active.H.T @ force])

        size = 2 * (len(right),)
        T = LinearOperator(size, times, dtype=right.dtype)
        inverse = LinearOperator(size, lambda y: factored.solve(y.ravel()), dtype=right.dtype)
        limits = {"restart": REUSE_ITERATIONS, "maxiter": 1} if earlier else {"restart": KRYLOV, "maxiter": RESTARTS}
        y, failed = gmres(T, right, M=inverse, atol=0.0, **{RELATIVE: relative}, **limits)
        # SciPy ends a cycle by an estimate, so that the residual may be slightly larger than wanted
        reusable = not failed or float(np.linalg.norm(right - times(y))) <= NEARLY * relative * np.linalg.norm(right)
        self._factored = factored if reusable else None
        return y, not failed
