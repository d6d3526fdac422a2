"""Equilibrium of a condensed contact system: SNES on the nodal contact forces and the free rigid motions.

Unknowns x = (f, δ), f (n, k) nodal contact forces in local frames, k = 1 without friction, else d:

    f − F(J) = 0,   J = J_0 + H δ − A f              (contact)
    Hᵀ f = F                                         (balance of the free rigid motions)

The bodies are eliminated exactly (A is their compliance), so that this is the finite element system itself. The
tangent is in tangent.py, its inverse in newton_steps.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.newton import snes
from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.newton.newton_steps import NewtonSteps
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.contact_operator import ContactLaw, ContactOperator
from evolvent.contact.nitsche.coulomb import LawValues, coulomb, starting_guess
from evolvent_meshes.arrays import Bools, Floats

TOLERANCE = 1e-10  # residual force over the force in the system
ITERATIONS = 60
QUADRATIC = 30.0  # lower bound of a relative residual over the square of the one before (200 to 1000 were observed)
ROUGHEST, FINEST = 1e-3, 1e-7  # limits of the accuracy to which a Newton step is solved
LAST_STEP = 1e-2  # of the tolerance: residual that the linear solve of the last step may leave
GUESS_ITERATIONS = 10  # after which a start from a given guess is abandoned


@dataclass(frozen=True)
class CondensedSystem:
    """The bodies of a contact problem in the local jumps of its contacts, k components a node.

    operator: contact at q points, jumps at n nodes.
    compliance: A (n·k, n·k).
    motion: H (n·k, r), jumps by unit amplitudes of the r free rigid motions.
    jump: J_0 (n·k,), jumps by external loads and prescribed motions [mm].
    load: F (r,), loads on the free rigid motions [N, N·mm].
    lever: (r,) largest jump by a unit amplitude of each motion [mm per unit], to compare forces with moments.
    """

    operator: ContactOperator
    compliance: JumpCompliance
    motion: Floats
    jump: Floats
    load: Floats
    lever: Floats

    @cached_property
    def steps(self) -> NewtonSteps:
        """Solver of the Newton steps; all friction coefficients share it."""
        return NewtonSteps(self.compliance, self.motion / self.lever)

    @property
    def k(self) -> int:
        """Number of local components a node: 1 (normal) or d."""
        return len(self.jump) // len(self.operator.nodes)

    def jumps(self, force: Floats, motion: Floats) -> Floats:
        """J (n, k) [mm] from nodal forces (n, k) [N] and amplitudes of the motions (r,)."""
        return (self.jump + self.motion @ motion - self.compliance.times(force.ravel())).reshape(-1, self.k)

    @property
    def scale(self) -> float:
        """The force [N] that residuals are compared with."""
        return float(np.abs(self.load / self.lever).max(initial=0.0))


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


def normal_part(system: CondensedSystem) -> CondensedSystem:
    """The frictionless system: normal components only. A system that has no others is returned as it is."""
    k = system.k
    if k == 1:
        return system
    A = system.compliance.normal()
    return CondensedSystem(system.operator, A, system.motion[::k], system.jump[::k], system.load, system.lever)


def frictionless(system: CondensedSystem, start: Bools | None = None) -> Equilibrium:
    """Equilibrium without friction, of a system with k = 1.

    start: (q,) bool, points assumed in contact in the first, linear, solve; by default all. Raises NotConverged.
    """
    touching = np.ones(len(system.operator.weights), dtype=bool) if start is None else start
    problem = ContactEquations(system, lambda t: coulomb(t, 0.0))
    return _converged(problem, _assumed_contact(system, touching), "contact without friction")


def stuck(system: CondensedSystem, slip: Floats) -> Equilibrium:
    """The state in which all points in contact stick, however large the traction; a start for `frictional`.

    It is the only start if friction alone carries a load. slip: as in `frictional`. The state is only approximately in
    equilibrium: at the edge, where sticking traction is singular, a point may open and close without end. Raises
    NotConverged where the tangent is singular.
    """
    law = ContactEquations(system, lambda t: starting_guess(t, 0.0, np.zeros((len(t), system.k - 1))), slip)
    every = np.ones(len(system.operator.weights), dtype=bool)
    start = _assumed_contact(system, every, slip)
    return _equilibrium(law, snes.solve(law, start, "contact without slip", ITERATIONS // 2, TOLERANCE))


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
) -> Equilibrium:  # fmt: skip
    """Equilibrium with Coulomb friction.

    friction: coefficient μ, a number or (q,).
    slip: (n, d−1) slip since the last state, without that of the current displacement [mm].
    heading: (q, d−1) unit direction of slip where it is known, else zero.
    start: the equilibrium without friction, or `stuck`.
    near: a guess of the solution, tried first.
    Raises NotConverged.
    """
    law = ContactEquations(system, lambda t: coulomb(t, friction), slip)
    if near is not None:
        try:
            root = snes.solve(law, law.join(near.force, near.motion), "Coulomb friction", GUESS_ITERATIONS, TOLERANCE)
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
        yield snes.solve(guess, x, "first guess of slip", 1, TOLERANCE).x
    yield ContactEquations(system, lambda t: coulomb(t, friction), slip).join(force, start.motion)


def with_components(values: Floats, k: int) -> Floats:
    """Local components (n, ≤ k) as (n, k), with zeros for those that they lack."""
    return np.pad(values, ((0, 0), (0, k - values.shape[1])))


class ContactEquations:
    """Residual and tangent of the contact system (a `NonlinearProblem`), over x = (f, δ·lever)."""

    def __init__(self, system: CondensedSystem, law: ContactLaw, slip: Floats | None = None) -> None:
        self.system, self.law, self.slip = system, law, slip
        self.n, self.k, self.r = len(system.operator.nodes), system.k, len(system.load)
        self._last: tuple[Floats, tuple[Floats, Floats, LawValues]] | None = None

    def split(self, x: Floats) -> tuple[Floats, Floats]:
        """f (n, k) [N] and δ (r,) of x; x has δ times the lever, so that all residuals are forces."""
        return x[: self.n * self.k].reshape(self.n, self.k), x[self.n * self.k :] / self.system.lever

    def join(self, force: Floats, motion: Floats) -> Floats:
        """x of f (n, k) and δ (r,)."""
        return np.concatenate([force.ravel(), motion * self.system.lever])

    def scale(self, x: Floats) -> float:
        """Force with which the residual is compared: load or normal contact force, whichever is larger [N]."""
        return max(self.system.scale, float(np.abs(self.split(x)[0][:, 0]).sum()))

    def state(self, x: Floats) -> tuple[Floats, Floats, LawValues]:
        """Forces, jumps and the law's values at x; stored, since residual and tangent are needed at the same x."""
        if self._last is None or not np.array_equal(self._last[0], x):
            force, motion = self.split(x)
            jump = self.system.jumps(force, motion)
            self._last = x.copy(), (force.copy(), jump, self.law(self.system.operator.trial(jump, self.slip)))
        return self._last[1]

    def residual(self, x: Floats) -> Floats:
        """f − F(J), then Hᵀ f − F over the lever, (n·k + r,) [N]."""
        force, _, law = self.state(x)
        contact = force - self.system.operator.forces(law.traction)
        balance = (self.system.motion.T @ force.ravel() - self.system.load) / self.system.lever
        return np.concatenate([contact.ravel(), balance])

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """See `NonlinearProblem.work`. The energy ½fᵀAf + ∫(contact) − Fᵀδ of bodies under any nodal forces f has the
        derivatives A(f − F(J)) and Hᵀ F(J) − F."""
        system, (df, dδ) = self.system, self.split(step)
        f, jump, _ = self.state(x)
        change = jump - self.state(x - step)[1]  # stored: the next state if the full step is taken
        elastic = (system.motion @ dδ).reshape(change.shape) - change  # A df

        def along(α: float) -> float:
            contact = system.operator.forces(self.law(system.operator.trial(jump - α * change, self.slip)).traction)
            balance = system.motion.T @ contact.ravel() - system.load
            return -float(np.sum(elastic * (f - α * df - contact)) + dδ @ balance)

        return along

    def solve(self, x: Floats, right: Floats) -> Floats:
        """T(x)⁻¹ right, as accurate as this Newton step needs."""
        accuracy = _accuracy(float(np.linalg.norm(right)), self.scale(x))
        return self.system.steps.solve(self.tangent(x), right, accuracy)

    def tangent(self, x: Floats) -> Tangent:
        """T(x)."""
        steps = self.system.steps
        return Tangent.of(self.system.operator, self.state(x)[2], steps.A, steps.H)


def _accuracy(residual: float, scale: float) -> float:
    """Fraction of the residual to which a Newton step's equations are solved: well below the residual that the
    nonlinearity of the contact law leaves anyway, and no further below the tolerance than results show."""
    relative = residual / scale if scale > 0.0 else 1.0
    roughest = ROUGHEST / max(relative, 1.0)  # of the load too: a start from the right points is not to be lost
    return max(min(QUADRATIC * relative, roughest), LAST_STEP * TOLERANCE / max(relative, TOLERANCE), FINEST)


def _assumed_contact(system: CondensedSystem, touching: Bools, slip: Floats | None = None) -> Floats:
    """x of the linear problem in which the points `touching` (q,) bool are bonded: they may also pull."""

    def law(trial: Floats) -> LawValues:
        return LawValues(np.where(touching[:, None], trial, 0.0), touching[:, None, None] * np.eye(system.k))

    problem = ContactEquations(system, law, slip)
    zero = np.zeros(problem.n * problem.k + problem.r)
    return -problem.solve(zero, problem.residual(zero))


def _converged(problem: ContactEquations, start: Floats, stage: str) -> Equilibrium:
    root = snes.solve(problem, start, stage, ITERATIONS, TOLERANCE)
    if not root.converged:
        relative = root.residual / problem.scale(root.x)
        raise NotConverged(
            f"{stage}: residual {relative:.1e} of the load after {root.iterations} iterations; a smaller step may help"
        )
    return _equilibrium(problem, root)


def _equilibrium(problem: ContactEquations, root: snes.Root) -> Equilibrium:
    force, motion = problem.split(root.x)
    _, jump, law = problem.state(root.x)
    return Equilibrium(force, law.traction, motion, jump, root.iterations, root.residual)
