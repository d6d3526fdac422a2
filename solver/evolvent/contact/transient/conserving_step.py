"""One time step that keeps the energy of contact without friction (time_schemes/midpoint_step.py).

V(z) is the energy that rest and contact store at modes and rigid motions z, ½ fᵀC_r f + ∫ λ²/2γ less the flux in it;
its gradient is the contact force. A step takes two contact systems: that of the midpoint, whose forces move the bodies,
and that of the end, where z is held, from which V follows. Both are solved again until the stretch is such that the
energy is that of the start, the work, and the damping losses (time_schemes/stretch.py). All have the same pairs; where
surfaces are searched anew V changes with them, and the stretch makes up for that, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import null_space

from evolvent.contact.newton.contact_equations import TOLERANCE, CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium, frictionless, normal_part
from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.problem.definition import Problem, Step
from evolvent.contact.step.displaced_search import solve_with_displaced_search
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.contact.step.step_system import SearchPositions, StepSystem
from evolvent.contact.transient.adaptive_steps import step_error
from evolvent.contact.transient.beginning import Reached
from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.energy import Energy, EnergyBalance, load_work, stored_energy
from evolvent.contact.transient.held_response import HeldResponse
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.one_step import SolvedStep
from evolvent.contact.transient.time_schemes.midpoint_step import MidpointStep
from evolvent.contact.transient.time_schemes.stretch import AIM, try_stretches
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeScheme
from evolvent.fem.body import RigidMotions
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.input_checks import refuse

ROUNDINGS = 100.0
"""Multiple of the contact force by rounded gaps below which a contact force counts as zero."""
UNRESISTED = 1e-10
"""Largest jump by a rigid motion, over that by any, below which contact does not resist the motion."""
MIDPOINT = TimeScheme(1.0)
"""Time scheme that has the error of the midpoint rule without forces."""


class PlacedPairs:
    """The pairs of the surfaces as the bodies are placed, with which each step begins; searched once."""

    def __init__(self) -> None:
        self._last: StepSystem | None = None

    def system(self, problem: Problem, condensed: tuple[CondensedBody, ...], step: Step) -> StepSystem:
        """Contact system with the pairs of `step`; its loads and motions are those of an earlier step."""
        last = self._last
        if last is None or last.problem is not problem or last.step.placements is not step.placements:
            last = self._last = StepSystem(problem, condensed, step)
        return last


def solve_conserving_step(
    problem: Problem, bodies: tuple[MovingBody, ...], before: Reached, step: Step, length: float, pairs: PlacedPairs
) -> SolvedStep:
    """The step of `length` [s] from `before`, with the loads of `step` at its end; in between they go linearly.

    pairs: of the steps before.

    Raises InputError for prescribed motions that move; NotConverged, SearchError, PairingNotSettled,
    SmallStrainExceeded; EnergyNotKept where no stretch was found.
    """
    steps, condensed = StretchedSteps(bodies, before, step, length), tuple(body.condensed for body in bodies)

    def system_of(problem: Problem, search_at: SearchPositions) -> StepSystem:
        if search_at is None:
            return pairs.system(problem, condensed, step)
        return StepSystem(problem, condensed, step, search_at)

    _, solution, deformed = solve_with_displaced_search(system_of, problem, before.deformed, steps.solve)
    end = steps.last
    end.balance.certify(end.energy.total, end.time)
    error = step_error(MIDPOINT, end.motions, end.balance.largest)
    reached = Reached(end.time, length, length, end.motions, deformed, end.balance)
    return SolvedStep(reached, solution, end.energy, error, steps.solved)


@dataclass(frozen=True)
class ContactEquilibrium:
    """Bodies in contact, at the midpoint of a step or at its end."""

    at: StepSystem
    """Contact system of the bodies."""
    system: CondensedSystem
    """Condensed equations of the contact."""
    state: Equilibrium
    """Equilibrium of the contact."""

    @classmethod
    def of(cls, at: StepSystem, pressed: Bools | None) -> ContactEquilibrium:
        """Solves the contact of a system. pressed: (q,) points that are likely to press. Raises NotConverged."""
        system = at.system()
        return cls(at, system, frictionless(normal_part(system), pressed))

    @property
    def forces(self) -> list[Floats]:
        """Contact forces on the functionals of each body, (k,) [N]."""
        force = self.at.nodal_forces(self.state).ravel()
        return [-(E.T @ force) for E in self.at.maps]

    @property
    def motions(self) -> list[Floats]:
        """Amplitudes of the rigid motions of each body (r,)."""
        return self.at.body_motions(self.state)

    @property
    def pressed(self) -> Bools:
        """Whether each point presses, (q,)."""
        return np.asarray(self.state.traction[:, 0] > 0.0)

    @property
    def stored(self) -> float:
        """Energy ∫ λ²/2γ that Nitsche's method stores in the contacts [N·mm; N in 2D]."""
        operator, λ = self.system.operator, self.state.traction[:, 0]
        return stored_energy(operator.weights, λ, operator.stabiliser[:, 0])

    def solution(self, previous: DeformedSurfaces | None) -> tuple[Solution, DeformedSurfaces]:
        """Solution and deformed surfaces at the equilibrium. previous: the deformed surfaces from which the slip is
        measured; None: as placed."""
        return self.at.result(self.system, self.state, self.at.slip(previous))


@dataclass(frozen=True)
class StepEnd:
    """State at the end of a time step with some stretch."""

    time: float
    """Time [s]."""
    motions: tuple[BodyMotion, ...]
    """Motion of each body."""
    contact: ContactEquilibrium
    """Contact of the bodies at the end."""
    iterations: int
    """Newton iterations at the midpoint and at the end."""
    energy: Energy
    """Energy of all bodies."""
    balance: EnergyBalance
    """Energy balance since the start."""

    @property
    def excess(self) -> float:
        """Energy in excess of the balance, over the largest energy."""
        return self.balance.left(self.energy.total) / self.balance.largest if self.balance.largest else 0.0


class StretchedSteps:
    """A time step with any stretch; `solved` counts contact systems, `last` is the end that was found last."""

    def __init__(self, bodies: tuple[MovingBody, ...], before: Reached, step: Step, length: float) -> None:
        self.bodies, self.before, self.step, self.length = bodies, before, step, length
        nothing = [np.zeros_like(motion.state.position) for motion in before.motions]
        self.after = [
            MovingResponse.of(body, index, step, MidpointStep(body.system, motion.state, length, 1.0, e))
            for index, (body, motion, e) in enumerate(zip(bodies, before.motions, nothing))
        ]
        self.between = [_halfway(index, *each) for index, each in enumerate(zip(before.motions, self.after))]
        self.solved = 0
        self.last: StepEnd
        self.pressed: tuple[Bools | None, Bools | None] = None, None

    def solve(self, system: StepSystem, previous: DeformedSurfaces | None) -> tuple[Solution, DeformedSurfaces]:
        """The contact at the end at which the energy is kept, or nearly, where no stretch does better; the iterations
        are those of all systems.

        system: has the pairs. previous: see `StepSystem.solve`. Raises NotConverged.
        """
        self.pressed = None, None  # in the pairs of this system
        ends = {0.0: self._ended(system, 1.0, [motion.state.position * 0.0 for motion in self.before.motions])}
        if abs(ends[0.0].excess) > AIM:
            self._stretch(system, ends)
        self.last = min(ends.values(), key=lambda end: abs(end.excess))
        solution, deformed = self.last.contact.solution(previous)
        return replace(solution, iterations=sum(end.iterations for end in ends.values())), deformed

    def _stretch(self, system: StepSystem, ends: dict[float, StepEnd]) -> None:
        """Adds ends at other ln s to that at 0, until the energy is kept, or no s is left."""
        first = ends[0.0]
        moved = [now.state.position - then.state.position for now, then in zip(first.motions, self.before.motions)]
        unstretched = _unresisted(system, self.bodies, moved)
        stretched = [d - e for d, e in zip(moved, unstretched)]
        power = sum(float(d @ body.system.mass @ d) for d, body in zip(stretched, self.bodies))

        def excess(x: float) -> float:
            if x not in ends:
                ends[x] = self._ended(system, float(np.exp(x)), unstretched)
            return 0.0 if abs(ends[x].excess) <= AIM else ends[x].excess

        if slope := 2.0 * power / self.length**2 / first.balance.largest:
            try_stretches(excess, first.excess, slope)

    def _ended(self, system: StepSystem, stretch: float, unstretched: Sequence[Floats]) -> StepEnd:
        """State at the end of the step with one stretch."""
        steps = [
            MidpointStep(each.body.system, each.step.state, self.length, stretch, e)
            for each, e in zip(self.between, unstretched)
        ]
        between = [replace(each, step=step) for each, step in zip(self.between, steps)]
        scale = ROUNDINGS * _rounded_force(system) / TOLERANCE
        loaded = [_loaded(each) for each in between]
        middle = ContactEquilibrium.of(system.answering(self.step, between, loaded, scale), self.pressed[0])
        states = [each.state(*pushed) for each, *pushed in zip(between, middle.forces, middle.motions)]
        ends = [(each.body, each, state.position) for each, state in zip(self.after, states)]
        held = [HeldResponse(body, z[: body.count], each.factor, each.resultant) for body, each, z in ends]
        motions = [_held(body, z[body.count :]) for body, _, z in ends]
        likely = middle.pressed if self.pressed[1] is None else self.pressed[1]
        contact = ContactEquilibrium.of(system.answering(self.step, held, motions, scale), likely)
        self.pressed = middle.pressed, contact.pressed
        self.solved += 2
        damped = sum(step.damped(state) for step, state in zip(steps, states))
        return self._end(states, contact, damped, middle.state.iterations + contact.state.iterations)

    def _end(
        self, states: list[KinematicState], contact: ContactEquilibrium, damped: float, iterations: int
    ) -> StepEnd:
        """State at the end of the step from the states of the bodies, after damping has dissipated `damped` [N·mm]."""
        motions = tuple(
            BodyMotion(state, np.zeros_like(state.position), response, forces)
            for state, response, forces in zip(states, self.after, contact.forces)
        )
        energy = Energy.of(motions, contact.stored)
        work = sum(load_work(*each) for each in zip(self.before.motions, motions))
        balance = self.before.balance.after(energy.total, work, -damped)
        return StepEnd(self.before.time + self.length, motions, contact, iterations, energy, balance)


def _halfway(index: int, before: BodyMotion, after: MovingResponse) -> MovingResponse:
    """Response of a body at the midpoint of a step, under the mean of the loads at both ends. Raises InputError for
    prescribed motions that are not at rest."""
    held, position = after.held, before.state.position
    rest = after.prescribed[~np.isnan(after.prescribed)]
    if not np.array_equal(position[held], rest):
        refuse(
            f"transient, step: prescribed motions of body {index}", "ones at rest, as conserving = True",
            rest.tolist(), "leave out conserving, or move the body by a load",
        )
    factor = 0.5 * (before.response.factor + after.factor)
    return replace(after, factor=factor, resultant=0.5 * (before.response.resultant + after.resultant))


def _loaded(response: MovingResponse) -> RigidMotions:
    """Rigid motions of a body under the loads of a response."""
    load = np.full(len(response.prescribed), np.nan)
    load[response.body.free] = response.resultant
    return RigidMotions(response.body.condensed.assembled.motions.shapes, load, response.prescribed)


def _held(body: MovingBody, motion: Floats) -> RigidMotions:
    """Rigid motions of a body, all prescribed with amplitudes (r,)."""
    return RigidMotions(body.condensed.assembled.motions.shapes, np.full(len(motion), np.nan), motion)


def _rounded_force(system: StepSystem) -> float:
    """Contact force by the rounding of gaps [N]: held bodies have no load with which to compare it."""
    stiffness = sum(float(op.weights @ op.stabiliser[:, 0]) for op in system.operators)
    return float(np.finfo(float).eps) * stiffness * max(np.abs(op.points).max(initial=0.0) for op in system.operators)


def _unresisted(system: StepSystem, bodies: Sequence[MovingBody], moved: Sequence[Floats]) -> list[Floats]:
    """The part of motions (m + r,) of each body along free rigid motions that change no gap, orthogonal in the mass to
    the rest of them."""
    free = [body.count + body.free for body in bodies]
    jumps = np.hstack([
        (E @ body.condensed.motion_shapes[:, body.free])[:: system.d] for E, body in zip(system.maps, bodies)
    ])
    lever = np.abs(jumps).max(axis=0, initial=0.0)
    lever[lever == 0.0] = 1.0
    modes = null_space(jumps / lever, rcond=UNRESISTED) / lever[:, None] if jumps.size else np.eye(jumps.shape[1])
    ends = np.cumsum([len(each) for each in free])[:-1]
    parts = np.split(modes, ends)
    mass = [body.system.mass[np.ix_(each, each)] for body, each in zip(bodies, free)]
    weight = sum(N.T @ m @ N for N, m in zip(parts, mass))
    push = sum(N.T @ m @ d[each] for N, m, d, each in zip(parts, mass, moved, free))
    amplitudes = np.linalg.solve(weight, push)
    result = [np.zeros_like(d) for d in moved]
    for e, each, N in zip(result, free, parts):
        e[each] = N @ amplitudes
    return result
