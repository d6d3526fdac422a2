"""Dense Schur complement of a large sparse symmetric matrix by nested dissection, MUMPS on the leaves.

MUMPS alone orders a Schur complement by minimum degree (Debian builds it without METIS, and PETSc passes no ordering
on to its Cholesky), and holds three copies of the result. Here the domain is first cut by hand a few times and the
separators are eliminated by dense LAPACK. For a box of 121,000 rows with 5,043 retained ones MUMPS alone needs 50 s
(CPU time, one thread) and brings the process to 3.1 GB, this 22 s and 1.6 GB, 1.3 GB being there from assembling.

Source: George 1973, doi 10.1137/0710032 (nested dissection); separators are level sets of a breadth-first search
that starts from a whole end of the domain (George and Liu 1978, doi 10.1137/0715069, there from one vertex).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cholesky, solve_triangular
from scipy.linalg.blas import dsyrk
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee

from solver import mumps
from solver.memory import return_free_memory

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class DissectionSettings:
    """Parts of at most `leaf` rows go to MUMPS; a cut leaves at least the fraction `balance` below and above it,
    where some level set does.

    Raises ValueError unless leaf >= 1 and 0 < balance <= 0.5.
    """

    leaf: int = 12000
    balance: float = 0.3
    factor: mumps.FactorSettings = mumps.STANDARD

    def __post_init__(self) -> None:
        if self.leaf < 1 or not 0 < self.balance <= 0.5:
            raise ValueError(
                f"dissection: wanted a leaf of at least one row and a balance above 0 and up to 0.5, found {self.leaf} "
                f"and {self.balance}; the defaults are {DissectionSettings.leaf} and {DissectionSettings.balance}"
            )


STANDARD = DissectionSettings()


def schur_complement(
    matrix: sp.spmatrix, size: int, settings: DissectionSettings = STANDARD, graph: sp.spmatrix | None = None
) -> Floats:
    """S = A₂₂ − A₂₁A₁₁⁻¹A₁₂ (size × size, C order) of the last `size` rows of a symmetric A (both triangles given).

    A₁₁ must be positive definite, A₂₂ need not be. `graph` has the pattern that the cuts follow, of the shape of A₁₁
    and connecting no more than it does (default: A₁₁): level sets of a mesh run straight, those of a matrix in which
    some rows couple widely run ahead along these rows and leave separators twice as large.

    Raises NotPositiveDefinite and OutOfMemory.
    """
    csr = matrix.tocsr()
    first = csr.shape[0] - size
    inner, outer = np.arange(first), np.arange(first, csr.shape[0])
    elimination = _Elimination(csr, None if graph is None else graph.tocsr(), settings)
    result = _update(elimination, inner, outer)
    corner = csr[first:, first:].tocoo()
    corner.sum_duplicates()
    result[corner.row, corner.col] += corner.data
    return_free_memory()
    mumps.fill_symmetric(result)
    return result


@dataclass(frozen=True)
class _Elimination:
    """What every part of the recursion reads: the matrix, the graph of its rows to eliminate (None: the matrix's own),
    the settings."""

    matrix: sp.csr_matrix
    graph: sp.csr_matrix | None
    settings: DissectionSettings


def _update(elimination: _Elimination, inner: Ints, outer: Ints) -> Floats:
    """−A_oi A_ii⁻¹ A_io, upper triangle (|outer| × |outer|, C order), of `inner` and `outer` rows of A."""
    rows = elimination.matrix[inner]
    within = rows[:, inner]
    if len(inner) <= elimination.settings.leaf:
        return _leaf(within, rows[:, outer], elimination.settings)
    graph = within if elimination.graph is None else elimination.graph[inner][:, inner]
    separator, parts = bisect(within, graph, elimination.settings)
    del rows, within, graph
    front = _Front.of(elimination.matrix, inner[separator], outer)
    for part in filter(len, parts):
        return_free_memory()
        front.add(elimination, inner[part])
    return_free_memory()
    return front.eliminated()


def _leaf(within: sp.csr_matrix, across: sp.csr_matrix, settings: DissectionSettings) -> Floats:
    size = across.shape[1]
    if not size:
        return np.zeros((0, 0))
    # MUMPS' minimum degree breaks ties in the order it is given: a third fewer operations
    order = reverse_cuthill_mckee(within, symmetric_mode=True)
    within, across = within[order][:, order], across[order]
    # the stored zeros on the diagonal give every retained row an entry that PETSc can see
    zeros = sp.csr_matrix((np.zeros(size), (np.arange(size), np.arange(size))), shape=(size, size))
    upper = sp.bmat([[sp.triu(within), across], [None, zeros]], format="csr")
    return mumps.schur_complement(upper, size, settings.factor)


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

    def add(self, elimination: _Elimination, part: Ints, chunk: int = 512) -> None:
        """Eliminate the rows `part` and add their update at the places of the variables that they touch."""
        touched = np.zeros(elimination.matrix.shape[0], dtype=bool)
        touched[elimination.matrix[part].indices] = True
        places = np.flatnonzero(touched[self.variables])
        update = _update(elimination, part, self.variables[places])
        count = len(self.ss)
        split = np.searchsorted(places, count)
        inside, outside = places[:split], places[split:] - count
        self.ss[np.ix_(inside, inside)] += update[:split, :split]
        self.so[np.ix_(inside, outside)] += update[:split, split:]
        for start in range(0, len(outside), chunk):
            rows = outside[start : start + chunk]
            # upper triangle only; the places are sorted, so upper stays upper
            self.oo[np.ix_(rows, outside[start:])] += update[split + start : split + start + chunk, split + start :]

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


def bisect(
    pattern: sp.csr_matrix, graph: sp.csr_matrix, settings: DissectionSettings = STANDARD
) -> tuple[Ints, list[Ints]]:
    """Separator and the two parts (sorted row numbers) that it leaves of a symmetric `pattern` (n × n), n > 1.

    The cut follows the level sets of `graph` (n × n), which connects no more than `pattern` does. The separator is
    empty where a cut falls between two pieces of the graph that `pattern` does not connect either.
    """
    levels = _levels_piece_by_piece(graph)
    # below the cut, only what touches the other side has to be in the separator
    reach = np.maximum.reduceat(levels[pattern.indices], pattern.indptr[:-1])
    count = levels.max() + 1
    crossing = np.cumsum(np.bincount(levels, minlength=count) - np.bincount(np.maximum(reach, levels), minlength=count))
    below = np.cumsum(np.bincount(levels)) / len(levels)
    allowed = np.flatnonzero((below >= settings.balance) & (below <= 1 - settings.balance))
    if not len(allowed):
        allowed = np.array([np.argmin(np.abs(below[:-1] - 0.5))])
    off_centre = np.abs(below[allowed] - 0.5)
    level = allowed[np.lexsort((off_centre, crossing[allowed] * (1 + off_centre)))[0]]
    separator = (levels <= level) & (reach > level)
    return np.flatnonzero(separator), [
        np.flatnonzero((levels <= level) & ~separator),
        np.flatnonzero(levels > level),
    ]


def _levels_piece_by_piece(graph: sp.csr_matrix) -> Ints:
    """Level sets (n,) of every connected piece of a symmetric `graph`, from one of its ends to the other.

    The levels of the pieces follow one another, those of the largest piece first: so some cut between two pieces is
    balanced (to a third at the most), unless the largest one alone is too large for that.
    """
    # strongly: the same in a symmetric graph, and takes no copy of it
    count, piece = connected_components(graph, connection="strong")
    ends = _levels(graph, np.unique(piece, return_index=True)[1])
    levels = _levels(graph, np.flatnonzero(ends == _largest(ends, piece, count)[piece]))
    order = np.argsort(-np.bincount(piece), kind="stable")
    depth = 1 + _largest(levels, piece, count)[order]
    start = np.empty(count, dtype=np.int64)
    start[order] = np.cumsum(depth) - depth
    return levels + start[piece]


def _largest(values: Ints, piece: Ints, count: int) -> Ints:
    """Largest value (count,) of each piece."""
    largest = np.full(count, -1)
    np.maximum.at(largest, piece, values)
    return largest


def _levels(pattern: sp.csr_matrix, start: Ints) -> Ints:
    """Distance in edges of every row from the rows `start`; −1 where there is no path."""
    levels = np.full(pattern.shape[0], -1)
    levels[start] = 0
    front, distance = start, 0
    while len(front):
        distance += 1
        fresh = np.zeros(len(levels), dtype=bool)
        fresh[pattern[front].indices] = True
        front = np.flatnonzero(fresh & (levels < 0))
        levels[front] = distance
    return levels
