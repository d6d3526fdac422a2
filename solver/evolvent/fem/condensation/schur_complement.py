"""Condensation of a body's stiffness: what its surface and its cut faces feel of the bulk, computed once and exactly.

With K (n × n) symmetric positive definite on the free degrees of freedom and functionals P (m × n), for instance the
displacements of surface nodes, the compliance

    C = P K⁻¹ Pᵀ = −( Schur complement of [K Pᵀ; P 0] onto its second block )

comes from one partial factorisation instead of m solves. This is elimination, not approximation. A load vector L is
served by one more row Lᵀ of P: its column of C is then the response P K⁻¹ L.

θ ≠ 1 in Nitsche's form makes the functionals of test and trial functions differ, not K: `compliance_by_columns`.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.fem.condensation.mumps import NotPositiveDefinite, OutOfMemory, SparseCholesky
from evolvent.fem.condensation.nested_dissection import STANDARD, DissectionSettings, Planned
from evolvent.fem.parallel.cores import Threads
from evolvent_meshes.arrays import Floats, Ints

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
    all). `graph` (n × n) has the pattern that cuts follow, see `dissection.Planned`. Peak memory above K and
    P is about twice C.

    Raises NotPositiveDefinite and OutOfMemory.
    """
    count, kept = functionals.shape[0], np.arange(stiffness.shape[0]) if free is None else free
    nothing = sp.coo_matrix((count, count))
    result = _planned(stiffness, functionals, kept, kept[:0], nothing, settings, graph).schur_complement()
    return np.negative(result, out=result)


class Factor:
    """Cholesky factor of K on its free degrees of freedom; `solve` is for load responses and displacement fields.

    Raises NotPositiveDefinite and OutOfMemory.
    """

    def __init__(
        self, stiffness: sp.spmatrix, free: Ints | None = None, settings: DissectionSettings = STANDARD
    ) -> None:
        self._free: Ints | slice = slice(None) if free is None else free
        kept = stiffness if free is None else _restricted(stiffness, free, free)
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
    """[K Pᵀ; P 0] of a sector, ready for elimination: interior rows first, then the 2c = `cut` of the cut faces, then
    the m = `surface` functionals."""

    matrix: Planned
    cut: int
    surface: int

    @staticmethod
    def of(
        stiffness: sp.spmatrix, functionals: sp.spmatrix, low: Ints, high: Ints, graph: sp.spmatrix | None = None,
        free: Ints | None = None, settings: DissectionSettings = STANDARD,
    ) -> SectorSystem:  # fmt: skip
        """From K (n × n), P (m × n), the dofs `low`, `high` (c each) of the cut faces, the pattern (n × n) that cuts
        follow (default: K's) and the dofs that are not fixed (default: all; the faces' are not). Raises ValueError
        where the faces do not match."""
        interior, cut = _split(stiffness.shape[0], low, high, free)
        across = functionals.tocsc()[:, cut]
        corner = sp.bmat([[_restricted(stiffness, cut, cut), across.T], [across, None]], format="coo")
        planned = _planned(stiffness, functionals, interior, cut, corner, settings, graph)
        return SectorSystem(planned, len(cut), functionals.shape[0])

    def condensed(self, threads: Threads = nullcontext) -> SectorCondensation:
        """Onto the cut faces and the functionals. Raises NotPositiveDefinite and OutOfMemory."""
        schur = self.matrix.schur_complement(threads)
        faces, surface = slice(0, self.cut), slice(self.cut, None)
        return SectorCondensation(schur[faces, faces].copy(), schur[surface, faces].copy(), -schur[surface, surface])


class SectorRecovery:
    """Displacement field of a whole sector from what acts on its surface and the displacements of its cut faces."""

    def __init__(
        self, stiffness: sp.spmatrix, functionals: sp.spmatrix, low: Ints, high: Ints,
        settings: DissectionSettings = STANDARD,
    ) -> None:  # fmt: skip
        self._interior, self._cut = _split(stiffness.shape[0], low, high)
        self._loads = functionals.tocsc()[:, self._interior].T.tocsr()
        self._coupling = _restricted(stiffness, self._interior, self._cut)
        self._factor = Factor(stiffness, self._interior, settings)

    def displacement(self, forces: Floats, cut: Floats) -> Floats:
        """Field u (n) of the sector in its own frame: forces f (m), cut-face displacements u_c (2c)."""
        field = np.empty(len(self._interior) + len(self._cut))
        field[self._cut] = cut
        load = np.zeros(len(field))
        load[self._interior] = self._loads @ forces - self._coupling @ cut
        field[self._interior] = self._factor.solve(load)[self._interior]
        return field


def _split(size: int, low: Ints, high: Ints, free: Ints | None = None) -> tuple[Ints, Ints]:
    cut = np.concatenate([low, high])
    if len(low) != len(high) or len(np.unique(cut)) != len(cut):
        raise ValueError(
            f"two cut faces with equally many degrees of freedom and none in common are wanted, found {len(low)} and "
            f"{len(high)}, {len(np.unique(cut))} different: give both faces in matching order, without fixed ones"
        )
    interior = np.zeros(size, dtype=bool)
    interior[slice(None) if free is None else free] = True
    interior[cut] = False
    return np.flatnonzero(interior), cut


def _planned(
    stiffness: sp.spmatrix, functionals: sp.spmatrix, interior: Ints, cut: Ints, corner: sp.coo_matrix,
    settings: DissectionSettings, graph: sp.spmatrix | None,
) -> Planned:  # fmt: skip
    """[K Pᵀ] of the interior rows, its columns the interior, the cut faces and the functionals."""
    size, count = stiffness.shape[0], functionals.shape[0]
    columns = np.concatenate([interior, cut, size + np.arange(count)])
    rows = _restricted(_beside(stiffness.tocsr(), functionals.T.tocsr()), interior, columns)
    inner = None if graph is None else _restricted(graph, interior, interior)
    return Planned.of(rows, corner, settings, inner)


def _restricted(matrix: sp.spmatrix, rows: Ints, columns: Ints) -> sp.csr_matrix:
    """Some rows and columns of a matrix, in any order; SciPy's own matrix[rows][:, columns] takes several times longer.
    Indices are not sorted."""
    taken = matrix.tocsr()[rows]
    place = np.full(matrix.shape[1], -1, dtype=taken.indices.dtype)
    place[columns] = np.arange(len(columns))
    indices = place[taken.indices]
    kept = indices >= 0
    ends = np.concatenate([[0], np.cumsum(kept, dtype=taken.indptr.dtype)])[taken.indptr]
    return sp.csr_matrix((taken.data[kept], indices[kept], ends), shape=(len(rows), len(columns)))


def _beside(left: sp.csr_matrix, right: sp.csr_matrix) -> sp.csr_matrix:
    """[left right], a sum of two wide matrices: SciPy's `hstack` makes lists of coordinates on the way."""
    shape = left.shape[0], left.shape[1] + right.shape[1]
    moved = right.indices + right.indices.dtype.type(left.shape[1])
    wide = sp.csr_matrix((left.data, left.indices, left.indptr), shape=shape)
    return wide + sp.csr_matrix((right.data, moved, right.indptr), shape=shape)
