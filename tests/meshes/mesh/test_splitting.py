"""Splitting a second-order mesh: conforming, the same body, and functions that contain those before."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import least_determinants
from evolvent_meshes.mesh.splitting import edge_classes, halved, split
from evolvent_meshes.mesh.structured_grid import boundary_facets
from evolvent_meshes.shapes.blocks import box, rectangle
from evolvent_meshes.shapes.rings import ring_sphere


def curved(dimension: int) -> MeshData:
    """A grid of 2 × 3 (× 2) cells with curved edges."""
    mesh = rectangle(2.0, 3.0, 2, 3) if dimension == 2 else box((2.0, 3.0, 1.0), (2, 3, 2))
    x = mesh.points.copy()
    x[:, 0] += 0.2 * np.sin(x[:, 1])
    return MeshData(x, mesh.shape, 2, mesh.cells, mesh.facets, mesh.volumes)


def quadratic(points: Floats) -> Floats:
    return np.asarray(points[:, 0] ** 2 - points[:, 0] * points[:, 1] + points[:, 2])


@pytest.mark.parametrize("dimension", [2, 3])
def test_counts_by_class_give_a_conforming_mesh(dimension: int) -> None:
    """Every inner facet has two cells, no cell folds, and the groups have as many facets as their classes' counts
    multiply to. Exact."""
    mesh = curved(dimension)
    classes = edge_classes(mesh)
    counts = 1 + classes % 3
    fine = split(mesh, counts)
    assert len(fine.mesh.cells) == counts.prod(axis=1).sum()
    outline = boundary_facets(fine.mesh.shape, 2, fine.mesh.cells)
    assert set(outline[:, -1]) == {node for rows in fine.mesh.facets.values() for node in rows[:, -1]}
    assert least_determinants(fine.mesh).min() > 0.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_functions_before_are_among_those_after(dimension: int) -> None:
    """`values` interpolates: points of the mesh before give those after, constants stay, and on straight cells a
    quadratic function is reproduced. Exact."""
    mesh = curved(dimension)
    fine = split(mesh, 2 + edge_classes(mesh) % 2)
    assert np.abs(fine.values @ mesh.points - fine.mesh.points).max() < 1e-14
    assert np.abs(fine.values.sum(axis=1) - 1.0).max() < 1e-14
    straight = rectangle(2.0, 3.0, 2, 3) if dimension == 2 else box((2.0, 3.0, 1.0), (2, 3, 2))
    finer = split(straight, 2 + edge_classes(straight) % 2)
    assert finer.values @ quadratic(straight.points) == pytest.approx(quadratic(finer.mesh.points), abs=1e-13)


def test_halved_cells_are_an_eighth() -> None:
    """A ball's mesh, which has an unstructured core: eight cells each, four facets each, the old nodes are nodes."""
    mesh = ring_sphere(8.0, 4.0, 4.0, 1.0, 0.5, 1.2, 2)
    fine = halved(mesh)
    assert len(fine.cells) == 8 * len(mesh.cells)
    assert {n: len(f) for n, f in fine.facets.items()} == {n: 4 * len(f) for n, f in mesh.facets.items()}
    places = {tuple(p) for p in np.round(fine.points, 7)}
    assert all(tuple(p) in places for p in np.round(mesh.points, 7))


def test_counts_that_differ_along_a_class_are_refused() -> None:
    """A cell split alone would hang on its neighbours; first-order cells are refused too."""
    mesh = curved(2)
    counts = np.ones((len(mesh.cells), 2), dtype=int)
    counts[0] = 2
    with pytest.raises(MeshError, match="equal along each class of edges"):
        split(mesh, counts)
    with pytest.raises(MeshError, match="wanted second-order quadrilaterals or hexahedra, found triangles"):
        halved(rectangle(1.0, 1.0, 1, 1, shape="triangle"))
