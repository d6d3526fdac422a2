"""Compliance by partial factorisation against dense linear algebra and against solves column by column."""

from __future__ import annotations

import gc

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.fem.condensation.mumps import fill_symmetric
from evolvent.fem.condensation.nested_dissection import DissectionSettings
from evolvent.fem.condensation.schur_complement import (
    Factor,
    NotPositiveDefinite,
    SectorSystem,
    compliance,
    compliance_by_columns,
)
from tests.support.q1_elasticity import dofs_of, grid_cells, stiffness


def block(counts: tuple[int, int, int]) -> tuple[sp.csr_matrix, np.ndarray, sp.csr_matrix]:
    """K of a block with unit cells, free dofs (bottom z = 0 held), and displacement + traction-like functionals."""
    numbers, cells = grid_cells(counts)
    points = np.indices(numbers.shape).reshape(3, -1).T.astype(float)
    matrix = stiffness(points, cells)
    top = dofs_of(numbers[:, :, -1], 3)
    pick = sp.csr_matrix((np.ones(len(top)), (np.arange(len(top)), top)), shape=(len(top), matrix.shape[0]))
    return matrix, dofs_of(numbers[:, :, 1:], 3), (pick - 1e-6 * matrix[top]).tocsr()


def test_compliance_equals_dense_algebra() -> None:
    """C = P K⁻¹ Pᵀ by numpy.linalg.solve, symmetric to the last bit, positive definite."""
    matrix, free, functionals = block((4, 3, 3))
    found = compliance(matrix, functionals, free=free)
    dense, p = matrix[free][:, free].toarray(), functionals[:, free].toarray()
    exact = p @ np.linalg.solve(dense, p.T)
    assert np.abs(found - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.array_equal(found, found.T)
    assert np.linalg.eigvalsh(found).min() > 0


def test_compliance_equals_columns_at_size() -> None:
    """13,000 rows, 1,587 functionals (several tiles of the mirrored triangle): partial factorisation = solves."""
    matrix, free, functionals = block((22, 22, 8))
    found = compliance(matrix, functionals, free=free)
    restricted = functionals.tocsc()[:, free].tocsr()
    columns = compliance_by_columns(Factor(matrix[free][:, free]), restricted, restricted[::7])
    assert np.abs(found[:, ::7] - columns).max() < 1e-12 * np.abs(columns).max()


@pytest.mark.parametrize("leaf", [600, 60])
def test_dissection_changes_nothing(leaf: int) -> None:
    """Cut into parts of at most 600 or 60 rows, the compliance is that of one factorisation, to rounding."""
    matrix, free, functionals = block((9, 6, 6))
    exact = compliance(matrix, functionals, free=free)
    found = compliance(matrix, functionals, free=free, settings=DissectionSettings(leaf=leaf))
    assert np.abs(found - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.array_equal(found, found.T)


def test_dissection_of_separate_bodies() -> None:
    """Two bodies without a common dof, one without functionals: block diagonal compliance, zero coupling."""
    matrix, free, functionals = block((4, 4, 3))
    one, p = matrix[free][:, free], functionals[:, free]
    both = sp.block_diag([one, one, 2.0 * one], format="csr")
    q = sp.bmat([[p, None, sp.csr_matrix(p.shape)], [None, p, None]], format="csr")
    found = compliance(both, q, settings=DissectionSettings(leaf=100))
    exact = compliance(one, p)
    size = len(exact)
    assert np.abs(found[:size, :size] - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.abs(found[size:, size:] - exact).max() < 1e-13 * np.abs(exact).max()
    assert not found[:size, size:].any()


def test_dissection_of_many_pieces() -> None:
    """600 chains of three rows, as large as a leaf: the recursion halves them (one piece a level would be too deep for
    Python). C of three chains' ends is that of one end, (2 − 1/(2 − 1/2))⁻¹ = 3/4, on the diagonal."""
    chain = sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(3, 3))
    many = sp.block_diag([chain] * 600, format="csr")
    seen = sp.csr_matrix((np.ones(3), ([0, 1, 2], [0, 900, 1799])), shape=(3, 1800))
    found = compliance(many, seen, settings=DissectionSettings(leaf=3))
    assert np.abs(found - 0.75 * np.eye(3)).max() < 1e-14


def test_impossible_leaf_is_refused() -> None:
    """Without a row in a leaf there would be no end."""
    with pytest.raises(ValueError, match="a leaf of at least one row, found 0"):
        DissectionSettings(leaf=0)


def widely_coupled() -> tuple[sp.csr_matrix, sp.csr_matrix, sp.csr_matrix]:
    """A slab along x of 16 × 4 × 4 cells with a coupling over four cells on its top (as Nitsche's constant term), the
    slab alone, and functionals of the top."""
    mesh, free, functionals = block((16, 4, 4))
    mesh, face = mesh[free][:, free].tocsr(), functionals[:, free]
    return (mesh + 1e-3 * face.T @ face @ face.T @ face).tocsr(), mesh, face


def test_graph_changes_nothing() -> None:
    """Cuts along another graph than the matrix's own, thinner in places: C stays the one of dense algebra."""
    coupled, mesh, face = widely_coupled()
    found = compliance(coupled, face, settings=DissectionSettings(leaf=300), graph=mesh)
    p = face.toarray()
    exact = p @ np.linalg.solve(coupled.toarray(), p.T)
    assert np.abs(found - exact).max() < 1e-13 * np.abs(exact).max()


def test_unsymmetric_functionals() -> None:
    """P_left ≠ P_right (θ ≠ 1): rows of P_left K⁻¹ P_rightᵀ, exact by dense algebra."""
    matrix, free, functionals = block((3, 3, 2))
    dense = matrix[free][:, free].tocsr()
    right = functionals[:, free].tocsr()
    left = right[:5] * 2.0
    found = compliance_by_columns(Factor(dense), left, right, block=7)
    exact = left.toarray() @ np.linalg.solve(dense.toarray(), right.toarray().T)
    assert np.abs(found - exact).max() < 1e-13 * np.abs(exact).max()


def test_result_outlives_the_factor() -> None:
    """The compliance is MUMPS' own memory: it stays valid when all else is gone and other factors come and go."""
    matrix, free, functionals = block((5, 5, 3))
    found = compliance(matrix, functionals, free=free)
    view, kept = found[3:, 2:], found.copy()
    for _ in range(3):
        compliance(2.0 * matrix, functionals, free=free)
    del found
    gc.collect()
    assert np.array_equal(view, kept[3:, 2:])


def test_uniaxial_stretch() -> None:
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


def test_cut_faces_must_match() -> None:
    """Faces of different size, or with a common dof, are refused."""
    matrix, free, functionals = block((2, 2, 2))
    kept, p = matrix[free][:, free], functionals[:, free]
    with pytest.raises(ValueError, match="found 3 and 2"):
        SectorSystem.of(kept, p, np.array([0, 1, 2]), np.array([6, 7]))
    with pytest.raises(ValueError, match="3 different"):
        SectorSystem.of(kept, p, np.array([0, 1]), np.array([1, 7]))


def test_mirrored_triangle() -> None:
    """The lower triangle becomes the upper one, also where the last tile is cut off."""
    matrix = np.triu(np.arange(49.0).reshape(7, 7))
    exact = matrix + np.triu(matrix, 1).T
    fill_symmetric(matrix, tile=3)
    assert np.array_equal(matrix, exact)
