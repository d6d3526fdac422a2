"""Displacements of a solution as functions of dolfinx, on the caller's mesh and on a body's own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import ufl
from dolfinx import mesh as dolfinx_mesh
from mpi4py import MPI

from evolvent import Body, Contact, Fixed, Material, Problem, Solution, Step, Traction, mesh_from_dolfinx, solve, sweep
from evolvent.fem.backend import dolfinx_compat
from evolvent_meshes.shapes.blocks import rectangle

PRESSURE = 100.0  # MPa
STEEL, BRASS = Material(210e3, 0.3), Material(100e3, 0.35)
TAGS = {"bottom": 1, "top": 2, "left": 3}


def block(kind: str, nx: int, ny: int, bottom: float) -> Any:
    """A square of 1 mm by dolfinx, with tagged sides."""
    made = dolfinx_mesh.create_rectangle(
        MPI.COMM_SELF, [np.array([0.0, bottom]), np.array([1.0, bottom + 1.0])], [nx, ny],
        getattr(dolfinx_mesh.CellType, kind),
    )
    found = [
        dolfinx_mesh.locate_entities_boundary(made, 1, lambda x, axis=axis, at=at: np.abs(x[axis] - at) < 1e-9)
        for axis, at in ((1, bottom), (1, bottom + 1.0), (0, 0.0))
    ]
    facets = np.concatenate(found).astype(np.int32)
    values = np.repeat(np.arange(1, 4, dtype=np.int32), [len(each) for each in found])
    order = np.argsort(facets)
    return made, dolfinx_mesh.meshtags(made, 1, facets[order], values[order])


def blocks(kind: str) -> tuple[Any, Any, Problem]:
    """dolfinx's squares, on top of each other and with different cells, and the problem that they make."""
    (under, under_tags), (over, over_tags) = block(kind, 4, 3, 0.0), block(kind, 5, 2, 1.0)
    lower = Body(mesh_from_dolfinx(under, under_tags, TAGS), STEEL, (Fixed("left", "x"), Fixed("bottom", "y")))
    upper = Body(
        mesh_from_dolfinx(over, over_tags, TAGS), BRASS, (Fixed("left", "x"),), (Traction("top", (0.0, -PRESSURE)),)
    )
    return under, over, Problem((lower, upper), (Contact(lower["top"], upper["bottom"]),))


def strain_energy(solution: Solution, body: Body) -> float:
    """½ ∫ σ : ε [N·mm/mm] by UFL."""
    λ, μ = body.material.lame
    ε = ufl.sym(ufl.grad(solution.function(body)))
    return dolfinx_compat.assemble_number((λ / 2 * ufl.tr(ε) ** 2 + μ * ufl.inner(ε, ε)) * ufl.dx)


@pytest.mark.parametrize("kind", ["triangle", "quadrilateral"])
def test_pressed_squares_of_dolfinx_are_exact(kind: str) -> None:
    """Two squares of dolfinx under p = 100 MPa with free sides: λ = p everywhere, the energy of each is
    p²(1 − ν²)/2E by UFL, and u is linear in y."""
    under, over, problem = blocks(kind)
    solution = solve(problem)
    assert np.abs(solution.contacts[0].pressure / PRESSURE - 1.0).max() < 1e-10
    for body, theirs in zip(problem.bodies, (under, over)):
        E, ν = body.material.youngs_modulus, body.material.poissons_ratio
        assert strain_energy(solution, body) == pytest.approx(PRESSURE**2 * (1 - ν**2) / (2 * E), rel=1e-10)
        assert solution.function(body).function_space.mesh is theirs
    E, ν = STEEL.youngs_modulus, STEEL.poissons_ratio
    x, u = ufl.SpatialCoordinate(under), solution.function(problem.bodies[0])
    exact = PRESSURE * (1 + ν) / E * ufl.as_vector((ν * x[0], (ν - 1) * x[1]))
    square = dolfinx_compat.assemble_number(ufl.inner(u - exact, u - exact) * ufl.dx)
    assert np.sqrt(square) < 1e-10 * PRESSURE / E


def test_functions_of_a_sweep_share_the_mesh_of_a_body_of_arrays() -> None:
    """Half and all of the load on rectangles of order 2: the difference of both functions, in one form, has a quarter
    of the energy."""
    lower = Body(rectangle(1.0, 1.0, 2, 2), STEEL, (Fixed("left", "x"), Fixed("bottom", "y")))
    upper = Body(
        rectangle(1.0, 1.0, 3, 2, origin=(0.0, 1.0)), STEEL, (Fixed("left", "x"),), (Traction("top", (0.0, -PRESSURE)),)
    )
    problem = Problem((lower, upper), (Contact(lower["top"], upper["bottom"]),))
    half, whole = (each.function(upper) for each in sweep(problem, (Step(0.5), Step())))
    λ, μ = STEEL.lame
    ε = ufl.sym(ufl.grad(whole - half))
    energy = dolfinx_compat.assemble_number((λ / 2 * ufl.tr(ε) ** 2 + μ * ufl.inner(ε, ε)) * ufl.dx)
    assert energy == pytest.approx(PRESSURE**2 * (1 - 0.3**2) / (2 * 210e3) / 4, rel=1e-9)
