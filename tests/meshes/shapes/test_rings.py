"""The ring meshes: exact volumes and areas, nodes on the sphere and on the ring, good cells."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.surface import surface_of
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.rings import ring_block, ring_sphere

SIDE, HEIGHT, RADIUS, RING, SIZE, FINE = 4.0, 4.0, 8.0, 0.47, 0.12, 0.6


@pytest.mark.parametrize("order", [1, 2])
def test_ring_block_areas(order: int) -> None:
    """Top and bottom have the area π·4²/4, the wedge's sides 16 mm²; straight-sided cells lose 1.5 % of a circle."""
    mesh = ring_block(SIDE, HEIGHT, RING, SIZE, FINE, order)
    circle = pytest.approx(np.pi * SIDE**2 / 4, rel=0.02 if order == 1 else 1e-5)
    assert surface_of(mesh, "top").areas().sum() == circle
    assert surface_of(mesh, "bottom").areas().sum() == circle
    for group in ("symmetry_x", "symmetry_y"):
        assert surface_of(mesh, group).areas().sum() == pytest.approx(SIDE * HEIGHT, rel=1e-9)
    assert scaled_jacobians(mesh).min() > 0.5


def test_ring_sphere_area_and_arc() -> None:
    """The spherical cap over the radius 4 mm has the area 2πRh/4; its nodes are on the sphere."""
    mesh = ring_sphere(RADIUS, SIDE, HEIGHT, RING, SIZE, FINE)
    cap = RADIUS - np.sqrt(RADIUS**2 - SIDE**2)
    assert surface_of(mesh, "arc").areas().sum() == pytest.approx(0.5 * np.pi * RADIUS * cap, rel=1e-4)
    on_sphere = mesh.points[np.unique(mesh.facets["arc"])] - (0.0, 0.0, RADIUS)
    assert np.allclose(np.linalg.norm(on_sphere, axis=1), RADIUS, rtol=1e-12)
    assert scaled_jacobians(mesh).min() > 0.5


def test_a_ring_of_cells_ends_at_the_ring() -> None:
    """No facet of the top reaches across the circle: a facet has all its nodes inside it, or all outside."""
    mesh = ring_block(SIDE, HEIGHT, RING, SIZE, FINE)
    radius = np.hypot(*mesh.points[mesh.facets["top"], :2].T).T
    inside, outside = (radius <= RING + 1e-9).all(axis=1), (radius >= RING - 1e-9).all(axis=1)
    assert (inside ^ outside).all()
    assert mesh.points[mesh.facets["top"][inside]].size > 0


def test_ring_block_cell_sizes() -> None:
    """Edges on the top are at most `size` long up to the ring, and r/ring times that from there to the end of the fine
    zone at r = 2 ring; there some are longer than 1.5 `size`, because the cells widen with the radius."""
    mesh = ring_block(SIDE, HEIGHT, RING, SIZE, 2 * RING, order=1)
    points = mesh.points[mesh.facets["top"], :2]
    edges = np.linalg.norm(points - np.roll(points, 1, axis=1), axis=2).max(axis=1)
    radius = np.linalg.norm(points, axis=2).max(axis=1)
    assert edges[radius < RING + 1e-9].max() <= SIZE * (1 + 1e-9)
    fine = radius < 2 * RING + 1e-9
    assert (edges[fine] <= SIZE * np.maximum(1.0, radius[fine] / RING) * (1 + 1e-9)).all()
    assert edges[fine].max() > 1.5 * SIZE


def test_impossible_rings_are_refused() -> None:
    """A ring outside the fine zone, and a sphere that rises too high, are refused with what was found."""
    with pytest.raises(MeshError, match=r"found ring 0\.7"):
        ring_block(SIDE, HEIGHT, 0.7, SIZE, FINE)
    with pytest.raises(MeshError, match=r"rises less than 0\.7"):
        ring_sphere(4.1, SIDE, HEIGHT, RING, SIZE, FINE)
