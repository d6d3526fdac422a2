"""Dense Schur complement of a large sparse symmetric matrix by nested dissection, MUMPS on the leaves.

MUMPS alone orders a Schur complement by minimum degree (Debian builds it without METIS, and PETSc passes no ordering
on to its Cholesky), and holds three copies of the result. Here the domain is cut to pieces first, and the separators
are eliminated by dense LAPACK. How long each part takes is measured in docs/benchmark.md.

Source: George 1973, doi 10.1137/0710032 (nested dissection); the separators are METIS' (`separator`).
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import LinAlgError, cholesky
from scipy.linalg.blas import dtrsm
from scipy.sparse.csgraph import reverse_cuthill_mckee

from evolvent.fem.condensation import mumps
from evolvent.fem.condensation.elimination_order import Part, planned
from evolvent.fem.condensation.packed_triangle import Triangle
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.parallel.memory import Stack, return_free_memory, untouched_square
from evolvent_meshes.arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class DissectionSettings:
    """Parts of at most `leaf` rows go to MUMPS. Raises ValueError unless leaf >= 1."""

    leaf: int = 4000
    factor: mumps.FactorSettings = mumps.STANDARD

    def __post_init__(self) -> None:
        if self.leaf < 1:
            raise ValueError(
                f"dissection: wanted a leaf of at least one row, found {self.leaf}; the default is "
                f"{DissectionSettings.leaf}"
            )


STANDARD = DissectionSettings()


@dataclass(frozen=True)
class Planned:
    """A symmetric matrix in the order of its elimination.

    rows: (n × n + m) those to eliminate, the m retained columns last. corner: (m × m) of the retained rows. whole: the
    plan.
    """

    rows: sp.csr_matrix
    corner: sp.coo_matrix
    whole: Part
    factor: mumps.FactorSettings

    @staticmethod
    def of(
        rows: sp.csr_matrix, corner: sp.coo_matrix, settings: DissectionSettings = STANDARD,
        graph: sp.spmatrix | None = None,
    ) -> Planned:  # fmt: skip
        """Of a symmetric A, [A₁₁ A₁₂] (n × n + m) the rows to eliminate and A₂₂ (m × m) the corner, both triangles.

        A₁₁ must be positive definite, A₂₂ need not be. `graph` has the pattern that the cuts follow, of the shape of
        A₁₁ and connecting no more than it does (default: A₁₁): cuts of a mesh are thin, those of a matrix in which some
        rows couple widely are not.
        """
        count = rows.shape[0]
        order, whole = planned(rows[:, :count], graph, settings.leaf)
        corner.sum_duplicates()
        return Planned(_reordered(rows, order), corner, whole, settings.factor)

    def schur_complement(self, threads: Threads = nullcontext) -> Floats:
        """S = A₂₂ − A₂₁A₁₁⁻¹A₁₂ (m × m, C order). threads: in which separators are eliminated. Raises
        NotPositiveDefinite and OutOfMemory."""
        return_free_memory()
        (count, columns), corner = self.rows.shape, self.corner
        result = untouched_square(columns - count)  # half of it stays so until the end
        retained = np.arange(count, columns)
        elimination = _Elimination(self.rows, self.factor, Stack(), threads)
        elimination.subtract(self.whole, retained, Triangle.within(result))
        del elimination  # with its stack
        return_free_memory()
        result[corner.row, corner.col] += corner.data
        mumps.fill_symmetric(result)
        return result


def _reordered(matrix: sp.csr_matrix, order: Ints) -> sp.csr_matrix:
    """Rows (n × n + m) in the order (n,), and their first n columns alike; indices are not sorted."""
    rank = np.arange(matrix.shape[1], dtype=matrix.indices.dtype)
    rank[order] = np.arange(len(order))
    taken = matrix[order]
    return sp.csr_matrix((taken.data, rank[taken.indices], taken.indptr), shape=taken.shape)


@dataclass(frozen=True)
class _Elimination:
    """The rows to eliminate in the order of the plan (n × n + m), how leaves are factored, where the fronts are, and
    in what they are eliminated."""

    matrix: sp.csr_matrix
    factor: mumps.FactorSettings
    stack: Stack
    threads: Threads

    def subtract(self, part: Part, outer: Ints, oo: Triangle) -> None:
        """oo −= A_oi A_ii⁻¹ A_io of a part's rows i and `outer` rows of A."""
        with self.stack.given_up_after():
            front = _Front.of(self.matrix, slice(part.separator, part.end), outer, oo, self.stack)
            for inner in (part,) if part.is_leaf else part.parts:
                self._absorb(front, inner)
            with self.threads():
                front.eliminate()

    def _absorb(self, front: _Front, inner: Part) -> None:
        """Eliminates a part within a front."""
        places = np.flatnonzero(self._touched(inner)[front.variables])
        outer = front.variables[places]
        if inner.is_leaf:
            front.add(Triangle.within(self._leaf(inner, outer)), places)
        else:
            with self.stack.given_up_after():
                update = Triangle.zeros(len(outer), self.stack.empty)
                self.subtract(inner, outer, update)
                front.add(update, places)

    def _touched(self, part: Part) -> Bools:
        """(n + m,) bool: the columns in which a part's rows have an entry."""
        touched = np.zeros(self.matrix.shape[1], dtype=bool)
        ends = self.matrix.indptr[part.begin], self.matrix.indptr[part.end]
        touched[self.matrix.indices[slice(*ends)]] = True
        return touched

    def _leaf(self, part: Part, outer: Ints) -> Floats:
        if not len(outer):
            return np.zeros((0, 0))
        rows = self.matrix[part.begin : part.end]
        within, across = rows[:, part.begin : part.end], rows[:, outer]
        # MUMPS' minimum degree breaks ties in the order it is given: a third fewer operations
        order = reverse_cuthill_mckee(within, symmetric_mode=True)
        within, across = within[order][:, order], across[order]
        # the stored zeros on the diagonal give every retained row an entry that PETSc can see
        size = len(outer)
        zeros = sp.csr_matrix((np.zeros(size), (np.arange(size), np.arange(size))), shape=(size, size))
        upper = sp.bmat([[sp.triu(within), across], [None, zeros]], format="csr")
        return mumps.schur_complement(upper, size, self.factor)


@dataclass
class _Front:
    """A separator and what is retained around it: dense blocks ss (upper triangle), so and oo."""

    variables: Ints
    ss: Floats
    so: Floats
    oo: Triangle

    @staticmethod
    def of(matrix: sp.csr_matrix, separator: slice, outer: Ints, oo: Triangle, stack: Stack) -> _Front:
        rows, size = matrix[separator], separator.stop - separator.start
        ss = rows[:, separator].toarray(out=stack.empty(size, size))
        so = rows[:, outer].toarray(out=stack.empty(size, len(outer)))
        return _Front(np.concatenate([np.arange(separator.start, separator.stop), outer]), ss, so, oo)

    def add(self, update: Triangle, places: Ints) -> None:
        """Add the update of an eliminated part at the places (sorted) of the variables that it touches."""
        count = len(self.ss)
        inside, outside = np.split(places, [int(np.searchsorted(places, count))])
        update.add_first(self.ss, self.so, inside, outside - count)
        update.add_last(self.oo, outside - count)

    def eliminate(self) -> None:
        """oo −= soᵀ ss⁻¹ so, with ss and so used up: what is C order here is Fortran's, transposed, so nothing is
        copied."""
        if not len(self.ss):
            return
        try:
            factor = cholesky(self.ss.T, lower=True, overwrite_a=True)
        except LinAlgError:
            raise mumps.not_positive_definite(len(self.ss), 1) from None
        if self.oo.size:
            self.oo.subtract_product(dtrsm(1.0, factor, self.so.T, side=1, lower=1, trans_a=1, overwrite_b=1).T)
