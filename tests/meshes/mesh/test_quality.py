"""The scaled Jacobian of known cells, and the cell that a failed check names."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import check_quality, scaled_jacobians
from evolvent_meshes.shapes.blocks import rectangle


def _one_cell(shape: str, points: list[list[float]]) -> MeshData:
    nodes = np.pad(np.array(points, dtype=float), ((0, 0), (0, 3 - len(points[0]))))
    return MeshData(nodes, shape, 1, np.arange(len(nodes))[None], {}, {"body": np.array([0])})


def test_scaled_jacobian_of_known_cells() -> None:
    """A 30° parallelogram has sin 30°, regular simplices 1, a cube's corner √2 / (1·√2·√2)."""
    rhomb = _one_cell("quadrilateral", [[0, 0], [3, 0], [3 + np.sqrt(3), 1], [np.sqrt(3), 1]])
    assert scaled_jacobians(rhomb) == pytest.approx(0.5)
    triangle = _one_cell("triangle", [[0, 0], [1, 0], [0.5, np.sqrt(3) / 2]])
    assert scaled_jacobians(triangle) == pytest.approx(1)
    regular = _one_cell("tetrahedron", [[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]])
    assert scaled_jacobians(regular) == pytest.approx(1)
    corner = _one_cell("tetrahedron", [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert scaled_jacobians(corner) == pytest.approx(1 / np.sqrt(2))


def test_quality_finds_an_inverted_cell() -> None:
    """One middle node of a second-order block pulled through its cell: the message names the cell's place."""
    mesh = rectangle(4, 4, 4, 4)
    check_quality(mesh, 0.99)
    points = mesh.points.copy()
    points[mesh.cells[9, 8]] += [0.6, 0, 0]
    broken = MeshData(points, mesh.shape, 2, mesh.cells, mesh.facets, mesh.volumes)
    assert np.flatnonzero(scaled_jacobians(broken) < 0.2).tolist() == [9]
    with pytest.raises(MeshError, match=r"cell 9 at \(2\.5667, 1\.5000"):
        check_quality(broken, 0.2)
