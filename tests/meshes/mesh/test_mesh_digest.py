"""The digest of a mesh: the same for rounding errors, another one for any change of its shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.mesh_digest import mesh_digest
from evolvent_meshes.shapes.blocks import rectangle


def block(scale: float = 1.0) -> MeshData:
    """A small mesh whose points are no round numbers."""
    mesh = rectangle(40.0, 20.0, nx=7, ny=3)
    return replace(mesh, points=scale * np.pi / 3.0 * mesh.points)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_rounding_errors_do_not_count(scale: float) -> None:
    """Points that differ by 1e-16 of their distance: one digest, whatever their size."""
    mesh = block(scale)
    for seed in range(20):
        random = np.random.default_rng(seed)
        moved = mesh.points * (1.0 + 4e-16 * random.choice([-1, 0, 1], size=mesh.points.shape))
        assert mesh_digest(replace(mesh, points=moved)) == mesh_digest(mesh)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_a_moved_point_counts(scale: float) -> None:
    """One coordinate that moves by a millionth of the largest one: another digest."""
    mesh = block(scale)
    moved = mesh.points.copy()
    moved[3, 0] += 1e-6 * np.abs(mesh.points).max()
    assert mesh_digest(replace(mesh, points=moved)) != mesh_digest(mesh)


def test_cells_and_groups_count() -> None:
    """Other cells, another group: another digest."""
    mesh = block()
    groups = {**mesh.facets, "more": mesh.facets["top"]}
    for other in (replace(mesh, cells=mesh.cells[::-1]), replace(mesh, facets=groups), replace(mesh, order=1)):
        assert mesh_digest(other) != mesh_digest(mesh)
