"""Compliance by partial factorisation against dense linear algebra and against solves column by column."""

from __future__ import annotations

import gc

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.fem.condensation.nested_dissection import DissectionSettings
from evolvent.fem.condensation.schur_complement import (
    Factor,
    NotPositiveDefinite,
    SectorSystem,
    compliance,
    compliance_by_columns,
)
from tests.support.q1_elasticity import block, grid_cells, stiffness


def test_compliance_equals_dense_algebra() -> None:
    """C = P K⁻¹ Pᵀ by numpy.linalg.solve, symmetric to the last bit, positive definite."""
    matrix, free, functionals = block((4, 3, 3))
    C = compliance(matrix, functionals, free=free)
    dense, p = matrix[free][:, free].toarray(), functionals[:, free].toarray()
    exact = p @ np.linalg.solve(dense, p.T)
    assert np.abs(C - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.array_equal(C, C.T)
    assert np.linalg.eigvalsh(C).min() > 0


def test_compliance_equals_columns_at_size() -> None:
    """13,000 rows, 1,587 functionals (several tiles of the mirrored triangle): partial factorisation = solves."""
    matrix, free, functionals = block((22, 22, 8))
    C = compliance(matrix, functionals, free=free)
    restricted = functionals.tocsc()[:, free].tocsr()
    columns = compliance_by_columns(Factor(matrix[free][:, free]), restricted, restricted[::7])
    assert np.abs(C[:, ::7] - columns).max() < 1e-12 * np.abs(columns).max()


def test_compliance_of_unsymmetric_functionals() -> None:
    """P_left ≠ P_right (θ ≠ 1): rows of P_left K⁻¹ P_rightᵀ, exact by dense algebra."""
    matrix, free, functionals = block((3, 3, 2))
    dense = matrix[free][:, free].tocsr()
    right = functionals[:, free].tocsr()
    left = right[:5] * 2.0
    C = compliance_by_columns(Factor(dense), left, right, block=7)
    exact = left.toarray() @ np.linalg.solve(dense.toarray(), right.toarray().T)
    assert np.abs(C - exact).max() < 1e-13 * np.abs(exact).max()


def test_compliance_outlives_the_factor() -> None:
    """The compliance is memory of MUMPS: it stays valid when the factor and the matrices are freed and others made."""
    matrix, free, functionals = block((5, 5, 3))
    C = compliance(matrix, functionals, free=free)
    view, kept = C[3:, 2:], C.copy()
    for _ in range(3):
        compliance(2.0 * matrix, functionals, free=free)
    del C
    gc.collect()
    assert np.array_equal(view, kept[3:, 2:])


def test_factor_solves_a_stretched_bar() -> None:
    """A bar held at one end (rollers), pulled with p at the other: u = pL/E at its top (ν-free directions held)."""
    numbers, cells = grid_cells((2, 2, 5))
    points = np.indices(numbers.shape).reshape(3, -1).T.astype(float)
    held = [3 * numbers[0].ravel(), 3 * numbers[:, 0].ravel() + 1, 3 * numbers[:, :, 0].ravel() + 2]
    free = np.setdiff1d(np.arange(3 * len(points)), np.concatenate(held))
    corner = np.array([1.0, 2.0, 1.0])
    share = np.outer(corner, corner).ravel() / 4 * 100.0
    load = np.zeros(3 * len(points))
    load[3 * numbers[:, :, -1].ravel() + 2] = share
    field = Factor(stiffness(points, cells), free=free).solve(load)
    np.testing.assert_allclose(field[3 * numbers[:, :, -1].ravel() + 2], 100.0 * 5 / 210e3, rtol=1e-12)
    assert not field[np.concatenate(held)].any()


@pytest.mark.parametrize("shift", [1.5, 40.0])
def test_indefinite_stiffness_is_refused(shift: float) -> None:
    """K − s·λ_min·1 with s > 1 has negative eigenvalues: factor and condensation both say so and what to look at."""
    matrix, free, functionals = block((4, 4, 3))
    dense = matrix[free][:, free]
    smallest = np.linalg.eigvalsh(dense.toarray())[0]
    bad = (dense - shift * smallest * sp.eye(dense.shape[0])).tocsr()
    with pytest.raises(NotPositiveDefinite, match=r"negative or zero pivots.*held in every direction.*γ"):
        Factor(bad)
    for leaf in (10000, 40):
        with pytest.raises(NotPositiveDefinite, match=r"negative or zero pivots"):
            compliance(bad, functionals[:, free], settings=DissectionSettings(leaf=leaf))


def test_cut_faces_that_do_not_match_are_refused() -> None:
    """Faces of different size, or with a common dof, are refused."""
    matrix, free, functionals = block((2, 2, 2))
    kept, p = matrix[free][:, free], functionals[:, free]
    with pytest.raises(ValueError, match="found 3 and 2"):
        SectorSystem.of(kept, p, np.array([0, 1, 2]), np.array([6, 7]))
    with pytest.raises(ValueError, match="3 different"):
        SectorSystem.of(kept, p, np.array([0, 1]), np.array([1, 7]))
