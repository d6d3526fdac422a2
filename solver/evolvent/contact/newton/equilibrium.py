"""Equilibrium of a condensed contact system: SNES on the nodal contact forces and the free rigid motions.

The equations are in contact_equations.py; here are the stages that lead to their solution.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton import snes
from evolvent.contact.newton.contact_equations import CondensedSystem, ContactEquations
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.coulomb import LawValues, coulomb, starting_guess
from evolvent_meshes.arrays import Bools, Floats

ITERATIONS = 60
GUESS_ITERATIONS = 10  # after which a start from a given guess is abandoned


@dataclass(frozen=True)
class Equilibrium:
    """A converged state, in local frames with k components.

    force: nodal forces f (n, k) [N].
    traction: tractions at the points (q, k) [MPa].
    motion: amplitudes δ of the free rigid motions (r,) [mm, rad].
    jump: J (n, k) [mm].
    iterations: number of Newton iterations.
    residual: norm of the residual forces [N].
    """

    force: Floats
    traction: Floats
    motion: Floats
    jump: Floats
    iterations: int
    residual: float


@dataclass(frozen=True)
class InitialGuess:
    """A guess of an equilibrium from which Newton's method starts.

    force: nodal forces (n, k) [N].
    motion: amplitudes of the free rigid motions (r,) [mm, rad].
    """

    force: Floats
    motion: Floats

    @staticmethod
    def of(equilibrium: Equilibrium) -> InitialGuess:
        """A state that is near."""
        return InitialGuess(equilibrium.force, equilibrium.motion)


def normal_part(system: CondensedSystem) -> CondensedSystem:
    """The frictionless system: normal components only. A system that has no others is returned as it is."""
    k = system.k
    if k == 1:
        return system
    return replace(
        system, compliance=system.compliance.normal(), motion=system.motion[::k], jump=system.jump[::k]
    )


def frictionless(
    system: CondensedSystem, start: Bools | None = None, near: InitialGuess | None = None
) -> Equilibrium:
    """Equilibrium without friction, of a system with k = 1.

    start: (q,) bool, points assumed in contact in the first, linear, solve; by default all, and of bodies with inertia
        those that would overlap without contact forces.
    near: a guess of the solution, taken instead.
    Raises NotConverged.
    """
    problem = ContactEquations(system, lambda t: coulomb(t, 0.0))
    if near is not None:
        x = problem.join(near.force, near.motion)
    else:
        x = _assumed_contact(system, _overlapping(system) if start is None else start)
    return _converged(problem, x, "contact without friction")


def _overlapping(system: CondensedSystem) -> Bools:
    """Points (q,) bool that overlap without contact forces; all where contact alone holds the free motions."""
    free = free_motion(system.motion, system.jump, system.load, system.resistance)
    if free is None:
        return np.ones(len(system.operator.weights), dtype=bool)
    return np.asarray(system.operator.trial(free[1].reshape(-1, system.k))[:, 0] > 0.0)


def free_motion(motion: Floats, jump: Floats, load: Floats, resistance: Floats) -> tuple[Floats, Floats] | None:
    """Amplitudes δ (r,) of the free rigid motions and jumps (n·k,) [mm] without contact forces; None where contact
    alone holds these motions. motion, jump, load, resistance: as of `CondensedSystem`."""
    if not resistance.any() or np.linalg.cond(resistance) > 1.0 / np.finfo(float).eps:
        return None
    δ = np.linalg.solve(resistance, load)
    return δ, jump + motion @ δ


def stuck(system: CondensedSystem, slip: Floats) -> Equilibrium:
    """The state in which all points in contact stick, however large the traction; a start for `frictional`.

    It is the only start if friction alone carries a load. slip: as in `frictional`. The state is only approximately in
    equilibrium: at the edge, where sticking traction is singular, a point may open and close without end. Raises
    NotConverged where the tangent is singular.
    """
    law = ContactEquations(system, lambda t: starting_guess(t, 0.0, np.zeros((len(t), system.k - 1))), slip)
    every = np.ones(len(system.operator.weights), dtype=bool)
    start = _assumed_contact(system, every, slip)
    return _equilibrium(law, snes.solve(law, start, "contact without slip", ITERATIONS // 2, system.tolerance))


def sliding(system: CondensedSystem, friction: Floats | float, heading: Floats, start: Equilibrium) -> Equilibrium:
    """The state in which all points in contact slide in known directions, τ = μλ·heading.

    heading: (q, d−1) unit directions, zero where a point sticks. start: the equilibrium without friction. Raises
    NotConverged.
    """
    law = ContactEquations(system, lambda t: starting_guess(t, friction, heading))
    x = law.join(with_components(start.force, system.k), start.motion)
    return _converged(law, x, "contact that slides everywhere")


def frictional(
    system: CondensedSystem, friction: Floats | float, slip: Floats, heading: Floats, start: Equilibrium,
    near: InitialGuess | None = None,
) -> Equilibrium:
    """Equilibrium with Coulomb friction.

    friction: coefficient μ, a number or (q,).
    slip: (q, d−1) slip at the points since the last state, without that of the current displacement [mm].
    heading: (q, d−1) unit direction of slip where it is known, else zero.
    start: the equilibrium without friction, or `stuck`.
    near: a guess of the solution, tried first.
    Raises NotConverged.
    """
    law = ContactEquations(system, lambda t: coulomb(t, friction), slip)
    if near is not None:
        try:
            x = law.join(near.force, near.motion)
            root = snes.solve(law, x, "Coulomb friction", GUESS_ITERATIONS, system.tolerance)
        except NotConverged:  # the guess lost contact altogether
            root = None
        if root is not None and root.converged:
            return _equilibrium(law, root)
    failure = NotConverged("Coulomb friction: no start")
    for x in _starts(system, friction, slip, heading, start):
        try:
            return _converged(law, x, "Coulomb friction")
        except NotConverged as error:
            failure = error
    raise failure


def _starts(
    system: CondensedSystem, friction: Floats | float, slip: Floats, heading: Floats, start: Equilibrium
) -> Iterator[Floats]:
    """Initial x, the best one first: slip in the known direction, then sticking, then the state without friction.

    Near the pitch point of a coarse sweep points may have slipped a hundred times the elastic displacement. If they are
    assumed to stick, tractions of a hundred times the load separate the surfaces in the first iteration; the state
    without friction then still leads to the solution.
    """
    force = with_components(start.force, system.k)
    headings = [heading, np.zeros_like(heading)] if heading.any() else [heading]
    for known in headings:
        guess = ContactEquations(system, lambda t: starting_guess(t, friction, known), slip)  # noqa: B023  used at once
        x = guess.join(force, start.motion)
        yield snes.solve(guess, x, "first guess of slip", 1, system.tolerance).x
    yield ContactEquations(system, lambda t: coulomb(t, friction), slip).join(force, start.motion)


def with_components(values: Floats, k: int) -> Floats:
    """Local components (n, ≤ k) as (n, k), with zeros for those that they lack."""
    return np.pad(values, ((0, 0), (0, k - values.shape[1])))


def _assumed_contact(system: CondensedSystem, touching: Bools, slip: Floats | None = None) -> Floats:
    """Unknowns x of the linear problem in which the points `touching` (q,) bool are bonded: they may also pull."""

    def law(trial: Floats) -> LawValues:
        return LawValues(np.where(touching[:, None], trial, 0.0), touching[:, None, None] * np.eye(system.k))

    problem = ContactEquations(system, law, slip)
    zero = np.zeros(problem.n * problem.k + problem.r)
    return -problem.solve(zero, problem.residual(zero))


def _converged(problem: ContactEquations, start: Floats, stage: str) -> Equilibrium:
    root = snes.solve(problem, start, stage, ITERATIONS, problem.system.tolerance)
    if not root.converged:
        relative = root.residual / problem.scale(root.x)
        raise NotConverged(
            f"{stage}: residual {relative:.1e} of the load after {root.iterations} iterations; a smaller step may help"
        )
    return _equilibrium(problem, root)


def _equilibrium(problem: ContactEquations, root: snes.Root) -> Equilibrium:
    force, motion = problem.split(root.x)
    at = problem.state(root.x)
    return Equilibrium(force, at.law.traction, motion, at.jump, root.iterations, root.residual)
