"""Equilibrium at one position: SNES on the nodal contact forces and the free rigid motions.

Unknowns x = (f, δ), f (n, k) nodal contact forces in local frames, k = 1 without friction, else d:

    f − F(J) = 0,   J = J_0 + H δ − A f          (contact)
    Hᵀ f = F                                         (balance of the free rigid motions)

The bodies are eliminated exactly (A is their compliance), so this is the finite element system and not a model of it.
The tangent is in tangent.py, its inverse in newton_steps.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.newton import snes
from evolvent.contact.newton.newton_steps import NewtonSteps
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.contact_operator import ContactOperator, LawOf
from evolvent.contact.nitsche.coulomb import Law, coulomb, starting_guess
from evolvent_meshes.arrays import Floats

TOLERANCE = 1e-10  # residual force over the force in the system
ITERATIONS = 60
BEND = 30.0  # residual after an exact Newton step over the square of the one before (200 to 1000 were seen), with room
ROUGH, FINEST = 1e-2, 1e-7  # accuracies of a step at most and at least asked for
SPARE = 1e-2  # of the tolerance may be left of the last step's own residual
PATIENCE = 10  # iterations that a start from a neighbouring solution is given


@dataclass(frozen=True)
class CondensedSystem:
    """What a position's equilibrium needs of the bodies.

    operator: contact at q points, jumps at n nodes. compliance: A (n·k, n·k) [mm/N]. motion: H (n·k, r), free rigid
    motions. jump: J_0 (n·k,) jumps of the external loads and prescribed motions [mm]. load: F (r,) [N, N·mm].
    lever: (r,) what one unit of each motion moves the contact [mm per unit], to compare forces with moments.
    """

    operator: ContactOperator
    compliance: Floats
    motion: Floats
    jump: Floats
    load: Floats
    lever: Floats

    @cached_property
    def steps(self) -> NewtonSteps:
        """Newton steps of all friction coefficients, which share much."""
        return NewtonSteps(self.compliance, self.motion / self.lever)

    @property
    def k(self) -> int:
        """Local components a node: 1 (normal) or d."""
        return len(self.jump) // len(self.operator.nodes)

    def jumps(self, force: Floats, motion: Floats) -> Floats:
        """J (n, k) from forces (n, k) and motions (r,)."""
        return (self.jump + self.motion @ motion - self.compliance @ force.ravel()).reshape(-1, self.k)

    @property
    def scale(self) -> float:
        """The force [N] that residuals are compared with."""
        return float(np.abs(self.load / self.lever).max(initial=0.0))


@dataclass(frozen=True)
class Equilibrium:
    """A converged state: nodal forces f (n, k) [N] and tractions at the points (q, k) [MPa] in local frames, motions δ
    (r,), jumps (n, k)
    [mm]; Newton iterations and the residual [N] that was left."""

    force: Floats
    traction: Floats
    motion: Floats
    jump: Floats
    iterations: int
    residual: float


@dataclass(frozen=True)
class Start:
    """Where Newton's method starts: forces (n, k) [N] and motions (r,)."""

    force: Floats
    motion: Floats


def normal_part(system: CondensedSystem) -> CondensedSystem:
    """The frictionless system: normal components only; the system itself where it has no others."""
    k = system.k
    if k == 1:
        return system
    A = np.ascontiguousarray(system.compliance[::k, ::k])  # BLAS takes no product with every third column
    return CondensedSystem(system.operator, A, system.motion[::k], system.jump[::k], system.load, system.lever)


def frictionless(system: CondensedSystem, start: np.ndarray | None = None) -> Equilibrium:
    """Equilibrium without friction, of a system with k = 1.

    start: (q,) bool, the points assumed in contact for the first, linear, solve; by default all. Raises NotConverged.
    """
    chosen = np.ones(len(system.operator.weights), dtype=bool) if start is None else start
    problem = _Contact(system, lambda t: coulomb(t, 0.0))
    return _converged(problem, _assumed_contact(system, chosen), "contact without friction")


def stuck(system: CondensedSystem, slip: Floats) -> Equilibrium:
    """The state in which whatever touches sticks, however large the traction: a start for `frictional`, and the only
    one where friction alone carries a load. slip: as there. It is only nearly in equilibrium: at the edge, where stuck
    traction is singular, a point may open and close for ever. Raises NotConverged where it is singular."""
    law = _Contact(system, lambda t: starting_guess(t, 0.0, np.zeros((len(t), system.k - 1))), slip)
    every = np.ones(len(system.operator.weights), dtype=bool)
    start = _assumed_contact(system, every, slip)
    return _equilibrium(law, snes.solve(law, start, "contact without slip", ITERATIONS // 2, TOLERANCE))


def frictional(
    system: CondensedSystem, friction: Floats | float, slip: Floats, heading: Floats, start: Equilibrium,
    near: Start | None = None,
) -> Equilibrium:  # fmt: skip
    """Equilibrium with Coulomb friction.

    friction: a number or (q,). slip: (n, d−1) what slipped since the last state apart from the present displacement
    [mm]; heading: (q, d−1) the known direction of slip, or zero; start: the equilibrium without friction, or `stuck`.
    near: a guess of the solution, tried first. Raises NotConverged.
    """
    law = _Contact(system, lambda t: coulomb(t, friction), slip)
    if near is not None:
        try:
            root = snes.solve(law, law.join(near.force, near.motion), "Coulomb friction", PATIENCE, TOLERANCE)
        except NotConverged:  # the guess led out of contact altogether
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
    """Where to start from, the best x first. The state without friction is the last: where all is taken for stuck that
    has slipped a hundred times what the flanks can follow (near the pitch point of a coarse sweep), tractions of a
    hundred times the load tear them apart in the first iteration."""
    force = np.zeros((len(system.operator.nodes), system.k))
    force[:, : start.force.shape[1]] = start.force
    headings = [heading, np.zeros_like(heading)] if heading.any() else [heading]
    for known in headings:
        guess = _Contact(system, lambda t: starting_guess(t, friction, known), slip)  # noqa: B023  used at once
        x = guess.join(force, start.motion)
        yield snes.solve(guess, x, "first guess of slip", 1, TOLERANCE).x
    yield _Contact(system, lambda t: coulomb(t, friction), slip).join(force, start.motion)


class _Contact:
    """Residual and tangent of the contact system."""

    def __init__(self, system: CondensedSystem, law: LawOf, slip: Floats | None = None) -> None:
        self.system, self.law, self.slip = system, law, slip
        self.n, self.k, self.r = len(system.operator.nodes), system.k, len(system.load)
        self._last: tuple[Floats, tuple[Floats, Floats, Law]] | None = None

    def split(self, x: Floats) -> tuple[Floats, Floats]:
        """(f, δ) of x; δ is scaled by the lever so that all residuals are forces."""
        return x[: self.n * self.k].reshape(self.n, self.k), x[self.n * self.k :] / self.system.lever

    def join(self, force: Floats, motion: Floats) -> Floats:
        return np.concatenate([force.ravel(), motion * self.system.lever])

    def scale(self, x: Floats) -> float:
        return max(self.system.scale, float(np.abs(self.split(x)[0][:, 0]).sum()))

    def state(self, x: Floats) -> tuple[Floats, Floats, Law]:
        """Forces, jumps and the law there; kept, as a step asks for the residual and the tangent at the same x."""
        if self._last is None or not np.array_equal(self._last[0], x):
            force, motion = self.split(x)
            jump = self.system.jumps(force, motion)
            self._last = x.copy(), (force.copy(), jump, self.law(self.system.operator.trial(jump, self.slip)))
        return self._last[1]

    def residual(self, x: Floats) -> Floats:
        force, _, law = self.state(x)
        contact = force - self.system.operator.forces(law.traction)
        balance = (self.system.motion.T @ force.ravel() - self.system.load) / self.system.lever
        return np.concatenate([contact.ravel(), balance])

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """See `newton.Nonlinear.work`. With the bodies under nodal forces f, whatever these are, the energy
        ½fᵀAf + ∫(contact) − Fᵀδ has the slopes A(f − F(J)) and Hᵀ F(J) − load."""
        system, (df, dδ) = self.system, self.split(step)
        f, jump, _ = self.state(x)
        change = jump - self.state(x - step)[1]  # kept: it is the next state where the step is taken whole
        given = (system.motion @ dδ).reshape(change.shape) - change  # A df

        def along(α: float) -> float:
            contact = system.operator.forces(self.law(system.operator.trial(jump - α * change, self.slip)).traction)
            moved = system.motion.T @ contact.ravel() - system.load
            return -float(np.sum(given * (f - α * df - contact)) + dδ @ moved)

        return along

    def solve(self, x: Floats, right: Floats) -> Floats:
        accuracy = _accuracy(float(np.linalg.norm(right)), self.scale(x))
        return self.system.steps.solve(self.tangent(x), right, accuracy)

    def tangent(self, x: Floats) -> Tangent:
        steps = self.system.steps
        return Tangent.of(self.system.operator, self.state(x)[2], steps.A, steps.H)


def _accuracy(residual: float, scale: float) -> float:
    """To which share of the residual a Newton step's equations are solved: well below what the bend of the contact law
    leaves anyway, and not further below the tolerance than results show."""
    share = residual / scale if scale > 0.0 else 1.0
    return max(min(BEND * share, ROUGH), SPARE * TOLERANCE / max(share, TOLERANCE), FINEST)


def _assumed_contact(system: CondensedSystem, chosen: np.ndarray, slip: Floats | None = None) -> Floats:
    """x of the linear problem in which the chosen points touch (and may pull)."""

    def law(trial: Floats) -> Law:
        return Law(np.where(chosen[:, None], trial, 0.0), chosen[:, None, None] * np.eye(system.k))

    problem = _Contact(system, law, slip)
    zero = np.zeros(problem.n * problem.k + problem.r)
    return -problem.solve(zero, problem.residual(zero))


def _converged(problem: _Contact, start: Floats, stage: str) -> Equilibrium:
    root = snes.solve(problem, start, stage, ITERATIONS, TOLERANCE)
    if not root.converged:
        left = root.residual / problem.scale(root.x)
        raise NotConverged(
            f"{stage}: residual {left:.1e} of the load after {root.iterations} iterations; a smaller step may help"
        )
    return _equilibrium(problem, root)


def _equilibrium(problem: _Contact, root: snes.Root) -> Equilibrium:
    force, motion = problem.split(root.x)
    _, jump, law = problem.state(root.x)
    return Equilibrium(force, law.traction, motion, jump, root.iterations, root.residual)
