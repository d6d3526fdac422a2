"""Dense Schur complement of a large sparse symmetric matrix by nested dissection, MUMPS on the leaves.

MUMPS alone orders a Schur complement by minimum degree (Debian builds it without METIS, and PETSc passes no ordering
on to its Cholesky), and holds three copies of the result. Here the matrix is divided first, and the separators are
eliminated by dense LAPACK, front by front. Run times: docs/benchmark.md.

Sources: nested dissection, George 1973, doi 10.1137/0710032; frontal matrices, Duff and Reid 1983,
doi 10.1145/356044.356047.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import LinAlgError, cholesky
from scipy.linalg.blas import dtrsm

from evolvent.fem.condensation import mumps
from evolvent.fem.condensation.elimination_order import SeparatorTree, dissect
from evolvent.fem.condensation.packed_triangle import PackedTriangle
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.parallel.memory import Stack, lazy_zeros, return_free_memory
from evolvent_meshes.arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class DissectionSettings:
    """Settings of an elimination by nested dissection.

    leaf: most rows of a part that MUMPS eliminates undivided.
    factor: settings of MUMPS.
    Raises ValueError unless leaf >= 1.
    """

    leaf: int = 4000
    factor: mumps.FactorSettings = mumps.DEFAULT_FACTOR

    def __post_init__(self) -> None:
        if self.leaf < 1:
            raise ValueError(
                f"dissection: wanted a leaf of at least one row, found {self.leaf}; the default is "
                f"{DissectionSettings.leaf}"
            )


DEFAULT_DISSECTION = DissectionSettings()


@dataclass(frozen=True)
class OrderedMatrix:
    """A symmetric matrix whose n rows to eliminate stand in elimination order, before m retained ones.

    rows: (n × n + m) the rows to eliminate; the retained columns last.
    corner: (m × m) the retained rows and columns.
    tree: separator tree of the rows to eliminate.
    factor: settings of MUMPS.
    """

    rows: sp.csr_matrix
    corner: sp.coo_matrix
    tree: SeparatorTree
    factor: mumps.FactorSettings

    @staticmethod
    def of(
        rows: sp.csr_matrix, corner: sp.coo_matrix, settings: DissectionSettings = DEFAULT_DISSECTION,
        graph: sp.spmatrix | None = None,
    ) -> OrderedMatrix:
        """The symmetric matrix A = [A₁₁ A₁₂; A₂₁ A₂₂] in elimination order.

        rows: [A₁₁ A₁₂] (n × n + m); A₁₁ must be positive definite.
        corner: A₂₂ (m × m), both triangles; it may be indefinite or empty.
        graph: (n × n) the pattern to divide, a subset of A₁₁'s (default: A₁₁'s). Separators of a mesh are thin, those
            of a matrix in which some rows couple widely are not.
        Raises RuntimeError where METIS is not installed or fails.
        """
        count = rows.shape[0]
        order, tree = dissect(rows[:, :count], graph, settings.leaf)
        corner.sum_duplicates()
        return OrderedMatrix(_reordered(rows, order), corner, tree, settings.factor)

    def schur_complement(self, threads: Threads = nullcontext, stack: Stack | None = None) -> Floats:
        """S = A₂₂ − A₂₁A₁₁⁻¹A₁₂ (m × m, C order).

        threads: makes the context in which separators are eliminated.
        stack: memory that many small eliminations use one after the other, without returning any to the system
            between them (default: one for this elimination, which has to itself all that is free).
        Raises NotPositiveDefinite and OutOfMemory.
        """
        size = self.rows.shape[1] - self.rows.shape[0]
        if stack is None:
            return_free_memory()
            result = lazy_zeros(size)  # half of it is not written to before the end
            self._subtract(result, threads, Stack())
            return_free_memory()
        else:
            result = np.zeros((size, size))
            self._subtract(result, threads, stack)
        result[self.corner.row, self.corner.col] += self.corner.data
        mumps.fill_symmetric(result)
        return result

    def _subtract(self, result: Floats, threads: Threads, stack: Stack) -> None:
        """Subtracts A₂₁A₁₁⁻¹A₁₂ from the upper triangle of the result (m × m)."""
        retained = np.arange(*self.rows.shape)
        _Elimination(self.rows, self.factor, stack, threads).subtract(self.tree, retained, PackedTriangle.view(result))


def _reordered(matrix: sp.csr_matrix, order: Ints) -> sp.csr_matrix:
    """Rows and first n columns of a matrix (n × n + m) in the given order (n,); indices are not sorted."""
    rank = np.arange(matrix.shape[1], dtype=matrix.indices.dtype)
    rank[order] = np.arange(len(order))
    taken = matrix[order]
    return sp.csr_matrix((taken.data, rank[taken.indices], taken.indptr), shape=taken.shape)


@dataclass(frozen=True)
class _Elimination:
    """The elimination of an ordered matrix.

    matrix: (n × n + m) the rows to eliminate, in elimination order.
    factor: settings of MUMPS, for the leaves.
    stack: memory of the fronts.
    threads: makes the context in which separators are eliminated.
    """

    matrix: sp.csr_matrix
    factor: mumps.FactorSettings
    stack: Stack
    threads: Threads

    def subtract(self, tree: SeparatorTree, outer: Ints, oo: PackedTriangle) -> None:
        """Subtracts from oo the product A_oi A_ii⁻¹ A_io, where i are the rows of the tree and o the rows `outer`."""
        with self.stack.released_at_exit():
            front = _Front.of(self.matrix, slice(tree.separator, tree.end), outer, oo, self.stack)
            for child in (tree,) if tree.is_leaf else tree.children:
                self._assemble(front, child)
            with self.threads():
                front.eliminate()

    def _assemble(self, front: _Front, child: SeparatorTree) -> None:
        """Eliminate a child, and add its update to the front."""
        places = np.flatnonzero(self._coupled_columns(child)[front.variables])
        outer = front.variables[places]
        if child.is_leaf:
            front.add(PackedTriangle.view(self._leaf_update(child, outer)), places)
        else:
            with self.stack.released_at_exit():
                update = PackedTriangle.zeros(len(outer), self.stack.empty)
                self.subtract(child, outer, update)
                front.add(update, places)

    def _coupled_columns(self, tree: SeparatorTree) -> Bools:
        """Columns (n + m,) in which the rows of a tree have an entry."""
        coupled = np.zeros(self.matrix.shape[1], dtype=bool)
        ends = self.matrix.indptr[tree.begin], self.matrix.indptr[tree.end]
        coupled[self.matrix.indices[slice(*ends)]] = True
        return coupled

    def _leaf_update(self, leaf: SeparatorTree, outer: Ints) -> Floats:
        """Update −A_oi A_ii⁻¹ A_io (upper triangle), where i are the rows of the leaf and o the rows `outer`."""
        if not len(outer):
            return np.zeros((0, 0))
        rows, count, size = self.matrix[leaf.begin : leaf.end], leaf.end - leaf.begin, len(outer)
        place = np.full(rows.shape[1], -1, dtype=rows.indices.dtype)
        place[leaf.begin : leaf.end] = np.arange(count)
        place[outer] = count + np.arange(size)
        own = sp.csr_matrix((rows.data, place[rows.indices], rows.indptr), shape=(count, count + size))
        upper = mumps.upper_triangle(own)
        # the stored zeros on the diagonal give every retained row an entry that PETSc can see
        data = np.concatenate([upper.data, np.zeros(size)])
        columns = np.concatenate([upper.indices, count + np.arange(size)])
        ends = np.concatenate([upper.indptr, upper.indptr[-1] + 1 + np.arange(size)])
        return mumps.schur_complement(sp.csr_matrix((data, columns, ends), (count + size,) * 2), size, self.factor)


@dataclass
class _Front:
    """Frontal matrix of a separator: dense blocks of its s rows and of the o rows outside that they couple with.

    variables: (s + o,) row numbers, those of the separator first.
    ss: (s × s) upper triangle.
    so: (s × o).
    oo: (o × o).
    """

    variables: Ints
    ss: Floats
    so: Floats
    oo: PackedTriangle

    @staticmethod
    def of(matrix: sp.csr_matrix, separator: slice, outer: Ints, oo: PackedTriangle, stack: Stack) -> _Front:
        rows, size = matrix[separator], separator.stop - separator.start
        ss = rows[:, separator].toarray(out=stack.empty(size, size))
        so = rows[:, outer].toarray(out=stack.empty(size, len(outer)))
        return _Front(np.concatenate([np.arange(separator.start, separator.stop), outer]), ss, so, oo)

    def add(self, update: PackedTriangle, places: Ints) -> None:
        """Add the update of an eliminated child at the places (sorted) of the variables that it couples with."""
        count = len(self.ss)
        inside, outside = np.split(places, [int(np.searchsorted(places, count))])
        update.add_leading(self.ss, self.so, inside, outside - count)
        update.add_trailing(self.oo, outside - count)

    def eliminate(self) -> None:
        """Eliminates a front: oo −= soᵀ ss⁻¹ so; overwrites ss and so. Raises NotPositiveDefinite.

        LAPACK works on the transposed arrays, which are in Fortran order, so that nothing is copied.
        """
        if not len(self.ss):
            return
        try:
            factor = cholesky(self.ss.T, lower=True, overwrite_a=True)
        except LinAlgError:
            raise mumps.not_positive_definite(len(self.ss), 1) from None
        if self.oo.size:
            self.oo.subtract_product(dtrsm(1.0, factor, self.so.T, side=1, lower=1, trans_a=1, overwrite_b=1).T)
