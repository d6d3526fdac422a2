"""Dense Schur complement of a large sparse symmetric matrix by nested dissection, MUMPS on the leaves.

MUMPS alone orders a Schur complement by minimum degree (Debian builds it without METIS, and PETSc passes no ordering
on to its Cholesky), and holds three copies of the result. Here the domain is cut to pieces first, and the separators
are eliminated by dense LAPACK. The 17-tooth sector of demos/yang2022.toml at quick, 118,080 rows with 9,225
retained ones, takes 37 s (one thread): half of that in LAPACK, a fifth in MUMPS, a seventh in adding updates up.

Source: George 1973, doi 10.1137/0710032 (nested dissection); the separators are METIS' (`separator`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cholesky, solve_triangular
from scipy.linalg.blas import dsyrk
from scipy.sparse.csgraph import reverse_cuthill_mckee

from solver import mumps
from solver.memory import return_free_memory
from solver.separator import Part, planned

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


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


def schur_complement(
    matrix: sp.spmatrix, size: int, settings: DissectionSettings = STANDARD, graph: sp.spmatrix | None = None
) -> Floats:
    """S = A₂₂ − A₂₁A₁₁⁻¹A₁₂ (size × size, C order) of the last `size` rows of a symmetric A (both triangles given).

    A₁₁ must be positive definite, A₂₂ need not be. `graph` has the pattern that the cuts follow, of the shape of A₁₁
    and connecting no more than it does (default: A₁₁): cuts of a mesh are thin, those of a matrix in which some rows
    couple widely are not.

    Raises NotPositiveDefinite and OutOfMemory.
    """
    csr = matrix.tocsr()
    count = csr.shape[0] - size
    order, whole = planned(csr[:count, :count], graph, settings.leaf)
    rows = _reordered(csr[:count], order)
    result = _Elimination(rows, settings.factor).update(whole, np.arange(count, csr.shape[0]))
    del rows
    corner = csr[count:, count:].tocoo()
    corner.sum_duplicates()
    result[corner.row, corner.col] += corner.data
    return_free_memory()
    mumps.fill_symmetric(result)
    return result


def _reordered(rows: sp.csr_matrix, order: Ints) -> sp.csr_matrix:
    """Rows (n × n + m) in a new order (n,), and their first n columns alike; indices are not sorted."""
    rank = np.arange(rows.shape[1], dtype=rows.indices.dtype)
    rank[order] = np.arange(len(order))
    taken = rows[order]
    return sp.csr_matrix((taken.data, rank[taken.indices], taken.indptr), shape=rows.shape)


@dataclass(frozen=True)
class _Elimination:
    """The rows to eliminate in the order of the plan (n × n + m), and how leaves are factored."""

    matrix: sp.csr_matrix
    factor: mumps.FactorSettings

    def update(self, part: Part, outer: Ints) -> Floats:
        """−A_oi A_ii⁻¹ A_io, upper triangle (|outer| × |outer|, C order), of a part's rows i and `outer` rows of A."""
        if not part.parts and part.separator == part.end:
            return self._leaf(part, outer)
        front = _Front.of(self.matrix, np.arange(part.separator, part.end), outer)
        for inner in part.parts:
            return_free_memory()
            places = np.flatnonzero(self._touched(inner)[front.variables])
            front.add(self.update(inner, front.variables[places]), places)
        return_free_memory()
        return front.eliminated()

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
    """A separator and what is retained around it: dense blocks ss, so and oo (upper triangles of ss and oo)."""

    variables: Ints
    ss: Floats
    so: Floats
    oo: Floats

    @staticmethod
    def of(matrix: sp.csr_matrix, separator: Ints, outer: Ints) -> _Front:
        rows = matrix[separator]
        blocks = rows[:, separator].toarray(), rows[:, outer].toarray(), np.zeros((len(outer), len(outer)))
        return _Front(np.concatenate([separator, outer]), *blocks)

    def add(self, update: Floats, places: Ints) -> None:
        """Add the update of an eliminated part at the places (sorted) of the variables that it touches."""
        count = len(self.ss)
        split = int(np.searchsorted(places, count))
        inside, outside = _runs(places[:split]), _runs(places[split:] - count)
        _add(self.ss, inside, inside, update[:split, :split])
        _add(self.so, inside, outside, update[:split, split:])
        _add(self.oo, outside, outside, update[split:, split:], upper=True)

    def eliminated(self) -> Floats:
        """oo − soᵀ ss⁻¹ so, in the memory of oo."""
        if not len(self.ss):
            return self.oo
        try:
            factor = cholesky(self.ss, lower=False, overwrite_a=True)
        except LinAlgError:
            raise mumps.not_positive_definite(len(self.ss), 1) from None
        # columns of soᵀ as LAPACK wants them: no copy of the largest blocks
        if len(self.oo):
            half = solve_triangular(factor, self.so, trans="T", overwrite_b=True)
            dsyrk(-1.0, half, beta=1.0, c=self.oo.T, trans=1, lower=1, overwrite_c=1)
        return self.oo


def _runs(places: Ints) -> list[tuple[slice, slice]]:
    """Sorted places as runs without gaps: where each goes, and where it comes from."""
    starts = np.flatnonzero(np.diff(places, prepend=-2) != 1)
    ends = np.append(starts[1:], len(places))
    return [(slice(places[a], places[a] + b - a), slice(a, b)) for a, b in zip(starts.tolist(), ends.tolist())]


def _add(
    target: Floats, rows: list[tuple[slice, slice]], columns: list[tuple[slice, slice]], update: Floats,
    upper: bool = False,
) -> None:  # fmt: skip
    """target[rows, columns] += update, by whole blocks: nodes that are numbered along the mesh come in long runs.
    upper: nothing left of the diagonal blocks."""
    for i, (to, origin) in enumerate(rows):
        strip, added = target[to], update[origin]
        for column, source in columns[i if upper else 0 :]:
            strip[:, column] += added[:, source]
