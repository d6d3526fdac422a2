"""The condensed contact system: tangent, Newton steps, balance of forces, contact conditions at the solution."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evolvent import (
    Contact,
    Freedom,
    NotConverged,
    Problem,
    Step,
    StepSystem,
    condense_bodies,
    solve,
)
from evolvent.contact.newton.contact_equations import TOLERANCE, ContactEquations, _accuracy
from evolvent.contact.newton.equilibrium import (
    InitialGuess,
    _assumed_contact,
    frictional,
    frictionless,
    normal_part,
    sliding,
    stuck,
)
from evolvent.contact.nitsche.coulomb import coulomb, starting_guess
from evolvent_meshes.arrays import Floats
from tests.support.contact_cases import FRICTION, ball, cylinder


def _position(problem: Problem) -> StepSystem:
    return StepSystem(problem, condense_bodies(problem), Step())


@pytest.mark.parametrize("make", [cylinder, ball])
@pytest.mark.parametrize("law", ["coulomb", "starting guess"])
def test_tangent_is_the_derivative_of_the_residual(make: Callable[[], Problem], law: str) -> None:
    """The residual's derivative [I + MA, −MH; Hᵀ, 0] against central differences, 1e-6 relative, near the solution with
    open, stuck and sliding points; and a Newton step is its inverse, as accurate as asked for."""
    position = _position(make())
    system = position.system()
    slip = system.operator.shape @ position.slip(None)
    start = stuck(system, slip)
    laws = {
        "coulomb": lambda t: coulomb(t, FRICTION),
        "starting guess": lambda t: starting_guess(t, FRICTION, np.zeros((len(t), t.shape[1] - 1))),
    }
    problem = ContactEquations(system, laws[law], slip)
    step, compared = 2e-4, 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        x = problem.join(start.force, start.motion) * (1.0 + 1e-3 * rng.normal(size=problem.n * problem.k + problem.r))
        direction = rng.normal(size=len(x)) * np.abs(x).max() * 1e-4
        ahead, behind = x + step * direction, x - step * direction
        if not np.array_equal(*(problem.state(y).law.derivative != 0.0 for y in (ahead, behind))):
            continue  # a point changes its state in between: no derivative there
        compared += 1
        tangent = _tangent(problem, x)
        difference = (problem.residual(ahead) - problem.residual(behind)) / (2.0 * step)
        assert np.linalg.norm(tangent @ direction - difference) < 1e-6 * np.linalg.norm(difference)
        for accuracy in (1e-3, 1e-10):
            solved = system.steps.solve(problem.tangent(x), difference, accuracy)
            assert np.linalg.norm(tangent @ solved - difference) < accuracy * np.linalg.norm(difference)
    assert compared >= 3


def test_accuracy_of_a_newton_step_follows_the_residual() -> None:
    """The linear residual of a Newton step, accuracy times residual, is less than a fifth of the residual that the
    nonlinearity of the law leaves (200 times the square of the residual), but need not be below a hundredth of the
    tolerance; it is at most a hundredth of the residual, and at least 1e-7 of it, which double precision reaches. A
    system without a load has an accuracy, too."""
    for relative in 10.0 ** np.arange(-9, 1):
        left = _accuracy(relative * 5e3, 5e3, TOLERANCE) * relative
        assert left <= max(0.2 * 200.0 * relative**2, 1e-2 * TOLERANCE, 1e-7 * relative) * (1.0 + 1e-9)
        assert 1e-7 * relative * (1.0 - 1e-9) <= left <= 1e-2 * relative * (1.0 + 1e-9)
    assert 0.0 < _accuracy(0.0, 5e3, TOLERANCE) <= 1e-2 and 0.0 < _accuracy(1.0, 0.0, TOLERANCE) <= 1e-2


@pytest.mark.parametrize("make", [cylinder, ball])
def test_work_along_a_step_is_the_derivative_of_the_energy(make: Callable[[], Problem]) -> None:
    """Without friction `work` is the derivative along a step of ½fᵀAf + Σ w [p]₊²/2γ − Fᵀδ: central differences, 1e-6
    relative, far from the solution and with points that open along the step. It never decreases along a step, as the
    energy is convex, and is negative at the start of Newton's step."""
    system = normal_part(_position(make()).system())
    problem = ContactEquations(system, lambda t: coulomb(t, 0.0))
    solution = frictionless(system)
    op = system.operator

    def energy(x: Floats) -> float:
        force, motion = problem.split(x)
        f = force.ravel()
        p = np.maximum(op.trial(system.jumps(force, motion))[:, 0], 0.0)
        elastic = 0.5 * f @ system.compliance.times(f)
        return elastic + 0.5 * op.weights @ (p**2 / op.stabiliser[:, 0]) - system.load @ motion

    for seed in range(5):
        rng = np.random.default_rng(seed)
        x = problem.join(solution.force * (1.0 + 0.3 * rng.normal(size=(problem.n, 1))), 1.2 * solution.motion)
        step = problem.solve(x, problem.residual(x))
        work, h = problem.work(x, step), 1e-5
        slopes = [work(α) for α in (0.0, 0.3, 1.0)]
        differences = [(energy(x - (α + h) * step) - energy(x - (α - h) * step)) / (2.0 * h) for α in (0.0, 0.3, 1.0)]
        assert np.abs(np.subtract(slopes, differences)).max() < 1e-6 * np.abs(slopes).max()
        assert slopes[0] < 0.0 and np.all(np.diff(slopes) >= 0.0)


def _tangent(problem: ContactEquations, x: Floats) -> Floats:
    M = problem.system.operator.tangent(problem.state(x).law)
    H = problem.system.motion / problem.system.lever
    contact = np.hstack([np.eye(len(H)) + M @ problem.system.compliance.matrix, -(M @ H)])
    return np.vstack([contact, np.hstack([H.T, np.zeros((H.shape[1], H.shape[1]))])])


@pytest.mark.parametrize("make", [cylinder, ball])
def test_solution_meets_the_contact_and_friction_conditions(make: Callable[[], Problem]) -> None:
    """At the solution: λ ≥ 0, no weighted overlap beyond the flux term, |τ| ≤ μλ, contact force equal to the load."""
    problem = make()
    position = _position(problem)
    solution, _ = position.solve(None)
    contact = solution.contacts[0]
    shear = contact.traction - contact.pressure[:, None] * contact.normals
    assert contact.pressure.min() >= 0.0
    assert (np.linalg.norm(shear, axis=1) <= FRICTION * contact.pressure * (1.0 + 1e-9) + 1e-9).all()
    assert np.linalg.norm(shear, axis=1).max() > 0.05 * contact.pressure.max(), "friction is silently lost"
    rigid = problem.bodies[0].rigid
    assert rigid is not None
    assert contact.force[-1] == pytest.approx(rigid.freedoms[0].load, rel=1e-9)
    assert solution.imbalance < 1e-10


def test_friction_adds_shear_and_stiffness() -> None:
    """The same cylinder with μ = 0 and 0.2: no shear without friction, a stiffer contact with it."""
    smooth, rough = (solve(cylinder(μ)) for μ in (0.0, FRICTION))
    shear = [
        np.abs(s.contacts[0].traction - s.contacts[0].pressure[:, None] * s.contacts[0].normals).max()
        for s in (smooth, rough)
    ]
    assert shear[0] < 1e-9 * smooth.contacts[0].pressure.max()
    assert shear[1] > 1e-2 * smooth.contacts[0].pressure.max()
    assert smooth.motions[0][0] < rough.motions[0][0] < 0.0


@pytest.mark.parametrize("make", [lambda: cylinder(first=0), lambda: cylinder(first=1), ball])
@pytest.mark.parametrize("friction", [0.0, FRICTION])
def test_contact_forces_on_both_bodies_are_opposite(make: Callable[[], Problem], friction: float) -> None:
    """Nodal forces on both bodies cancel to 1e-10. Their moments cancel up to gap times force: the forces act at the
    undeformed surfaces, which are a gap apart where they touch."""
    problem = make()
    problem = Problem(problem.bodies, tuple(Contact(c.first, c.second, friction, c.reach) for c in problem.contacts))
    solution = solve(problem)
    total, moment = [], []
    for condensed, forces in zip(solution.condensed, solution.nodal_forces, strict=True):
        d = condensed.assembled.d
        nodal = (condensed.test_functionals.T @ forces).reshape(-1, d)
        points = condensed.assembled.body.mesh.points
        total.append(nodal.sum(axis=0))
        moment.append(np.cross(points, np.pad(nodal, ((0, 0), (0, 3 - d)))).sum(axis=0))
    contact = solution.contacts[0]
    size = np.linalg.norm(total[0])
    assert np.linalg.norm(total[0] + total[1]) < 1e-10 * size
    assert np.linalg.norm(total[problem.contacts[0].second[0]] - contact.force) < 1e-10 * size
    gap = _position(problem).operators[0].gap[contact.pressure > 0.0]
    assert np.abs(moment[0] + moment[1]).max() <= np.abs(gap).max() * (contact.weights @ contact.pressure)


def test_no_contact_within_reach_is_not_converged() -> None:
    """No point in contact under a load: an error that says so."""
    position = _position(cylinder(0.0))
    system = normal_part(position.system())
    none = np.zeros(len(system.operator.weights), dtype=bool)
    with pytest.raises(NotConverged, match="no node in contact"):
        _assumed_contact(system, none)


def test_solution_does_not_depend_on_the_initial_contact_set() -> None:
    """The frictionless solution from all points in contact and from six in the middle is the same."""
    system = normal_part(_position(cylinder(0.0)).system())
    few = np.zeros(len(system.operator.weights), dtype=bool)
    few[np.argsort(system.operator.gap)[:6]] = True
    a, b = frictionless(system), frictionless(system, few)
    assert np.abs(a.force - b.force).max() < 1e-9 * a.force.max()


def test_all_points_slide_in_known_directions() -> None:
    """τ = μλ·heading at every point in contact, whatever the displacement, and balance: the tractions by the law, the
    forces' sum by the load."""
    system = _position(cylinder()).system()
    heading = np.ones((len(system.operator.weights), 1))
    state = sliding(system, FRICTION, heading, frictionless(normal_part(system)))
    assert state.traction[:, 0].max() > 0.0
    assert state.traction[:, 1] == pytest.approx(FRICTION * state.traction[:, 0], rel=1e-12)
    assert np.abs(system.motion.T @ state.force.ravel() - system.load).max() < 1e-9 * system.scale


def test_bad_initial_guess_does_not_prevent_the_solution() -> None:
    """A guess with the bodies a millimetre apart, or in overlap by one, is abandoned: the solution is that without a
    guess."""
    position = _position(cylinder())
    system = position.system()
    slip = system.operator.shape @ position.slip(None)
    unknown, start = np.zeros((len(system.operator.weights), 1)), frictionless(normal_part(system))
    wanted = frictional(system, FRICTION, slip, unknown, start)
    for apart in (-1.0, 1.0):
        guess = InitialGuess(np.zeros_like(wanted.force), wanted.motion + apart)
        found = frictional(system, FRICTION, slip, unknown, start, guess)
        assert np.abs(found.force - wanted.force).max() < 1e-8 * wanted.force.max()


def test_free_tangential_motion_needs_friction() -> None:
    """A cylinder that may also move sideways, pushed with less than μP: with friction it sticks; without friction on a
    flat first surface nothing resists the push, and the error says so."""
    push = (Freedom("x", load=0.3 * FRICTION * 5e3),)
    solution = solve(cylinder(first=1, extra=push))
    assert solution.contacts[0].force[0] == pytest.approx(-0.3 * FRICTION * 5e3, rel=1e-9)
    with pytest.raises(NotConverged, match="support"):
        solve(cylinder(friction=0.0, first=1, extra=push))
