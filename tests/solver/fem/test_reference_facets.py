"""Reference facets: hat functions of the node grid, quadrature on its sub-facets, reversed facets."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.lagrange import tabulate
from evolvent.fem.reference_facets import REVERSED_FACET, hats, reference_cell, subcell_rule

CELLS = [(s, o) for s in ("interval", "quadrilateral", "triangle") for o in (1, 2)]


@pytest.mark.parametrize(("shape", "order"), CELLS)
def test_hats_and_shape_functions_are_bases(shape: str, order: int) -> None:
    """Both families are 1 at their own node, 0 at the others, sum to one; hats are not negative."""
    nodes = reference_cell(shape, order).nodes
    xi = np.random.default_rng(0).dirichlet(np.ones(3), 200)[:, : nodes.shape[1]]
    ψ, N = hats(shape, order, xi), tabulate(shape, order, xi)[0]
    assert np.allclose(hats(shape, order, nodes), np.eye(len(nodes)), atol=1e-14)
    assert np.allclose(tabulate(shape, order, nodes)[0], np.eye(len(nodes)), atol=1e-14)
    assert np.abs(ψ.sum(axis=1) - 1).max() < 1e-14
    assert np.abs(N.sum(axis=1) - 1).max() < 1e-14
    assert ψ.min() >= 0.0


@pytest.mark.parametrize(("shape", "order"), CELLS)
def test_hats_are_linear_on_subfacets(shape: str, order: int) -> None:
    """ψ of order 2 restricted to a sub-facet equals the order 1 shape functions of that sub-facet at its corners."""
    cell = reference_cell(shape, order)
    xi = np.random.default_rng(1).dirichlet(np.ones(3), 50)[:, : cell.nodes.shape[1]]
    for corners in cell.subcells:
        tensor = corners[[0, 1, 3, 2]] if shape == "quadrilateral" else corners
        weight = tabulate(shape, 1, xi)[0]
        expected = weight @ hats(shape, order, tensor)
        assert np.allclose(hats(shape, order, weight @ tensor), expected, atol=1e-14)


def test_subcell_rule_integrates_hats_exactly() -> None:
    """∫ψ_j over the reference triangle of order 2: sub-facets of area 1/8; corners own 1/24, mid-sides 3/24."""
    xi, w = subcell_rule("triangle", 2, 1)
    assert np.allclose(w @ hats("triangle", 2, xi), np.array([1, 1, 1, 3, 3, 3]) / 24, atol=1e-15)


@pytest.mark.parametrize(("shape", "order"), CELLS)
def test_turning_a_facet_over_keeps_its_points(shape: str, order: int) -> None:
    """The turned facet has the same nodes at mirrored reference points, and the opposite normal."""
    nodes = reference_cell(shape, order).nodes
    mirrored = 1.0 - nodes if nodes.shape[1] == 1 else nodes[:, ::-1]
    assert np.allclose(nodes[REVERSED_FACET[shape, order]], mirrored)
