"""Nested dissection against one factorisation and against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.fem.condensation.nested_dissection import DissectionSettings
from evolvent.fem.condensation.schur_complement import compliance
from evolvent.fem.parallel.memory import Stack
from tests.support.q1_elasticity import block


@pytest.mark.parametrize("leaf", [600, 60])
def test_compliance_does_not_depend_on_the_leaf_size(leaf: int) -> None:
    """Cut into parts of at most 600 or 60 rows, the compliance is that of one factorisation, to rounding."""
    matrix, free, functionals = block((9, 6, 6))
    exact = compliance(matrix, functionals, free=free)
    C = compliance(matrix, functionals, free=free, settings=DissectionSettings(leaf=leaf))
    assert np.abs(C - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.array_equal(C, C.T)


def test_eliminations_use_the_same_memory() -> None:
    """A block, a smaller one and the first again on one stack, whose memory is full of the last one's numbers: as on
    memory of their own. Exact."""
    stack, settings = Stack(), DissectionSettings(leaf=100)
    for cells in ((9, 6, 6), (5, 4, 4), (9, 6, 6)):
        matrix, free, functionals = block(cells)
        own = compliance(matrix, functionals, free, settings)
        assert np.array_equal(compliance(matrix, functionals, free, settings, stack=stack), own)


def test_dissection_of_separate_bodies() -> None:
    """Two bodies without a common dof, one without functionals: block diagonal compliance, zero coupling."""
    matrix, free, functionals = block((4, 4, 3))
    one, p = matrix[free][:, free], functionals[:, free]
    both = sp.block_diag([one, one, 2.0 * one], format="csr")
    q = sp.bmat([[p, None, sp.csr_matrix(p.shape)], [None, p, None]], format="csr")
    C = compliance(both, q, settings=DissectionSettings(leaf=100))
    exact = compliance(one, p)
    size = len(exact)
    assert np.abs(C[:size, :size] - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.abs(C[size:, size:] - exact).max() < 1e-13 * np.abs(exact).max()
    assert not C[:size, size:].any()


def test_dissection_of_many_pieces() -> None:
    """600 chains of three rows, as large as a leaf: the recursion halves them (one piece a level would be too deep for
    Python). C of three chains' ends is that of one end, (2 − 1/(2 − 1/2))⁻¹ = 3/4, on the diagonal."""
    chain = sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(3, 3))
    many = sp.block_diag([chain] * 600, format="csr")
    seen = sp.csr_matrix((np.ones(3), ([0, 1, 2], [0, 900, 1799])), shape=(3, 1800))
    C = compliance(many, seen, settings=DissectionSettings(leaf=3))
    assert np.abs(C - 0.75 * np.eye(3)).max() < 1e-14


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


def test_compliance_does_not_depend_on_the_dissected_graph() -> None:
    """Dissection along another graph than the matrix's, with fewer entries: C equals that of dense algebra."""
    coupled, mesh, face = widely_coupled()
    C = compliance(coupled, face, settings=DissectionSettings(leaf=300), graph=mesh)
    p = face.toarray()
    exact = p @ np.linalg.solve(coupled.toarray(), p.T)
    assert np.abs(C - exact).max() < 1e-13 * np.abs(exact).max()
