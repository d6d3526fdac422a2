"""Condensation is exact elimination: the condensed and the full system have the same solution."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from evidence.verification.references.full_system import FullContact, full_equilibrium, full_solution
from evolvent import Freedom, Nitsche, Placement, Problem, Solution, Step, StepSystem, condense_bodies
from evolvent.contact.nitsche.coulomb import coulomb
from evolvent_meshes.arrays import Floats
from tests.support.contact_cases import ball, cylinder
from tests.support.running.samples import sampled

CASES = [(make, θ, μ) for θ in (1.0, 0.0, -1.0) for make in (cylinder, ball) for μ in (0.0, 0.1)]


@pytest.mark.parametrize(("make", "θ", "μ"), sampled(CASES, every=4))
def test_condensed_and_full_system_have_the_same_solution(make: Callable[[float], Problem], θ: float, μ: float) -> None:
    """Pressure, traction, rigid motion and the whole displacement field of both ways agree to 1e-8 (θ = 1, 0, −1, with
    and without friction, 2D and 3D)."""
    problem = replace(make(μ), nitsche=Nitsche(theta=θ))
    x, system = full_solution(problem, Step())
    position = StepSystem(problem, condense_bodies(problem), Step())
    solution, _ = position.solve(None)
    assert np.max(_differences(position, solution, x, system)) < 1e-8


@pytest.mark.parametrize("θ", [1.0, -1.0])
@pytest.mark.parametrize("μ", [0.0, 0.1])
def test_condensed_and_full_system_agree_after_finite_sliding(θ: float, μ: float) -> None:
    """The block has moved 0.8 mm sideways (several nodes) under the cylinder: new projections, the old compliance, and
    the slip since the first step. The block then drags the cylinder along with μ times the load."""
    problem = replace(cylinder(μ, first=1, extra=(Freedom("x", displacement=0.0),)), nitsche=Nitsche(theta=θ))
    condensed = condense_bodies(problem)
    rest = Placement.at_rest(2)
    _, before = StepSystem(problem, condensed, Step()).solve(None)
    moved = Step(placements=(rest, Placement(np.eye(2), np.array([0.8, 0.0]))))
    position = StepSystem(problem, condensed, moved)
    x, system = full_equilibrium(position, position.slip(before))
    solution, _ = position.solve(before)
    assert np.max(_differences(position, solution, x, system)) < 1e-8
    assert solution.contacts[0].force[0] == pytest.approx(μ * 5e3, abs=1e-6 * 5e3)


def _differences(position: StepSystem, solution: Solution, x: Floats, system: FullContact) -> list[float]:
    """Largest differences of traction, free rigid motions and the displacement of each body, as parts of the largest
    value; x: the solution of the full system."""
    traction = system.op.common(system.state(x).traction)
    motion = np.concatenate([m[p.free] for m, p in zip(solution.motions, position.motions, strict=True)])
    pairs = [(solution.contacts[0].traction, traction), (motion, x[system.K.shape[0] :])]
    at = 0
    for index, body in enumerate(position.condensed):
        a = body.assembled
        u = np.zeros(a.stiffness.shape[0])
        u[a.free] = x[at : at + len(a.free)]
        at += len(a.free)
        whole = u.reshape(-1, a.d) + a.motions.shapes @ solution.motions[index]
        pairs.append((solution.displacement(index), whole))
    return [np.abs(condensed - full).max() / np.abs(full).max() for condensed, full in pairs]


@pytest.mark.parametrize("θ", [1.0, 0.0, -1.0])
def test_full_tangent_is_the_derivative_of_the_residual(θ: float) -> None:
    """∂residual/∂x against central differences in a random direction near the solution, 1e-6 relative."""
    problem = replace(cylinder(), nitsche=Nitsche(theta=θ))
    x, _ = full_solution(problem, Step())
    position = StepSystem(problem, condense_bodies(problem), Step())
    system = FullContact(position, lambda t: coulomb(t, 0.2), position.slip(None))
    rng = np.random.default_rng(0)
    x = x * (1.0 + 1e-3 * rng.normal(size=len(x)))
    direction, step = rng.normal(size=len(x)) * 1e-4, 1e-5
    difference = (system.residual(x + step * direction) - system.residual(x - step * direction)) / (2.0 * step)
    assert np.linalg.norm(system.tangent(x) @ direction - difference) < 1e-6 * np.linalg.norm(difference)
