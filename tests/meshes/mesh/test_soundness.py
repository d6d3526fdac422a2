"""Checks of a mesh: as many cells are folded as by an independent measure, and sound cells pass."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.mesh.soundness import check_mesh
from evolvent_meshes.shapes.blocks import box, rectangle, sphere_quarter

SHAPES = [(s, o) for s in ("triangle", "quadrilateral", "tetrahedron", "hexahedron") for o in (1, 2)]


def _block(shape: str, order: int, count: int = 4) -> MeshData:
    if shape in ("triangle", "quadrilateral"):
        return rectangle(1.0, 1.0, count, count, order, shape)
    return box((1.0, 1.0, 1.0), (count,) * 3, order, shape)


@pytest.mark.parametrize(("shape", "order"), SHAPES)
def test_folded_cells_are_counted(shape: str, order: int) -> None:
    """Four inner nodes moved by most of a cell's size: as many cells are refused as have a scaled Jacobian that is not
    above zero, and the worst cell that is named is one of them. The mesh before passes."""
    mesh = _block(shape, order)
    check_mesh(mesh, "block")
    d = mesh.dimension
    inside = ((mesh.points[:, :d] > 1e-9) & (mesh.points[:, :d] < 1.0 - 1e-9)).all(axis=1)
    points = mesh.points.copy()
    thrown = np.random.default_rng(1).permutation(np.flatnonzero(inside))[:4]
    points[thrown, :d] += np.random.default_rng(2).choice([-0.2, 0.2], (len(thrown), d))
    bad = scaled_jacobians(replace(mesh, points=points)) <= 0.0
    assert 0 < bad.sum() < len(bad)
    with pytest.raises(MeshError, match=rf"block: wanted cells .* found {bad.sum()} of {len(bad)} cells") as caught:
        check_mesh(replace(mesh, points=points), "block")
    worst = int(str(caught.value).split("worst is cell ")[1].split()[0])
    assert bad[worst]


def test_thin_cells_pass_and_flat_cells_are_refused() -> None:
    """A cell a millionth as high as it is wide is a cell, one of 1e-13 is flat."""
    mesh = rectangle(1.0, 1.0, 1, 1, 1)
    check_mesh(replace(mesh, points=mesh.points * [1.0, 1e-6, 1.0]), "thin")
    with pytest.raises(MeshError, match="1 of 1 cells folded or flat"):
        check_mesh(replace(mesh, points=mesh.points * [1.0, 1e-13, 1.0]), "flat")


def test_curved_cells_of_any_size_pass() -> None:
    """A quarter of a ball in second-order hexahedra: no cell of it is folded, in any size."""
    ball = sphere_quarter(8.0, 2.0, 2.0, 0.4, 0.6, 2)
    for size in (1e-6, 1.0, 1e6):
        check_mesh(replace(ball, points=size * ball.points), "ball")
