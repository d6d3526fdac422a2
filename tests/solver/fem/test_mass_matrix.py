"""The mass matrix of a body."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import Body, Fixed, Material
from evolvent.fem.mass_matrix import mass_matrix
from evolvent.fem.rigid_modes import rigid_modes
from evolvent_meshes.shapes.blocks import box, cylinder_2d


def test_mass_and_moment_of_inertia_of_half_a_disc() -> None:
    """A half disc of radius 5 about (0, 5), density 2e-9, cells of order 2: mass ϱπr²/2, polar moment of inertia
    ϱπr⁴/4, to the accuracy of an arc of parabolas, 1e-5."""
    mesh = cylinder_2d(radius=5.0, size=0.3, fine=1.0)
    M = mass_matrix(Body(mesh, Material(density=2e-9)))
    points = mesh.points[:, :2]
    R = rigid_modes(points - np.array([0.0, 5.0])).reshape(points.size, 3)
    mass, inertia = 2e-9 * np.pi * 25.0 / 2.0, 2e-9 * np.pi * 625.0 / 4.0
    assert np.diag(R.T @ (M @ R)) == pytest.approx([mass, mass, inertia], rel=1e-5)


@pytest.mark.parametrize("order", [1, 2])
def test_mass_of_a_box_in_any_cells(order: int) -> None:
    """A box of 2 × 3 × 4, hexahedra of order 1 and 2: ϱV for every direction, to rounding, and symmetric."""
    body = Body(box((2.0, 3.0, 4.0), (2, 1, 2), order), supports=(Fixed("bottom"),))
    M = mass_matrix(body)
    for axis in range(3):
        moved = np.tile(np.eye(3)[axis], len(body.mesh.points))
        assert moved @ (M @ moved) == pytest.approx(7.85e-9 * 24.0, rel=1e-12)
    assert abs(M - M.T).max() < 1e-14 * abs(M).max()
