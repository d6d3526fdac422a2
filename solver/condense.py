"""Condensation of a body's stiffness: what its surface and its cut faces feel of the bulk, computed once and exactly.

With K (n × n) symmetric positive definite on the free degrees of freedom and functionals P (m × n), for instance the
displacements of surface nodes, the compliance

    C = P K⁻¹ Pᵀ = −( Schur complement of [K Pᵀ; P 0] onto its second block )

comes from one partial factorisation instead of m solves. This is elimination, not approximation. A load vector L is
served by one more row Lᵀ of P: its column of C is then the response P K⁻¹ L.

θ ≠ 1 in Nitsche's form makes the functionals of test and trial functions differ, not K: `compliance_by_columns`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from solver.dissection import STANDARD, DissectionSettings, schur_complement
from solver.mumps import NotPositiveDefinite, OutOfMemory, SparseCholesky

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

__all__ = [
    "Factor",
    "NotPositiveDefinite",
    "OutOfMemory",
    "SectorCondensation",
    "SectorRecovery",
    "SectorSystem",
    "compliance",
    "compliance_by_columns",
]


def compliance(
    stiffness: sp.spmatrix, functionals: sp.spmatrix, free: Ints | None = None,
    settings: DissectionSettings = STANDARD, graph: sp.spmatrix | None = None,
) -> Floats:  # fmt: skip
    """C = P K⁻¹ Pᵀ (m × m, symmetric, one array; mm/N for displacements).

    `stiffness` K (n × n), `functionals` P (m × n); `free` picks the degrees of freedom that are not fixed (default:
    all). `graph` (n × n) has the pattern that cuts follow, see `dissection.schur_complement`. Peak memory above K and
    P is about twice C.

    Raises NotPositiveDefinite and OutOfMemory.
    """
    if free is not None:
        stiffness, functionals = _restricted(stiffness, free), functionals.tocsc()[:, free]
        graph = None if graph is None else _restricted(graph, free)
    result = schur_complement(_augmented(stiffness, functionals), functionals.shape[0], settings, graph)
    return np.negative(result, out=result)


class Factor:
    """Cholesky factor of K on its free degrees of freedom; `solve` is for load responses and displacement fields.

    Raises NotPositiveDefinite and OutOfMemory.
    """

    def __init__(
        self, stiffness: sp.spmatrix, free: Ints | None = None, settings: DissectionSettings = STANDARD
    ) -> None:
        self._free: Ints | slice = slice(None) if free is None else free
        kept = stiffness if free is None else _restricted(stiffness, free)
        self._cholesky = SparseCholesky(sp.triu(kept, format="csr"), settings.factor)

    def solve(self, right: Floats) -> Floats:
        """X with K X = `right` on the free rows and 0 on the fixed ones; both (n,) or (n × c)."""
        columns = right.reshape(len(right), -1)
        solution = np.zeros(columns.shape, order="F")
        solution[self._free] = self._cholesky.solve(columns[self._free])
        return solution.reshape(right.shape)


def compliance_by_columns(
    factor: Factor, left: sp.spmatrix, right: sp.spmatrix | None = None, block: int = 512
) -> Floats:
    """P_left K⁻¹ P_rightᵀ (m_l × m_r) by solves in blocks of columns; `right` defaults to `left`.

    The slow way (about 12 ms a column at 80,000 rows), for unsymmetric pairs of functionals and as a check.
    """
    test = left.tocsr()
    trial = test if right is None else right.tocsr()
    result = np.empty((test.shape[0], trial.shape[0]))
    for start in range(0, trial.shape[0], block):
        columns = slice(start, start + block)
        result[:, columns] = test @ factor.solve(trial[columns].T.toarray())
    return result


@dataclass(frozen=True)
class SectorCondensation:
    """A sector seen through its two cut faces and its functionals, in its own frame.

    y = C f + T u_c and S u_c = Tᵀ f + g: functionals y (m), forces f (m), displacements u_c and forces g of the cut
    faces (2c: the low face, then the high one).

    `stiffness` S (2c × 2c, N/mm), `transfer` T (m × 2c), `compliance` C with both cut faces clamped (m × m, mm/N).
    """

    stiffness: Floats
    transfer: Floats
    compliance: Floats


@dataclass(frozen=True)
class SectorSystem:
    """[K Pᵀ; P 0] of a sector, ready for elimination: interior rows first, then the cut faces, then the functionals.

    matrix: (n + m)², graph: pattern (interior rows)² that the cuts of the dissection follow, or None for the matrix's
    own; cut: 2c; surface: m.
    """

    matrix: sp.csr_matrix
    graph: sp.csr_matrix | None
    cut: int
    surface: int

    @staticmethod
    def of(
        stiffness: sp.spmatrix, functionals: sp.spmatrix, low: Ints, high: Ints, graph: sp.spmatrix | None = None
    ) -> SectorSystem:
        """From K (n × n, fixed rows already gone), P (m × n), the dofs `low`, `high` (c each) of the cut faces and a
        pattern (n × n). Raises ValueError where the faces do not match."""
        interior, cut = _split(stiffness.shape[0], low, high)
        order = np.concatenate([interior, cut])
        matrix = _augmented(_restricted(stiffness, order), functionals.tocsc()[:, order])
        inner = None if graph is None else _restricted(graph, interior)
        return SectorSystem(matrix, inner, len(cut), functionals.shape[0])

    def condensed(self, settings: DissectionSettings = STANDARD) -> SectorCondensation:
        """Onto the cut faces and the functionals. Raises NotPositiveDefinite and OutOfMemory."""
        schur = schur_complement(self.matrix, self.cut + self.surface, settings, self.graph)
        faces, surface = slice(0, self.cut), slice(self.cut, None)
        stiffness, transfer = schur[faces, faces].copy(), schur[surface, faces].copy()
        compliance = _corner(schur, self.cut)
        return SectorCondensation(stiffness, transfer, np.negative(compliance, out=compliance))


def _corner(matrix: Floats, first: int) -> Floats:
    """matrix[first:, first:], moved to the front of the same memory: it is the largest array of a run, and a copy would
    be there twice. `matrix` is in C order, and used up."""
    size = len(matrix) - first
    flat = matrix.reshape(-1)
    for row in range(size):
        flat[row * size : (row + 1) * size] = matrix[first + row, first:]
    if matrix.flags.owndata:
        del flat
        matrix.resize((size, size), refcheck=False)
        return matrix
    return flat[: size * size].reshape(size, size)


class SectorRecovery:
    """Displacement field of a whole sector from what acts on its surface and the displacements of its cut faces."""

    def __init__(
        self, stiffness: sp.spmatrix, functionals: sp.spmatrix, low: Ints, high: Ints,
        settings: DissectionSettings = STANDARD,
    ) -> None:  # fmt: skip
        self._interior, self._cut = _split(stiffness.shape[0], low, high)
        self._loads = functionals.tocsc()[:, self._interior].T.tocsr()
        self._coupling = stiffness.tocsr()[self._interior][:, self._cut]
        self._factor = Factor(_restricted(stiffness, self._interior), settings=settings)

    def displacement(self, forces: Floats, cut: Floats) -> Floats:
        """Field u (n) of the sector in its own frame: forces f (m), cut-face displacements u_c (2c)."""
        field = np.empty(len(self._interior) + len(self._cut))
        field[self._cut] = cut
        field[self._interior] = self._factor.solve(self._loads @ forces - self._coupling @ cut)
        return field


def _split(size: int, low: Ints, high: Ints) -> tuple[Ints, Ints]:
    cut = np.concatenate([low, high])
    if len(low) != len(high) or len(np.unique(cut)) != len(cut):
        raise ValueError(
            f"two cut faces with equally many degrees of freedom and none in common are wanted, found {len(low)} and "
            f"{len(high)}, {len(np.unique(cut))} different: give both faces in matching order, without fixed ones"
        )
    interior = np.ones(size, dtype=bool)
    interior[cut] = False
    return np.flatnonzero(interior), cut


def _restricted(stiffness: sp.spmatrix, kept: Ints) -> sp.csr_matrix:
    return stiffness.tocsr()[kept][:, kept]


def _augmented(stiffness: sp.spmatrix, functionals: sp.spmatrix) -> sp.csr_matrix:
    """[K Pᵀ; P 0] row by row, without the coordinate lists that `bmat` makes of K on the way."""
    size, count = stiffness.shape[0], functionals.shape[0]
    P = functionals.tocsr()
    lower = sp.csr_matrix((P.data, P.indices, P.indptr), shape=(count, size + count))
    return sp.vstack([_beside(stiffness.tocsr(), P.T.tocsr()), lower], format="csr")


def _beside(left: sp.csr_matrix, right: sp.csr_matrix) -> sp.csr_matrix:
    """[left right]."""
    counts = [np.diff(part.indptr) for part in (left, right)]
    starts = left.indptr + right.indptr
    places = [
        np.arange(len(left.indices)) + np.repeat(right.indptr[:-1], counts[0]),
        np.arange(len(right.indices)) + np.repeat(left.indptr[1:], counts[1]),
    ]
    indices, data = np.empty(starts[-1], dtype=left.indices.dtype), np.empty(starts[-1])
    for part, place, shift in zip((left, right), places, (0, left.shape[1]), strict=True):
        indices[place], data[place] = part.indices + shift, part.data
    return sp.csr_matrix((data, indices, starts), shape=(left.shape[0], left.shape[1] + right.shape[1]))
