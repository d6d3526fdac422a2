"""Linear solves T y = b of the Newton steps of one contact system, which reuse factors from step to step.

An approximate inverse of the tangent as a preconditioner leads GMRES to T⁻¹ b in two to five iterations. Where the
compliance is a matrix, a third of its columns gives that inverse (tangent.py), and single precision halves the memory
that is read; where it is known by products, `block_inverse` does. Only the active unknowns take part: outside the nodes
in contact T is the identity. Terms of T y nearly cancel, so that single precision gives about five digits; for more,
the residual is computed with all of A in double precision and solved for again. Where GMRES fails, all columns are
factored.

Tangents of one system are similar, also at other friction coefficients: an earlier factor costs a few more iterations
and is reused until these are too many.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.jump_compliance import ActiveCompliance, Inverse, JumpCompliance
from evolvent.contact.newton.krylov import gmres
from evolvent.contact.newton.reduced_tangent import FreeMotions, ReducedTangent
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tangent import Tangent, refined
from evolvent_meshes.arrays import Floats, Ints, Reals

SINGLE = 1e-4  # relative accuracy that single precision always reaches
ITERATIONS = 90  # with a new factor
REUSE_ITERATIONS = 8  # at most, with an earlier factor; a new factor costs as much
NEARLY = 2.0  # times the wanted residual: an earlier factor that came so close is still good
REFINEMENTS = 6  # after which all columns are factored instead
MOST_COLUMNS = 6000
"""Active unknowns up to which all columns of a compliance that is known by products are factored: each is a product,
and its matrix of 290 MB is held four or five times while it is factored."""


@dataclass(frozen=True)
class ActiveUnknowns:
    """The u of m unknowns that are not zero, with A and the free rigid motions restricted to them.

    unknowns: (u,) their indices.
    A: compliance among them.
    motions: H (u, r) and D (r, r).
    """

    unknowns: Ints
    A: ActiveCompliance
    motions: FreeMotions

    @staticmethod
    def of(unknowns: Ints, A: JumpCompliance, motions: FreeMotions) -> ActiveUnknowns:
        """Active unknowns with A (m, m) and H (m, r) restricted to them."""
        active = A.active(unknowns)
        return ActiveUnknowns(unknowns, active, motions.of(unknowns, active.dtype))

    def matrix(self, M: sp.csr_matrix) -> sp.csr_matrix:
        """M restricted to the active unknowns, (u, u); it has no other entries."""
        place = np.zeros(M.shape[1], dtype=M.indices.dtype)
        place[self.unknowns] = np.arange(len(self.unknowns))
        ends = np.append(0, np.cumsum(np.diff(M.indptr)[self.unknowns]))
        size = len(self.unknowns)
        return sp.csr_matrix((M.data.astype(self.A.dtype), place[M.indices], ends), (size, size))

    def restrict(self, y: Floats) -> Reals:
        """Values y (m + r,) restricted to the active unknowns, (u + r,)."""
        return np.concatenate([y[self.unknowns], y[len(y) - self.motions.count :]]).astype(self.A.dtype)

    def extend(self, y: Reals, size: int) -> Floats:
        """Values y (u + r,) extended by zeros to `size` = m + r."""
        whole = np.zeros(size)
        whole[self.unknowns], whole[size - self.motions.count :] = np.split(y, [len(self.unknowns)])
        return whole

    def times(self, M: sp.csr_matrix, y: Reals) -> Reals:
        """Product T y (u + r,) with the tangent."""
        force, motion = np.split(y, [len(self.unknowns)])
        jump = self.motions.jumps @ motion - self.A.times(force)
        return np.concatenate([force - M @ jump, self.motions.balance(force, motion)])


class NewtonSteps:
    """Solver for tangents that share the compliance A (m, m) [mm/N] and the free rigid motions."""

    def __init__(self, A: JumpCompliance, motions: FreeMotions) -> None:
        self.A, self.motions = A, motions
        self._active = ActiveUnknowns.of(np.zeros(0, dtype=int), A, motions)
        self._factored: Inverse | None = None
        self._between: Floats | None = None

    def solve(self, tangent: Tangent, right: Floats, accuracy: float) -> Floats:
        """T⁻¹ right, (m + r,), to `accuracy` of |right|; to rounding if A is a matrix and no column is left out. Raises
        NotConverged where T is singular, or GMRES fails with more than `MOST_COLUMNS` active unknowns."""
        if tangent.whole and self.A.matrix is not None:
            return tangent.solve(right)
        self._activate(tangent, right)
        if self._active.A.refactored:
            self._factored = None
        M, wanted = self._active.matrix(tangent.M), accuracy * float(np.linalg.norm(right))
        y, residual = np.zeros_like(right), right
        for _ in range(REFINEMENTS):
            size, is_new = float(np.linalg.norm(residual)), self._factored is None
            if size <= wanted:
                return y
            step, reached = self._by_gmres(M, tangent.kept, self._active.restrict(residual), wanted / size)
            y = y + self._active.extend(step, len(right))
            if reached and wanted >= self._finest * size:
                return y
            if is_new and not reached:
                break
            residual = right - tangent.times(y)
        return self._exact(tangent, right)

    @property
    def _finest(self) -> float:
        """Relative accuracy that the precision of the iterations always reaches."""
        return SINGLE if self._active.A.dtype == np.float32 else 0.0

    def _exact(self, tangent: Tangent, right: Floats) -> Floats:
        """T⁻¹ right by a factor of all columns; where A is known by products, of its matrix between the active
        unknowns, one product a column. Raises NotConverged where T is singular, or has too many active unknowns."""
        if self.A.matrix is not None:
            return tangent.solve(right)
        own, size = self._active.unknowns, len(right)
        rows = np.append(own, np.arange(len(self.motions.jumps), size))
        if len(own) > MOST_COLUMNS:
            raise NotConverged(
                f"Newton step: wanted convergence within {ITERATIONS} iterations of GMRES or at most {MOST_COLUMNS} "
                f"active unknowns, found neither: {len(own)} unknowns; a smaller step may help"
            )
        M, motions = tangent.M[own][:, own], self.motions.of(own, float)
        inverse = ReducedTangent.of(M, self._active_matrix(), motions, np.arange(len(own)))
        return refined(lambda b: self._active.extend(inverse.solve(b[rows]), size), tangent.times, right)

    def _active_matrix(self) -> Floats:
        """A (u, u) between the active unknowns [mm/N], column by column; kept until there are more of them."""
        own, force = self._active.unknowns, np.zeros(len(self.motions.jumps))
        if self._between is None:
            A = np.empty((len(own), len(own)))
            for j, unknown in enumerate(own):
                force[unknown] = 1.0
                A[:, j] = self.A.times(force)[own]
                force[unknown] = 0.0
            self._between = A
        return self._between

    def _activate(self, tangent: Tangent, right: Floats) -> None:
        """Adds the unknowns whose rows or columns in M or whose entries of `right` are not zero to the active ones."""
        before = np.zeros(len(self.motions.jumps), dtype=bool)
        before[self._active.unknowns] = True
        needed = right[: len(before)] != 0.0
        needed |= np.diff(tangent.M.indptr) > 0
        needed[tangent.M.indices] = True
        if (needed & ~before).any():
            self._active = ActiveUnknowns.of(np.flatnonzero(needed | before), self.A, self.motions)
            self._factored = self._between = None

    def _by_gmres(self, M: sp.csr_matrix, kept: Ints, right: Reals, relative: float) -> tuple[Reals, bool]:
        """Solution y (u + r,), and whether its residual is at most `relative` of `right`, or what their precision
        allows; an earlier factor that did not lead there is dropped."""
        active, relative = self._active, max(relative, self._finest)
        limit = ITERATIONS if self._factored is None else REUSE_ITERATIONS
        factored = self._factored or active.A.inverse(M, active.motions, np.searchsorted(active.unknowns, kept))

        def times(y: Reals) -> Reals:
            return active.times(M, y)

        y, reached = gmres(times, factored.solve, right, relative, limit)
        reusable = reached or float(np.linalg.norm(right - times(y))) <= NEARLY * relative * np.linalg.norm(right)
        self._factored = factored if reusable else None
        return y, reached
