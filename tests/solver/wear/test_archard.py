"""Archard's law at the nodes: volumes to rounding for any contact points."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.surface import surface_of
from evolvent.wear.archard import Archard, DepthProjection
from evolvent_meshes.shapes.blocks import box, rectangle


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["quadrilateral", "hexahedron", "tetrahedron"])
def test_depth_projection_keeps_the_volume(shape: str, order: int) -> None:
    """Problem: random volumes at random points of a surface, some slightly outside their facet. Exact: Σ m_k h_k is
    their sum to rounding, no depth is negative, and the hat functions sum to one."""
    plane = shape == "quadrilateral"
    mesh = rectangle(2.0, 1.0, 5, 3, order) if plane else box((2.0, 1.0, 1.0), (4, 3, 2), order, shape)
    top, rng = surface_of(mesh, "top"), np.random.default_rng(0)
    facets = rng.integers(len(top.facets), size=500)
    xi = rng.uniform(-0.02, 1.02 if top.shape != "triangle" else 0.52, (500, mesh.dimension - 1))
    volumes = rng.uniform(0.0, 1.0, 500)
    projection = DepthProjection.of(top, facets, xi)
    depth = projection.depth(volumes)
    assert depth.min() >= 0.0
    assert projection.volume(depth) == pytest.approx(volumes.sum(), rel=1e-13)
    np.testing.assert_allclose(projection.at_points(np.ones(len(depth))), 1.0, rtol=1e-14)


def test_depth_projection_of_a_uniform_depth_is_uniform() -> None:
    """Problem: volumes w of a quadrature on all facets of a plane surface of order 1. Exact: the depth is 1 at every
    node."""
    from evolvent.fem.lagrange import quadrature

    top = surface_of(box((2.0, 1.0, 1.0), (4, 3, 2), 1), "top")
    xi, w = quadrature(top.shape, 4)
    facets = np.repeat(np.arange(len(top.facets)), len(w))
    volumes = np.outer(top.areas(), w).ravel()
    projection = DepthProjection.of(top, facets, np.tile(xi, (len(top.facets), 1)))
    np.testing.assert_allclose(projection.depth(volumes), 1.0, rtol=1e-12)


@pytest.mark.parametrize("value", [-1e-10, float("nan"), float("inf")])
def test_bad_wear_coefficient_is_refused(value: float) -> None:
    """K/H below zero or not finite is refused with its side."""
    with pytest.raises(ValueError, match="wear of the second surface: wanted K/H of zero or more"):
        Archard(1e-10, value)
