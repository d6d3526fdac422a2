"""Stress in the cells against fields that are known exactly."""

from __future__ import annotations

import numpy as np
import pytest

from demos.hertz_cylinder import STEEL, Slip
from evolvent import Contact, Problem, solve
from evolvent.contact.hertz import line_largest_mises
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material
from evolvent.fem.stress import cell_stress, von_mises
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_rectangle, rectangle


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["triangle", "quadrilateral", "tetrahedron", "hexahedron"])
def test_cell_stress_of_a_uniform_strain(shape: str, order: int) -> None:
    """u = εx: σ = λ tr ε I + 2με in every cell; plane cells have σ_zz = ν(σ_xx + σ_yy)."""
    plane = shape in ("triangle", "quadrilateral")
    mesh = rectangle(2.0, 1.0, 3, 2, order, shape) if plane else box((2.0, 1.0, 1.0), (2, 2, 1), order, shape)
    d, material = mesh.dimension, Material(210e3, 0.3)
    gradient = np.random.default_rng(0).normal(size=(d, d)) * 1e-3
    ε = np.zeros((3, 3))
    ε[:d, :d] = 0.5 * (gradient + gradient.T)
    λ, μ = material.lame
    stress = cell_stress(mesh, material, mesh.points[:, :d] @ gradient.T)
    assert np.allclose(stress, λ * np.trace(ε) * np.eye(3) + 2.0 * μ * ε, atol=1e-9)
    if plane:
        assert np.allclose(stress[:, 2, 2], 0.3 * (stress[:, 0, 0] + stress[:, 1, 1]))


def test_von_mises_stress_of_known_states() -> None:
    """Uniaxial tension gives its own value, pure shear √3 times it, a hydrostatic pressure nothing."""
    tension, shear = np.diag([200.0, 0.0, 0.0]), np.zeros((3, 3))
    shear[0, 1] = shear[1, 0] = 100.0
    stress = von_mises(np.stack([tension, shear, -50.0 * np.eye(3)]))
    assert np.allclose(stress, [200.0, np.sqrt(3.0) * 100.0, 0.0])


def test_largest_von_mises_stress_below_a_line_contact() -> None:
    """The largest von Mises stress of a line contact is 0.5575 p0 at 0.704 b (ν = 0.3): within 1 %, and the depth
    within the cell's size, for a/R = 0.01."""
    slip = Slip()
    b = slip.half_width
    problem = Problem(
        (
            Body(cylinder_2d(50.0, b / 8, 1.5 * b), STEEL, rigid=Rigid("top", (Freedom("y", load=-slip.load),))),
            Body(graded_rectangle(100.0, 100.0, b / 11, 1.5 * b), STEEL, supports=(Fixed("bottom"),)),
        ),
        (Contact((1, "top"), (0, "arc"), reach=0.25 * b),),
    )
    solution = solve(problem)
    exact = line_largest_mises(0.3)
    for index in (0, 1):
        mesh = solution.condensed[index].assembled.body.mesh
        mises = von_mises(cell_stress(mesh, STEEL, solution.displacement(index)))
        depth = abs(mesh.points[mesh.cells[mises.argmax()], 1].mean())
        assert mises.max() == pytest.approx(exact.value * slip.peak, rel=0.01)
        assert depth == pytest.approx(exact.depth * b, abs=b / 8)
