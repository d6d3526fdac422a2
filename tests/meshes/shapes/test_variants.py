"""Meshes made from others: exact volumes, areas and groups."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.body import Body, Traction, assemble
from evolvent.fem.surface import surface_of
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.blocks import box, graded_box, rectangle
from evolvent_meshes.shapes.rings import ring_sphere
from evolvent_meshes.shapes.variants import doubled, with_part


def test_part_of_a_facet_group_in_the_plane() -> None:
    """The top of 2 x 1 mm in 10 facets: |x| < 0.41 holds the four whose middles are at ±0.1 and ±0.3 mm."""
    mesh = with_part(rectangle(2.0, 1.0, 10, 2, origin=(-1.0, 0.0)), "top", "near", 0.41)
    x = mesh.points[mesh.facets["near"], 0].mean(axis=1)
    np.testing.assert_allclose(np.sort(x), [-0.3, -0.1, 0.1, 0.3], atol=1e-12)
    assert len(mesh.facets["top"]) == 10
    with pytest.raises(MeshError, match="wanted facets"):
        with_part(mesh, "top", "none", 0.05)


def test_part_of_a_facet_group_in_space() -> None:
    """The top of a box of 2 × 2 mm in 4 × 4 facets: within 0.4 mm of the z axis are the four middles at ±0.25 mm."""
    mesh = with_part(box((2.0, 2.0, 1.0), (4, 4, 2), origin=(-1.0, -1.0, 0.0)), "top", "near", 0.4)
    middles = mesh.points[mesh.facets["near"], :2].mean(axis=1)
    assert len(middles) == 4
    np.testing.assert_allclose(np.abs(middles), 0.25, atol=1e-12)


@pytest.mark.parametrize("order", [1, 2])
def test_doubled_block_has_twice_the_size_and_outward_normals(order: int) -> None:
    """A quarter of a graded block becomes a half of twice the volume; outward normals stay outward, every node once."""
    quarter = graded_box(2.0, 1.0, 0.5, 0.6, order)
    half = doubled(quarter, "symmetry_x")
    assert scaled_jacobians(half).min() > 0.0
    assert set(half.facets) == set(quarter.facets) - {"symmetry_x"}
    assert len(half.cells) == len(half.volumes["body"]) == 2 * len(quarter.cells)
    on_plane = len(np.unique(quarter.facets["symmetry_x"]))
    assert len(half.points) == 2 * len(quarter.points) - on_plane
    assert half.points[:, 0].min() == -2.0
    for name, normal in {"top": (0, 0, 1), "symmetry_y": (0, -1, 0)}.items():
        surface = surface_of(half, name)
        assert surface.areas().sum() == pytest.approx({"top": 8.0, "symmetry_y": 4.0}[name], rel=1e-12)
        np.testing.assert_allclose(surface.normals, np.broadcast_to(normal, surface.normals.shape), atol=1e-12)


def test_doubled_sphere_has_outward_normals() -> None:
    """The sphere of a doubled quarter still points at the centre, also in the image."""
    half = doubled(ring_sphere(8.0, 2.0, 2.0, 0.5, 0.25, 0.6), "symmetry_x")
    surface = surface_of(half, "arc")
    towards = (0.0, 0.0, 8.0) - surface.points
    turned = np.einsum("na,na->n", surface.normals, towards / np.linalg.norm(towards, axis=1)[:, None])
    assert turned.max() < -0.999
    assert (surface.points[:, 0] < -1.0).any() and (surface.points[:, 0] > 1.0).any()


def test_doubled_mesh_carries_twice_the_load() -> None:
    """A pressure on the doubled top gives the whole load, twice that of the quarter."""
    quarter = graded_box(2.0, 1.0, 0.5, 0.6)
    loads = [
        assemble(Body(mesh, loads=(Traction("top", (0.0, 0.0, -3.0)),))).load.reshape(-1, 3).sum(axis=0)
        for mesh in (quarter, doubled(quarter, "symmetry_x"))
    ]
    np.testing.assert_allclose(loads[0], [0.0, 0.0, -12.0], atol=1e-9)
    np.testing.assert_allclose(loads[1], 2.0 * loads[0], atol=1e-9)


def test_doubling_in_another_plane_is_refused() -> None:
    """A group that is not in the plane."""
    with pytest.raises(MeshError, match="right"):
        doubled(graded_box(2.0, 1.0, 0.5, 0.6), "right")
