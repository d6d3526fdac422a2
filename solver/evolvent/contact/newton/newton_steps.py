"""Newton steps of one position, one after the other: T y = b with much kept from step to step.

Where a third of the columns makes a nearby tangent (tangent.py), its inverse leads GMRES to T⁻¹ b in about five
iterations. They run in single precision, which halves what is read, and on the unknowns that take part: outside the
nodes in contact T is the identity. In T y terms nearly cancel, so single precision gives about five digits; for more,
what is left is computed with the whole A in double precision, and solved for again.

Tangents of one position are alike, also at other friction coefficients: the factor of an earlier one needs a few
iterations more and is kept until these are too many.
"""

from __future__ import annotations

from dataclasses import dataclass
from inspect import signature

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gmres

from evolvent.contact.newton.reduced_tangent import KeptColumns
from evolvent.contact.newton.tangent import Tangent
from evolvent_meshes.arrays import Floats, Ints

Singles = NDArray[np.float32]

RELATIVE = "rtol" if "rtol" in signature(gmres).parameters else "tol"  # SciPy's name for it until 1.11
SINGLE = 1e-4  # accuracy that single precision surely gives
KRYLOV = 30  # iterations to a restart
RESTARTS = 3  # SciPy may stop short of its tolerance and needs a second
PATIENCE = 10  # iterations that an earlier factor is given; making another costs as much
NEARLY = 2.0  # times the wanted residual: an earlier factor that came so close has served
ROUNDS = 6  # after which all columns are factored instead


@dataclass(frozen=True)
class Part:
    """The unknowns that take part, u of m: which, and A (u, u), H (u, r) there."""

    unknowns: Ints
    A: Singles
    H: Singles

    @staticmethod
    def of(unknowns: Ints, A: Floats, H: Floats) -> Part:
        among = np.empty((len(unknowns), len(unknowns)), dtype=np.float32)
        for row, unknown in zip(among, unknowns):  # half the time of np.ix_
            row[:] = A[unknown][unknowns]
        return Part(unknowns, among, H[unknowns].astype(np.float32))

    def matrix(self, M: sp.csr_matrix) -> sp.csr_matrix:
        """M (u, u), which has no entry elsewhere."""
        place = np.zeros(M.shape[1], dtype=M.indices.dtype)
        place[self.unknowns] = np.arange(len(self.unknowns))
        ends = np.append(0, np.cumsum(np.diff(M.indptr)[self.unknowns]))
        size = len(self.unknowns)
        return sp.csr_matrix((M.data.astype(np.float32), place[M.indices], ends), (size, size))

    def restrict(self, y: Floats) -> Singles:
        """(u + r,) of y (m + r,)."""
        return np.concatenate([y[self.unknowns], y[len(y) - self.H.shape[1] :]]).astype(np.float32)

    def extend(self, y: Singles, size: int) -> Floats:
        """y (u + r,) and zero elsewhere: (m + r,), of this size."""
        whole = np.zeros(size)
        whole[self.unknowns], whole[size - self.H.shape[1] :] = np.split(y, [len(self.unknowns)])
        return whole


class NewtonSteps:
    """Solves with tangents that share A (m, m) and H (m, r)."""

    def __init__(self, A: Floats, H: Floats) -> None:
        self.A, self.H = A, H
        self._part = Part.of(np.zeros(0, dtype=int), A, H)
        self._nearby: KeptColumns | None = None

    def solve(self, tangent: Tangent, right: Floats, accuracy: float) -> Floats:
        """T⁻¹ right, (m + r,), to `accuracy` of |right| where columns are left out, else to rounding. Raises
        NotConverged where T is singular."""
        if tangent.whole:
            return tangent.solve(right)
        self._take_part(tangent, right)
        M, wanted = self._part.matrix(tangent.M), accuracy * float(np.linalg.norm(right))
        found, left = np.zeros_like(right), right
        for _ in range(ROUNDS):
            size, renewed = float(np.linalg.norm(left)), self._nearby is None
            if size <= wanted:
                return found
            step, enough = self._by_gmres(M, tangent.kept, self._part.restrict(left), max(wanted / size, SINGLE))
            found = found + self._part.extend(step, len(right))
            if enough and wanted >= SINGLE * size:
                return found
            if renewed and not enough:
                break
            left = right - tangent.times(found)
        return tangent.solve(right)

    def _take_part(self, tangent: Tangent, right: Floats) -> None:
        """Lets all unknowns take part whose rows or columns in M or whose entries of `right` are not zero."""
        before = np.zeros(len(self.A), dtype=bool)
        before[self._part.unknowns] = True
        takes = right[: len(before)] != 0.0
        takes |= np.diff(tangent.M.indptr) > 0
        takes[tangent.M.indices] = True
        if (takes & ~before).any():
            self._part, self._nearby = Part.of(np.flatnonzero(takes | before), self.A, self.H), None

    def _by_gmres(self, M: sp.csr_matrix, kept: Ints, right: Singles, share: float) -> tuple[Singles, bool]:
        """y (u + r,) and whether what is left of `right` is the wanted share; where an earlier factor did not do,
        the next one is made anew."""
        part, earlier = self._part, self._nearby is not None
        nearby = self._nearby or KeptColumns.of(M, part.A, part.H, np.searchsorted(part.unknowns, kept))

        def times(y: Singles) -> Singles:
            force, motion = np.split(y.ravel(), [len(part.unknowns)])
            return np.concatenate([force - M @ (part.H @ motion - part.A @ force), part.H.T @ force])

        size = 2 * (len(right),)
        T = LinearOperator(size, times, dtype=right.dtype)
        inverse = LinearOperator(size, lambda y: nearby.solve(y.ravel()), dtype=right.dtype)
        limits = {"restart": PATIENCE, "maxiter": 1} if earlier else {"restart": KRYLOV, "maxiter": RESTARTS}
        found, failed = gmres(T, right, M=inverse, atol=0.0, **{RELATIVE: share}, **limits)
        # SciPy ends a cycle by an estimate, so that a hair's breadth more may be left than was wanted
        served = not failed or float(np.linalg.norm(right - times(found))) <= NEARLY * share * np.linalg.norm(right)
        self._nearby = nearby if served else None
        return found, not failed
