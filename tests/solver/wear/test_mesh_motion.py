"""Mesh motion: volumes, faces that stay, inverted cells."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.surface import surface_of
from evolvent.wear.mesh_motion import (
    InteriorMotion,
    MeshInverted,
    WornSurface,
    mesh_volume,
    motion_directions,
    worn_mesh,
)
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.blocks import box, cylinder_2d, rectangle


def block(shape: str, order: int) -> MeshData:
    """2 × 1 (× 1) mm."""
    if shape in ("triangle", "quadrilateral"):
        return rectangle(2.0, 1.0, 8, 6, order, shape)
    return box((2.0, 1.0, 1.0), (6, 4, 4), order, shape)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["quadrilateral", "triangle", "hexahedron", "tetrahedron"])
@pytest.mark.parametrize("follow", ["harmonic", "elastic"])
def test_moved_mesh_loses_the_worn_volume(shape: str, order: int, follow: InteriorMotion) -> None:
    """Problem: the top of a block worn by 0.05 (1 + cos πx) mm, 0 at one side. Exact: the mesh loses Σ m_k h_k within
    0.1 %, its sides stay plane and its bottom stays at rest."""
    mesh = block(shape, order)
    top = surface_of(mesh, "top")
    depth = 0.05 * (1.0 + np.cos(0.5 * np.pi * (top.points[:, 0] - top.points[:, 0].min())))
    moved = worn_mesh(mesh, [WornSurface(top, depth)], ["bottom"], follow)
    assert mesh_volume(mesh) - mesh_volume(moved) == pytest.approx(float(top.weights() @ depth), rel=1e-3)
    for name in ("left", "right", "bottom"):
        nodes = np.unique(mesh.facets[name])
        axis = 0 if name != "bottom" else mesh.dimension - 1
        np.testing.assert_allclose(moved.points[nodes, axis], mesh.points[nodes, axis], atol=1e-12)


@pytest.mark.parametrize("follow", ["harmonic", "elastic"])
def test_uniform_wear_moves_a_block_straight_down(follow: InteriorMotion) -> None:
    """Problem: a block worn by the same depth everywhere. Exact: the top moves down by it; with the harmonic interior
    no node moves sideways."""
    mesh = block("quadrilateral", 2)
    top = surface_of(mesh, "top")
    moved = worn_mesh(mesh, [WornSurface(top, np.full(len(top.points), 0.1))], ["bottom"], follow)
    shift = moved.points - mesh.points
    np.testing.assert_allclose(shift[top.nodes, 1], -0.1, atol=1e-12)
    if follow == "harmonic":
        np.testing.assert_allclose(shift[:, 0], 0.0, atol=1e-12)


def test_worn_edge_stays_in_its_adjacent_face() -> None:
    """Problem: a half disc whose arc wears, and a sheared block whose top wears. Exact: other facets continue the ends
    of the arc smoothly, so the direction is the normal; at the block's corner it is that of the side, d·n = 1."""
    disc = cylinder_2d(1.0, 0.1, 0.2)
    arc = surface_of(disc, "arc")
    np.testing.assert_allclose(motion_directions(disc, arc), arc.normals, atol=1e-12)
    mesh = block("quadrilateral", 2)
    sheared = mesh.points.copy()
    sheared[:, 0] += 0.5 * sheared[:, 1]
    mesh = MeshData(sheared, mesh.shape, mesh.order, mesh.cells, mesh.facets, mesh.volumes)
    top = surface_of(mesh, "top")
    d = motion_directions(mesh, top)
    corner = np.argmin(top.points[:, 0])
    np.testing.assert_allclose(d[corner], [0.5, 1.0], atol=1e-12)
    np.testing.assert_allclose(np.einsum("na,na->n", d, top.normals), 1.0, atol=1e-12)


@pytest.mark.parametrize("shape", ["quadrilateral", "triangle"])
def test_elastic_interior_keeps_better_cells(shape: str) -> None:
    """Problem: a block 2 wide and 1 high loses a pit a·exp(−(x/w)²) at once. The elastic interior keeps better cells,
    by more than 0.03 of the scaled Jacobian at a = 0.2, w = 0.25 and 0.5, and follows deeper: a = 0.3, w = 0.25 inverts
    cells with the harmonic one."""
    mesh = rectangle(2.0, 1.0, 16, 12, 2, shape)
    top = surface_of(mesh, "top")

    def quality(follow: InteriorMotion, width: float, deep: float) -> float:
        depth = deep * np.exp(-(((top.points[:, 0] - 1.0) / width) ** 2))
        return float(scaled_jacobians(worn_mesh(mesh, [WornSurface(top, depth)], ["bottom"], follow)).min())

    for width in (0.25, 0.5):
        assert quality("elastic", width, 0.2) > quality("harmonic", width, 0.2) + 0.03
    assert quality("elastic", 0.25, 0.3) > 0.1
    with pytest.raises(MeshInverted):
        quality("harmonic", 0.25, 0.3)


@pytest.mark.parametrize("order", [1, 2])
def test_compressed_cells_stay_within_the_side_faces(order: int) -> None:
    """Problem: half of a block worn off evenly with an elastic interior, which would bulge beyond the sides. Exact:
    nodes of the sides stay on them without inverting the cells beside them."""
    mesh = block("quadrilateral", order)
    top = surface_of(mesh, "top")
    moved = worn_mesh(mesh, [WornSurface(top, np.full(len(top.points), 0.5))], ["bottom"], "elastic")
    assert scaled_jacobians(moved).min() > 0.9


def test_inverted_cells_are_refused() -> None:
    """A depth above the body's height raises MeshInverted with the place and the remedy."""
    mesh = block("quadrilateral", 2)
    top = surface_of(mesh, "top")
    with pytest.raises(MeshInverted, match=r"wanted scaled Jacobians of at least 0\.05, found .* in cell .* at"):
        worn_mesh(mesh, [WornSurface(top, np.full(len(top.points), 1.2))], ["bottom"])


def test_mesh_motion_without_a_held_group_is_refused() -> None:
    """Without a group at rest the whole body would move with its surface: InputError."""
    mesh = block("quadrilateral", 2)
    top = surface_of(mesh, "top")
    with pytest.raises(ValueError, match="wanted a facet group that stays at rest"):
        worn_mesh(mesh, [WornSurface(top, np.full(len(top.points), 0.1))], [])
