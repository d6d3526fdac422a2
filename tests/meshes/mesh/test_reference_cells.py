"""Reference cells: node order as gmsh's, gradients of the shape functions."""

from __future__ import annotations

import gmsh
import numpy as np
import pytest

from evolvent_meshes.mesh.gmsh_io import ELEMENT_TYPES, gmsh_model
from evolvent_meshes.mesh.reference_cells import node_positions, shape_gradients


def test_node_order_is_gmsh_order() -> None:
    """Reference node positions of all cell and facet types, against those that gmsh itself states."""
    with gmsh_model("order"):
        for number, (shape, order) in ELEMENT_TYPES.items():
            _, dimension, _, count, local, _ = gmsh.model.mesh.getElementProperties(number)
            expected = np.array(local).reshape(count, dimension)
            if shape in ("interval", "quadrilateral", "hexahedron"):
                expected = (expected + 1) / 2  # gmsh: [-1, 1]
            np.testing.assert_allclose(node_positions(shape, order) / 2, expected, atol=1e-14)


@pytest.mark.parametrize("shape", ["triangle", "quadrilateral", "tetrahedron", "hexahedron"])
def test_shape_gradients_reproduce_a_quadratic(shape: str) -> None:
    """The interpolant of f = 1 + x − 2y + 3x² + xy (+ z²) at second-order nodes has f's gradient everywhere."""
    nodes = node_positions(shape, 2) / 2
    x, y, z = np.pad(nodes, ((0, 0), (0, 3 - nodes.shape[1]))).T
    where = np.random.default_rng(0).uniform(0, 0.5, (5, nodes.shape[1]))
    a, b, c = np.pad(where, ((0, 0), (0, 3 - nodes.shape[1]))).T
    gradient = np.einsum("pnd,n->pd", shape_gradients(shape, 2, where), 1 + x - 2 * y + 3 * x**2 + x * y + z**2)
    expected = np.stack([1 + 6 * a + b, -2 + a, 2 * c], axis=1)[:, : nodes.shape[1]]
    np.testing.assert_allclose(gradient, expected, atol=1e-13)
