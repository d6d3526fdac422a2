"""Dense Schur complement of a large sparse symmetric matrix by nested dissection, MUMPS on the leaves.

MUMPS alone orders a Schur complement by minimum degree (Debian builds it without METIS, and PETSc passes no ordering
on to its Cholesky), and holds three copies of the result. Here the domain is first cut by hand a few times and the
separators are eliminated by dense LAPACK. For a box of 121,000 rows with 5,043 retained ones MUMPS alone needs 50 s
(CPU time, one thread) and brings the process to 3.1 GB, this 22 s and 1.6 GB, 1.3 GB being there from assembling.

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
from solver.separator import FIRST, SECOND, SEPARATOR, vertex_separator

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class DissectionSettings:
    """Parts of at most `leaf` rows go to MUMPS. Raises ValueError unless leaf >= 1."""

    leaf: int = 6000
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
    separator, parts = bisect(within, graph)
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


def bisect(pattern: sp.csr_matrix, graph: sp.csr_matrix) -> tuple[Ints, list[Ints]]:
    """Separator and the two parts (sorted row numbers) that it leaves of a symmetric `pattern` (n × n).

    The cut is one of `graph` (n × n), which connects no more than `pattern` does; what `pattern` still couples of the
    two parts is taken into the separator, from one part only. Raises RuntimeError, see `separator`.
    """
    side = vertex_separator(graph)
    if graph is not pattern:
        touching = min((_touching(pattern, side, here) for here in (FIRST, SECOND)), key=len)
        side[touching] = SEPARATOR
    return np.flatnonzero(side == SEPARATOR), [np.flatnonzero(side == FIRST), np.flatnonzero(side == SECOND)]


def _touching(pattern: sp.csr_matrix, side: Ints, here: int) -> Ints:
    """The rows of one part that `pattern` couples with the other."""
    own = np.flatnonzero(side == here)
    there = (side == FIRST + SECOND - here).astype(np.float32)
    return own[np.asarray(abs(pattern[own]) @ there) > 0.0]
