"""The stretched ring meshes: areas, nodes on the paraboloid and on the ellipse, good cells."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.surface import surface_of
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.ellipse import ellipse_block, ellipse_punch

AXES, CURVATURES, SIDE, SIZE, FINE = (1.0, 0.5), (0.01, 0.03), 6.0, 0.15, 0.7


def test_ellipse_block_areas() -> None:
    """The top is a quarter of an ellipse with half-axes 12 and 6 mm, the wedge's sides are 12 x 6 and 6 x 6 mm²."""
    mesh = ellipse_block(AXES, SIDE, SIZE, FINE)
    assert surface_of(mesh, "top").areas().sum() == pytest.approx(np.pi * 12.0 * 6.0 / 4, rel=1e-5)
    assert surface_of(mesh, "symmetry_y").areas().sum() == pytest.approx(72.0, rel=1e-9)
    assert surface_of(mesh, "symmetry_x").areas().sum() == pytest.approx(36.0, rel=1e-9)
    assert scaled_jacobians(mesh).min() > 0.3


def test_ellipse_punch_lies_on_its_paraboloid() -> None:
    """All nodes of the underside lie on z = A x² + B y², those of x = 0 and y = 0 on their planes, the top is flat."""
    mesh = ellipse_punch(AXES, CURVATURES, SIDE, SIZE, FINE)
    x, y, z = mesh.points[np.unique(mesh.facets["arc"])].T
    assert np.allclose(z, CURVATURES[0] * x**2 + CURVATURES[1] * y**2, rtol=1e-12)
    assert np.allclose(mesh.points[np.unique(mesh.facets["symmetry_x"]), 0], 0.0)
    assert np.allclose(mesh.points[np.unique(mesh.facets["symmetry_y"]), 1], 0.0)
    assert np.allclose(mesh.points[np.unique(mesh.facets["top"]), 2], SIDE)
    assert scaled_jacobians(mesh).min() > 0.3


@pytest.mark.parametrize("group", ["top", "arc"])
def test_a_ring_of_cells_ends_at_the_ellipse(group: str) -> None:
    """No facet reaches across the ellipse: all its nodes are inside, or all outside."""
    block = group == "top"
    mesh = ellipse_block(AXES, SIDE, SIZE, FINE) if block else ellipse_punch(AXES, CURVATURES, SIDE, SIZE, FINE)
    x, y = np.moveaxis(mesh.points[mesh.facets[group], :2], 2, 0)
    radius = np.hypot(x / AXES[0], y / AXES[1])
    inside, outside = (radius <= 1 + 1e-9).all(axis=1), (radius >= 1 - 1e-9).all(axis=1)
    assert (inside ^ outside).all()
    assert inside.any() and outside.any()


def test_impossible_ellipses_are_refused() -> None:
    """Exchanged axes, and a paraboloid that rises too high, are refused with what was found."""
    with pytest.raises(MeshError, match=r"found a = 0\.5, b = 1"):
        ellipse_block((0.5, 1.0), SIDE, SIZE, FINE)
    with pytest.raises(MeshError, match=r"rises less than 0\.7"):
        ellipse_punch(AXES, (0.1, 0.1), SIDE, SIZE, FINE)
