"""Patch test: every finite element space contains a uniform stress, which non-matching meshes have to transmit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from demos.two_blocks import FRICTION, PRESSURE, SHEAR, Patch
from evolvent import Body, Contact, Fixed, NotConverged, Placement, Problem, Step, Traction, solve

SHAPES = ("quadrilateral", "triangle", "hexahedron", "tetrahedron")


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("first", [0, 1])
def test_uniform_pressure_passes_non_matching_meshes(shape: str, order: int, first: int) -> None:
    """Two blocks of different stiffness on rollers under p = 100 MPa: λ = p at every interface node."""
    patch = Patch(shape, order, first)
    assert patch.errors(solve(patch.problem())).max() < 1e-6


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", SHAPES)
def test_uniform_pressure_and_shear_pass_with_sticking_friction(shape: str, order: int) -> None:
    """The same with a shear of 20 MPa < μp and an upper block that nothing but friction holds: λ = p and τ = 20."""
    patch = Patch(shape, order, first=1, friction=FRICTION)
    assert patch.errors(solve(patch.problem())).max() < 1e-6


@pytest.mark.parametrize("shape", ["triangle", "hexahedron"])
def test_traction_rotates_with_the_placements(shape: str) -> None:
    """Both bodies turned by 0.7 rad about the origin by their placements: the traction turns with them."""
    patch = Patch(shape, 2, friction=FRICTION)
    R = np.eye(patch.d)
    R[:2, :2] = [[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]]
    placement = Placement(R, np.arange(patch.d) * 3.0)
    solution = solve(patch.problem(), Step(placements=(placement, placement)))
    assert patch.errors(solution, R).max() < 1e-6


@pytest.mark.parametrize("shape", ["quadrilateral", "tetrahedron"])
def test_uniform_pressure_passes_rotated_meshes(shape: str) -> None:
    """The nodes themselves turned by 25°, the tractions with them: the same λ = p.

    The upper block is free (friction holds it), the lower one clamped; ν = 0, so the clamp does not disturb.
    """
    patch = Patch(shape, 1, friction=FRICTION)
    angle = np.radians(25.0)
    R = np.eye(3)
    R[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]

    def turned(body: Body) -> Body:
        mesh = replace(body.mesh, points=body.mesh.points @ R.T)
        tractions = (load for load in body.loads if isinstance(load, Traction))
        loads = tuple(Traction(t.group, tuple(R[: patch.d, : patch.d] @ np.array(t.vector))) for t in tractions)
        return replace(body, mesh=mesh, loads=loads)

    problem = patch.problem()
    solution = solve(replace(problem, bodies=tuple(turned(b) for b in problem.bodies)))
    assert patch.errors(solution, R[: patch.d, : patch.d]).max() < 1e-6


def test_sliding_block_has_no_equilibrium() -> None:
    """A shear above μp cannot be held by friction: NotConverged, not the traction of a sticking block."""
    patch = Patch("quadrilateral", 2, friction=0.5 * SHEAR / PRESSURE)
    with pytest.raises(NotConverged):
        solve(patch.problem())


def test_displacement_of_the_pressed_blocks_is_exact() -> None:
    """p = 100 MPa on two blocks of 1 mm height, plane strain: the top sinks by Σ p h (1−ν²)/E for free sides."""
    patch = Patch("quadrilateral", 1)
    solution = solve(patch.problem())
    top = np.unique(patch.meshes()[0].facets["top"])
    exact = -PRESSURE * (1.0 - 0.3**2) * (1.0 / 210e3 + 1.0 / 70e3)
    assert np.allclose(solution.displacement(0)[top, 1], exact, rtol=1e-9)


def test_tensile_load_has_no_equilibrium() -> None:
    """A tensile load on the upper block meets no contact force: no equilibrium, and no adhesion."""
    upper, lower = Patch("quadrilateral", 1).meshes()
    bodies = (
        Body(upper, supports=(Fixed("left", "x"),), loads=(Traction("top", (0.0, 50.0)),)),
        Body(lower, supports=(Fixed("bottom"),)),
    )
    with pytest.raises(NotConverged):
        solve(Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1),)))
