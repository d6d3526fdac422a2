"""Blocks, discs and spherical caps: areas and volumes, facet groups, cell sizes."""

from itertools import product

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_box, graded_rectangle, rectangle, sphere_quarter
from tests.support.meshes.mesh_measures import covers_boundary, measure

A = 6.2146  # half-width of the NAFEMS cylinder's contact, mm
FLAT = ("quadrilateral", "triangle")
SOLID = ("hexahedron", "tetrahedron")


@pytest.mark.parametrize(("shape", "order"), product(FLAT + SOLID, (1, 2)))
def test_blocks_fill_their_size(shape: str, order: int) -> None:
    """Area or volume of every block by quadrature, and its groups are the boundary; conforming simplices included."""
    if shape in FLAT:
        meshes = [
            (rectangle(2, 3, 2, 3, order, shape, origin=(1, 1)), 6.0),
            (graded_rectangle(20, 10, A / 8, A / 2, order, shape), 200.0),
        ]
    else:
        meshes = [
            (box((1, 2, 3), (2, 3, 2), order, shape), 6.0),
            (graded_box(4, 3, 0.3, 0.6, order, shape), 48.0),
        ]
    for mesh, expected in meshes:
        assert measure(mesh) == pytest.approx(expected, rel=1e-12)
        assert covers_boundary(mesh)
        assert scaled_jacobians(mesh).min() > 0


def test_facet_groups_lie_on_the_sides_of_their_names() -> None:
    """Every group of the uniform blocks lies on the side that its name says."""
    flat, solid = rectangle(2, 3, 2, 3, origin=(1, 1)), box((1, 2, 3), (2, 2, 2), origin=(5, 5, 5))
    sides = {"left": (0, 1), "right": (0, 3), "bottom": (1, 1), "top": (1, 4)}
    for name, (axis, value) in sides.items():
        assert (flat.points[flat.facets[name], axis] == value).all()
    sides = {"left": (0, 5), "right": (0, 6), "front": (1, 5), "back": (1, 7), "bottom": (2, 5), "top": (2, 8)}
    for name, (axis, value) in sides.items():
        assert (solid.points[solid.facets[name], axis] == value).all()


@pytest.mark.parametrize(("shape", "half"), product(FLAT, (True, False)))
def test_disc_area_arc_and_cell_size(shape: str, half: bool) -> None:
    """NAFEMS cylinder, radius 50: area of the circle, every arc node on it, elements of a/8 in contact."""
    mesh = cylinder_2d(50, A / 8, 1.5 * A, order=2, shape=shape, half=half, contact=2 * A)
    area = np.pi * 50**2 / (2 if half else 1)
    assert measure(mesh) == pytest.approx(area, rel=1e-5)
    arc = mesh.points[mesh.facets["arc"]]
    np.testing.assert_allclose(np.hypot(arc[..., 0], arc[..., 1] - 50), 50, rtol=1e-14)
    near = abs(arc[:, :2, 0]).max(axis=1) < 1.5 * A + 1e-9
    length = np.linalg.norm(arc[:, 1] - arc[:, 0], axis=1)
    assert length[near].max() <= A / 8
    assert near.sum() >= 24
    assert 1.5 * A < abs(arc[..., 0]).max() <= 2 * A
    if half:
        assert np.ptp(mesh.points[mesh.facets["top"], 0]) == pytest.approx(100)
        np.testing.assert_allclose(mesh.points[mesh.facets["top"], 1], 50, rtol=1e-14)


@pytest.mark.parametrize("shape", SOLID)
def test_sphere_quarter_volume_and_arc(shape: str) -> None:
    """Sphere of 8 mm: volume above z = R − √(R² − x² − y²) by a fine sum, nodes of the arc on the sphere."""
    mesh = sphere_quarter(8, 4, 6, 0.47 / 2, 0.7, order=2, shape=shape)
    arc = mesh.points[np.unique(mesh.facets["arc"])] - [0, 0, 8]
    np.testing.assert_allclose(np.linalg.norm(arc, axis=1), 8, rtol=1e-14)
    middle = (np.arange(800) + 0.5) / 200
    sag = 8 - np.sqrt(64 - middle[:, None] ** 2 - middle[None, :] ** 2)
    assert measure(mesh) == pytest.approx(16 * (6 - sag.mean()), rel=1e-5)
    assert covers_boundary(mesh)
    with pytest.raises(MeshError, match="smaller side"):
        sphere_quarter(8, 6, 6, 0.2, 0.7)


def test_cell_shape_of_another_dimension_is_refused() -> None:
    """A tetrahedron is no shape of a rectangle."""
    with pytest.raises(MeshError, match="tetrahedron"):
        rectangle(1, 1, 1, 1, shape="tetrahedron")
