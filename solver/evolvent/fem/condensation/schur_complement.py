"""Static condensation of a body's stiffness onto its surface functionals and its cut faces, computed once and exactly.

With K (n × n) symmetric positive definite on the free degrees of freedom and functionals P (m × n), for instance the
displacements of surface nodes, the compliance

    C = P K⁻¹ Pᵀ = −( Schur complement of [K Pᵀ; P 0] onto its second block )

comes from one partial factorisation instead of m solves. This is elimination, not approximation. The response P K⁻¹ L
to a load vector L is the column of C of a further row Lᵀ of P.

With θ ≠ 1 in Nitsche's form the functionals of test and trial functions differ, and K does not:
`compliance_by_columns`.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.fem.condensation.mumps import NotPositiveDefinite, OutOfMemory, SparseCholesky, upper_triangle
from evolvent.fem.condensation.nested_dissection import DEFAULT_DISSECTION, DissectionSettings, OrderedMatrix
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.parallel.memory import Stack
from evolvent_meshes.arrays import Floats, Ints

__all__ = [
    "Factor",
    "NotPositiveDefinite",
    "ObservedResponse",
    "OutOfMemory",
    "SectorCondensation",
    "SectorRecovery",
    "SectorSystem",
    "compliance",
    "compliance_by_columns",
]


def compliance(
    stiffness: sp.spmatrix, functionals: sp.spmatrix, free: Ints | None = None,
    settings: DissectionSettings = DEFAULT_DISSECTION, graph: sp.spmatrix | None = None, stack: Stack | None = None,
) -> Floats:
    """Compliance C = P K⁻¹ Pᵀ (m × m, symmetric; mm/N for displacements). Peak memory above K and P: about twice C.

    stiffness: K (n × n) [N/mm].
    functionals: P (m × n).
    free: degrees of freedom that are not fixed (default: all).
    graph: (n × n) the pattern that nested dissection divides, see `OrderedMatrix.of` (default: K's).
    stack: see `OrderedMatrix.schur_complement`.
    Raises NotPositiveDefinite and OutOfMemory.

    >>> springs = sp.csr_matrix([[2.0, -1.0], [-1.0, 2.0]])
    >>> first = sp.csr_matrix([[1.0, 0.0]])
    >>> print(f"{compliance(springs, first)[0, 0]:.4f} mm/N")
    0.6667 mm/N
    """
    count, kept = functionals.shape[0], np.arange(stiffness.shape[0]) if free is None else free
    nothing = sp.coo_matrix((count, count))
    result = _ordered(stiffness, functionals, kept, kept[:0], nothing, settings, graph).schur_complement(stack=stack)
    return np.negative(result, out=result)


class Factor:
    """Cholesky factor of K (n × n) on its free degrees of freedom, for load responses and displacement fields.

    free: degrees of freedom that are not fixed (default: all).
    Raises NotPositiveDefinite and OutOfMemory.
    """

    def __init__(
        self, stiffness: sp.spmatrix, free: Ints | None = None, settings: DissectionSettings = DEFAULT_DISSECTION
    ) -> None:
        self._free: Ints | slice = slice(None) if free is None else free
        kept = stiffness if free is None else _restricted(stiffness, free, free)
        self._cholesky = SparseCholesky(upper_triangle(kept.tocsr()), settings.factor)

    def solve(self, right: Floats) -> Floats:
        """X with K X = `right` on the free rows and 0 on the fixed ones; both (n,) or (n × c)."""
        if not right.size:  # MUMPS refuses no columns
            return np.zeros_like(right)
        columns = right.reshape(len(right), -1)
        solution = np.zeros(columns.shape, order="F")
        solution[self._free] = self._cholesky.solve(columns[self._free])
        return solution.reshape(right.shape)


def compliance_by_columns(
    factor: Factor, left: sp.spmatrix, right: sp.spmatrix | None = None, block: int = 512
) -> Floats:
    """P_left K⁻¹ P_rightᵀ (m_l × m_r) by solves in blocks of columns.

    Slow (about 12 ms a column at 80,000 rows): for unsymmetric pairs of functionals and as a check.

    left: P_left (m_l × n).
    right: P_right (m_r × n) (default: P_left).
    block: columns solved together.
    """
    test = left.tocsr()
    trial = test if right is None else right.tocsr()
    result = np.empty((test.shape[0], trial.shape[0]))
    for start in range(0, trial.shape[0], block):
        columns = slice(start, start + block)
        result[:, columns] = test @ factor.solve(trial[columns].T.toarray())
    return result


@dataclass(frozen=True)
class ObservedResponse:
    """Functionals w (o) of a sector on which no forces act: w = C_o f + T_o u_c, see `SectorCondensation`.

    compliance: C_o (o × m) [mm/N].
    transfer: T_o (o × 2c).
    """

    compliance: Floats
    transfer: Floats


@dataclass(frozen=True)
class SectorCondensation:
    """A sector condensed onto its two cut faces and its functionals, in the sector's frame.

    y = C f + T u_c and S u_c = Tᵀ f + g, with functionals y (m) and their forces f (m), displacements u_c and forces g
    of the cut faces (2c, the low face first).

    stiffness: S (2c × 2c) [N/mm].
    transfer: T (m × 2c).
    compliance: C (m × m), both cut faces clamped [mm/N].
    observed: further functionals.
    """

    stiffness: Floats
    transfer: Floats
    compliance: Floats
    observed: ObservedResponse | None = None


@dataclass(frozen=True)
class SectorSystem:
    """System [K Pᵀ; P 0] of a sector in elimination order: interior rows, cut faces, functionals.

    matrix: the interior rows are eliminated, the others retained.
    cut: 2c, degrees of freedom of both cut faces.
    surface: m, functionals on which forces act.
    observed: o, further functionals, retained after them.
    """

    matrix: OrderedMatrix
    cut: int
    surface: int
    observed: int

    @staticmethod
    def of(
        stiffness: sp.spmatrix, functionals: sp.spmatrix, low: Ints, high: Ints, graph: sp.spmatrix | None = None,
        free: Ints | None = None, settings: DissectionSettings = DEFAULT_DISSECTION,
        observed: sp.spmatrix | None = None,
    ) -> SectorSystem:
        """The system of a sector.

        stiffness: K (n × n) [N/mm].
        functionals: P (m × n).
        low, high: (c,) degrees of freedom of the cut faces in matching order, none of them fixed.
        graph: (n × n) the pattern that nested dissection divides (default: K's).
        free: degrees of freedom that are not fixed (default: all).
        observed: further functionals (o × n) on which no forces act (default: none).
        Raises ValueError where the faces do not match.
        """
        interior, cut = _split(stiffness.shape[0], low, high, free)
        every = functionals if observed is None else sp.vstack([functionals, observed])
        across = every.tocsc()[:, cut]
        corner = sp.bmat([[_restricted(stiffness, cut, cut), across.T], [across, None]], format="coo")
        matrix = _ordered(stiffness, every, interior, cut, corner, settings, graph)
        return SectorSystem(matrix, len(cut), functionals.shape[0], every.shape[0] - functionals.shape[0])

    def condensed(self, threads: Threads = nullcontext) -> SectorCondensation:
        """The sector condensed onto cut faces and functionals. Raises NotPositiveDefinite and OutOfMemory.

        threads: makes the context in which separators are eliminated.
        """
        schur = self.matrix.schur_complement(threads)
        faces, surface = slice(0, self.cut), slice(self.cut, self.cut + self.surface)
        rest = slice(surface.stop, None)
        observed = ObservedResponse(-schur[rest, surface], schur[rest, faces].copy()) if self.observed else None
        return SectorCondensation(
            schur[faces, faces].copy(), schur[surface, faces].copy(), -schur[surface, surface], observed
        )


class SectorRecovery:
    """Displacement field of a sector from the forces of its functionals and the displacements of its cut faces.

    stiffness: K (n × n) [N/mm].
    functionals: P (m × n).
    low, high: (c,) degrees of freedom of the cut faces.
    Raises NotPositiveDefinite and OutOfMemory, ValueError where the faces do not match.
    """

    def __init__(
        self, stiffness: sp.spmatrix, functionals: sp.spmatrix, low: Ints, high: Ints,
        settings: DissectionSettings = DEFAULT_DISSECTION,
    ) -> None:
        self._interior, self._cut = _split(stiffness.shape[0], low, high)
        self._loads = functionals.tocsc()[:, self._interior].T.tocsr()
        self._coupling = _restricted(stiffness, self._interior, self._cut)
        self._factor = Factor(stiffness, self._interior, settings)

    def displacement(self, forces: Floats, cut: Floats) -> Floats:
        """Field u (n,) [mm] in the sector's frame; forces: f (m,) [N], cut: u_c (2c,) [mm]."""
        field = np.empty(len(self._interior) + len(self._cut))
        field[self._cut] = cut
        load = np.zeros(len(field))
        load[self._interior] = self._loads @ forces - self._coupling @ cut
        field[self._interior] = self._factor.solve(load)[self._interior]
        return field


def _split(size: int, low: Ints, high: Ints, free: Ints | None = None) -> tuple[Ints, Ints]:
    """Interior degrees of freedom, and those of both cut faces. Raises ValueError where the faces do not match."""
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


def _ordered(
    stiffness: sp.spmatrix, functionals: sp.spmatrix, interior: Ints, cut: Ints, corner: sp.coo_matrix,
    settings: DissectionSettings, graph: sp.spmatrix | None,
) -> OrderedMatrix:
    """System [K Pᵀ; P 0]: rows of the interior to eliminate, cut faces and functionals retained."""
    size, count = stiffness.shape[0], functionals.shape[0]
    columns = np.concatenate([interior, cut, size + np.arange(count)])
    rows = _restricted(_beside(stiffness.tocsr(), functionals.T.tocsr()), interior, columns)
    inner = None if graph is None else _restricted(graph, interior, interior)
    return OrderedMatrix.of(rows, corner, settings, inner)


def _restricted(matrix: sp.spmatrix, rows: Ints, columns: Ints) -> sp.csr_matrix:
    """Some rows and columns of a matrix, in any order; column indices are not sorted.

    SciPy's matrix[rows][:, columns] takes several times longer.
    """
    taken = matrix.tocsr()[rows]
    place = np.full(matrix.shape[1], -1, dtype=taken.indices.dtype)
    place[columns] = np.arange(len(columns))
    indices = place[taken.indices]
    kept = indices >= 0
    ends = np.concatenate([[0], np.cumsum(kept, dtype=taken.indptr.dtype)])[taken.indptr]
    return sp.csr_matrix((taken.data[kept], indices[kept], ends), shape=(len(rows), len(columns)))


def _beside(left: sp.csr_matrix, right: sp.csr_matrix) -> sp.csr_matrix:
    """Matrix [left right] as the sum of two wide matrices; SciPy's `hstack` converts both to coordinate lists."""
    shape = left.shape[0], left.shape[1] + right.shape[1]
    moved = right.indices + right.indices.dtype.type(left.shape[1])
    wide = sp.csr_matrix((left.data, left.indices, left.indptr), shape=shape)
    return wide + sp.csr_matrix((right.data, moved, right.indptr), shape=shape)
