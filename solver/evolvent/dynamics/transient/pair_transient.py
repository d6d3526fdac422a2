"""A gear pair over time at constant nominal speed, from one position of a mesh period to the next, in one time step or
in equal parts of it (divided_steps.py).

Positions and parts repeat with the mesh, so that search, compliance and modes of each are kept and used again: from the
second mesh period on a step is the solution of its contact system alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, reduce

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, frictionless, normal_part
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeScheme, TimeStep
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.certificates import WITHIN, certify_step
from evolvent.dynamics.transient.divided_steps import UNDIVIDED, DividedSteps, StepsTaken, part
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.nodal_sums import NodalSums
from evolvent.dynamics.transient.pair_state import PairState, SolvedStep
from evolvent.dynamics.transient.pair_step import PairStep, SearchedContact
from evolvent.dynamics.transient.step_balance import Residuals, StepBalance, StepEnergies, stored_energy
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.friction_history import FrictionHistory, PreviousJump
from evolvent.gears.sweep.frictional_position import frictional_equilibrium
from evolvent.gears.sweep.position_result import PositionResult, position_result
from evolvent_meshes.errors import ResultError

NO_STIFFNESS = float("nan")
"""A moving pair's positions have no tangent stiffness."""


@dataclass(frozen=True)
class PairMoment:
    """Result of a pair at a position, and of the time steps from the position before."""

    time: float
    """Time since the start [s]."""
    result: PositionResult
    """The position, with teeth numbered as in a pitch from rotation 0 on."""
    mesh_force: float
    """Torque of the contact on ψ over its lever [N; N/mm in 2D]."""
    rate: float
    """Rate of the transmission error [mm/s]."""
    residuals: Residuals
    """Largest residuals of the balances of the time steps from the position before."""
    energies: StepEnergies
    """Energies of the time steps from the position before, together."""
    steps: StepsTaken
    """Number, lengths, errors and mesh forces of the time steps from the position before."""


@dataclass(frozen=True)
class MovingMoment(PairMoment):
    """Result at a position, with the state from which the motion continues."""

    state: PairState
    """State at the start of the next time step."""


@dataclass(frozen=True)
class PairTransient:
    """Time integration of a gear pair at constant nominal speed."""

    pair: MovingPair
    """Gear pair with its inertia."""
    friction: float
    """Friction coefficient μ."""
    speed: MeshSpeed
    """Speed of the pinion."""
    scheme: TimeScheme
    """Scheme of the time steps."""
    contacts: KeptContacts
    """Searched contacts at the positions of a mesh period, and at the ends of steps between them."""
    division: DividedSteps = UNDIVIDED
    """Rules that divide the interval between two positions into time steps."""

    @property
    def name(self) -> str:
        """Speed and friction, for messages."""
        return f"{self.speed.rpm:g} r/min, μ = {self.friction:g}"

    @property
    def time_step(self) -> float:
        """Time from one position to the next, the longest time step [s]."""
        return self.contacts.step_angle / self.speed.rad_s

    def run(self, state: PairState, periods: int) -> Iterator[MovingMoment]:
        """The positions of so many mesh periods, from a state at pinion rotation 0, each time step in balance. Raises
        NotConverged, SearchError, Unbalanced."""
        count = self.contacts.positions
        for n in range(1, periods * count + 1):
            if n % count == 0:
                state = self._earlier(state)
            moment = self._advanced(state, n)
            state = moment.state
            yield moment

    def _earlier(self, state: PairState) -> PairState:
        """State with the teeth renumbered by one pitch, so that the next position is at rotation 0 again."""
        m, pair = state.motion, self.pair
        motion = KinematicState(*(pair.earlier(each, 1) for each in (m.position, m.velocity, m.acceleration)))
        history = None if state.history is None else state.history.earlier(1)
        before = None if state.before is None else state.before.earlier(pair)
        return replace(state, motion=motion, history=history, vibration=pair.earlier(state.vibration, 1), before=before)

    def _advanced(self, state: PairState, n: int) -> MovingMoment:
        """Result at position n since the start, from the state at the one before. Raises NotConverged, SearchError,
        Unbalanced."""
        is_first, reached, steps = state.before is None, n - 1.0, []
        while reached < n:
            solved, rejected = self._accepted(state, n, reached)
            reached += part(solved.halvings)
            moment = self._moment(solved, reached, rejected)
            certify_step(moment.residuals, state.before is None, self._where(n, reached), WITHIN)
            state = moment.state
            steps.append(moment)
        moment = _joined(steps)
        certify_step(moment.residuals, is_first, self._where(n, reached))
        return moment

    def _where(self, n: int, reached: float) -> str:
        """Speed, friction and pinion rotation on the way to position n, for messages."""
        degrees = np.degrees(self._phase(n, reached) * self.contacts.step_angle)
        return f"{self.name}, pinion at {degrees:.3f}°"

    def _phase(self, n: int, reached: float) -> float:
        """Place in the mesh period on the way to position n, in positions. reached: positions since the start."""
        return n % self.contacts.positions + (reached - n)

    def _accepted(self, state: PairState, n: int, reached: float) -> tuple[SolvedStep, int]:
        """The next time step, repeated at half its length until it is accepted, and the number of rejected ones. Raises
        NotConverged, SearchError."""
        halvings = state.halvings
        while True:
            try:
                solved = self._solved(state, n, reached, halvings)
                if self.division.accepts(halvings, solved.error):
                    return solved, halvings - state.halvings
            except ResultError:
                if not self.division.can_halve(halvings):
                    raise
            halvings += 1

    def _solved(self, state: PairState, n: int, reached: float, halvings: int) -> SolvedStep:
        """A time step of this length. Raises NotConverged, SearchError."""
        way = part(halvings)
        begin, length = state.for_step(self.pair, self.scheme, way * self.time_step), way * self.time_step
        predicted = float(begin.motion.position[-1] + length * begin.motion.velocity[-1])
        span, phase = way * self.contacts.step_angle, self._phase(n, reached + way)
        jump_before = lru_cache(1)(lambda at: begin.previous_jump(self.pair, at.contact.geometry))

        def ended(touching: bool) -> SolvedStep:
            system = self.pair.system if touching else self.pair.system_apart
            step = PairStep(self.pair, TimeStep(system, self.scheme, begin.motion, length))

            def solve(at: SearchedContact) -> Equilibrium:
                flying = step.in_flight(at, 1 if begin.history is None else at.k)
                return flying or self._equilibrium(step, at, begin.patch, jump_before(at), span)

            at, found = self.contacts.solved(phase, predicted, solve)
            stored = stored_energy(self.pair, at, found)
            return SolvedStep(step, begin, halvings, at, found, step.state(at, found), stored, jump_before(at))

        return self._damped_in_contact(begin.mesh_force != 0.0, ended)

    def _damped_in_contact(self, guess: bool, ended: Callable[[bool], SolvedStep]) -> SolvedStep:
        """The end of a step at which the damping of the mesh acts if flanks touch there, and only then; ended: with
        this damping or without. Where flanks that would touch without are kept apart by the damping alone, they touch
        without it."""
        first = ended(guess)
        if self.pair.damping_in_separation or first.touches is guess:
            return first
        other = ended(not guess)
        return other if guess or other.touches else first

    def _equilibrium(
        self, step: PairStep, at: SearchedContact, patch: ContactPatch | None, before: PreviousJump | None, span: float
    ) -> Equilibrium:
        """Equilibrium of the contact at the end of a step in which the pinion turns by `span` [rad]. patch: of the last
        contact; before: friction history at this one. Raises NotConverged."""
        system, geometry = step.system(at), at.contact.geometry
        start = None if patch is None else patch.at(geometry)
        smooth = frictionless(normal_part(system), start if start is not None and start.any() else None)
        if before is None:
            return smooth
        rough = frictional_equilibrium(geometry, system, self.friction, smooth, before, span)
        return replace(rough, iterations=smooth.iterations + rough.iterations)

    def _moment(self, solved: SolvedStep, reached: float, rejected: int) -> MovingMoment:
        """Result at the end of an accepted time step. reached: positions since the start."""
        pair, at, found, motion, before = self.pair, solved.at, solved.found, solved.motion, solved.begin.before
        stand = replace(at.contact.stand, beyond_nominal=pair.drive.rotations(float(motion.position[-1])))
        result = replace(
            position_result(pair.model, at.contact, found, self.friction, NO_STIFFNESS, 0), stand=stand
        )
        sums, span = NodalSums.of(pair, at.contact.stand, result), part(solved.halvings) * self.contacts.step_angle
        balance = StepBalance(solved.step, span, motion, result, sums, solved.stored, solved.slip_work)
        turned = at.turned.reshape(found.force.shape[0], at.k)[:, : found.force.shape[1]]
        force, length = float(np.sum(turned * found.force)) / pair.lever, solved.step.step.length
        state = PairState(
            motion, self._history(at, found, stand), motion.position[:-1] - pair.static(sums.modal),
            _patch(at, found), balance.end, length, self._following(solved, reached, rejected), force, solved.energy,
        )
        impulse = 0.5 * length * (force + (force if solved.begin.mesh_force is None else solved.begin.mesh_force))
        steps = StepsTaken(1, rejected, length, solved.error, impulse, force, result.transmission_error)
        return MovingMoment(
            reached * self.time_step, result, force, float(motion.velocity[-1]) * pair.lever,
            balance.residuals(before), balance.energies(before), steps, state,
        )

    def _following(self, solved: SolvedStep, reached: float, rejected: int) -> int:
        """Halvings of the step after an accepted one."""
        k = solved.halvings
        return k if rejected else self.division.after(k, solved.error, reached)

    def _history(self, at: SearchedContact, found: Equilibrium, stand: PairRotation) -> FrictionHistory | None:
        if not self.friction:
            return None
        return replace(FrictionHistory.of(self.pair.model, at.contact, found), stand=stand)


def _joined(steps: Sequence[MovingMoment]) -> MovingMoment:
    """Result of the last of several time steps, with the balances and energies of all."""
    last = steps[-1]
    if len(steps) == 1:
        return last
    worst = reduce(Residuals.larger, (step.residuals for step in steps))
    energies = StepEnergies.summed(step.energies for step in steps)
    worst = replace(worst, exchange=abs(energies.left) / energies.passed)
    return replace(last, residuals=worst, energies=energies, steps=StepsTaken.joined(step.steps for step in steps))


def _patch(at: SearchedContact, found: Equilibrium) -> ContactPatch | None:
    pressed = found.traction[:, 0]
    return ContactPatch.of(at.contact.geometry, pressed) if pressed.any() else None
