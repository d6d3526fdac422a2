"""A gear pair over time at constant nominal speed, in equal steps of a mesh period.

Positions repeat with the mesh, so that search, compliance and modes of each are kept and used again: from the second
mesh period on a step is the solution of its contact system alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, frictional, frictionless, normal_part
from evolvent.contact.transient.time_schemes.time_scheme import MotionState, TimeScheme, TimeStep
from evolvent.dynamics.transient.certificates import certify_step
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.nodal_sums import NodalSums
from evolvent.dynamics.transient.pair_step import PairStep, SearchedContact
from evolvent.dynamics.transient.step_balance import Residuals, StepBalance, StepEnd, StepEnergies, stored_energy
from evolvent.gears.kinematics import Stand
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.friction_history import FrictionHistory, previous_jumps
from evolvent.gears.sweep.position_result import PositionResult, position_result
from evolvent.gears.sweep.slip import slip_direction, slip_increment
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

NO_STIFFNESS = float("nan")
"""A moving pair's positions have no tangent stiffness."""


@dataclass(frozen=True)
class PairState:
    """What the next time step begins with."""

    motion: MotionState
    """Modes and ψ."""
    history: FrictionHistory | None
    """Of friction, None without it."""
    vibration: Floats
    """(m,) amplitudes of the modes beyond those by the contact forces in statics."""
    patch: ContactPatch | None = None
    """The last contact patch, None where it is not known or nothing touched."""
    before: StepEnd | None = None
    """For the balance of the next step, None where there is no step before."""


@dataclass(frozen=True)
class PairMoment:
    """A pair at the end of a time step: what tables say of it."""

    time: float
    """[s]."""
    result: PositionResult
    """The position, with teeth numbered as in a pitch from rotation 0 on."""
    mesh_force: float
    """Torque of the contact on ψ over its lever [N; N/mm in 2D]."""
    rate: float
    """Of the transmission error [mm/s]."""
    residuals: Residuals
    """Of the balances of the step."""
    energies: StepEnergies
    """Of the step."""


@dataclass(frozen=True)
class MovingMoment(PairMoment):
    """A moment from which the motion goes on."""

    state: PairState
    """To go on from."""


@dataclass(frozen=True)
class PairTransient:
    """Moves a pair on."""

    pair: MovingPair
    """With inertia."""
    friction: float
    """μ."""
    speed: float
    """Of the pinion [rad/s]."""
    scheme: TimeScheme
    """Of the time steps."""
    contacts: KeptContacts
    """Of the positions of a mesh period."""

    @property
    def name(self) -> str:
        """Speed and friction, for messages."""
        return f"{self.speed * 30.0 / np.pi:g} r/min, μ = {self.friction:g}"

    @property
    def time_step(self) -> float:
        """[s]."""
        return self.contacts.step_angle / self.speed

    def run(self, state: PairState, periods: int) -> Iterator[MovingMoment]:
        """Time steps of so many mesh periods, from a state at pinion rotation 0, each of them in balance. Raises
        NotConverged, SearchError, Unbalanced."""
        count = self.contacts.positions
        for n in range(1, periods * count + 1):
            if n % count == 0:
                state = self._earlier(state)
            moment = self._advanced(state, n % count, n * self.time_step)
            state = moment.state
            yield moment

    def _earlier(self, state: PairState) -> PairState:
        """The same a pitch earlier, where the other teeth stand as these do."""
        m, pair = state.motion, self.pair
        motion = MotionState(*(pair.earlier(each, 1) for each in (m.position, m.velocity, m.acceleration)))
        history = None if state.history is None else state.history.earlier(1)
        before = None if state.before is None else state.before.earlier(pair)
        return replace(state, motion=motion, history=history, vibration=pair.earlier(state.vibration, 1), before=before)

    def _advanced(self, state: PairState, phase: int, time: float) -> MovingMoment:
        """The next time step. Raises NotConverged, SearchError, Unbalanced."""
        step = PairStep(self.pair, TimeStep(self.pair.system, self.scheme, state.motion, self.time_step))
        predicted = float(state.motion.position[-1] + self.time_step * state.motion.velocity[-1])
        at, found = self.contacts.solved(phase, predicted, lambda at: self._equilibrium(step, at, state))
        moment = self._moment(step, at, found, state.before, time)
        degrees = np.degrees(phase * self.contacts.step_angle)
        certify_step(moment.residuals, state.before is None, f"{self.name}, pinion at {degrees:.3f}°")
        return moment

    def _equilibrium(self, step: PairStep, at: SearchedContact, state: PairState) -> Equilibrium:
        """Of the contact at the end of a step. Raises NotConverged."""
        system, geometry = step.system(at), at.contact.geometry
        start = None if state.patch is None else state.patch.at(geometry)
        smooth = frictionless(normal_part(system), start if start is not None and start.any() else None)
        if state.history is None:
            return smooth

        def vibration(member: Member) -> Floats:
            return self.pair.vibration(member, geometry.rows(member)[0], state.vibration)

        (before,) = previous_jumps(geometry, [state.history], vibration)
        slip = slip_increment(geometry, before, self.contacts.step_angle)
        rough = frictional(system, self.friction, slip, slip_direction(geometry), smooth)
        return replace(rough, iterations=smooth.iterations + rough.iterations)

    def _moment(
        self, step: PairStep, at: SearchedContact, found: Equilibrium, before: StepEnd | None, time: float
    ) -> MovingMoment:
        pair, motion = self.pair, step.state(at, found)
        ψ = float(motion.position[-1])
        stand = replace(at.contact.stand, extra=pair.drive.rotations(ψ))
        result = replace(
            position_result(pair.model, at.contact, found, self.friction, NO_STIFFNESS, 0), stand=stand
        )
        sums = NodalSums.of(pair, at.contact.stand, result)
        stored = stored_energy(pair, at, found)
        balance = StepBalance(step, self.contacts.step_angle, motion, result, sums, stored)
        state = PairState(
            motion, self._history(at, found, stand), motion.position[:-1] - pair.static(sums.modal),
            _patch(at, found), balance.end,
        )  # fmt: skip
        turned = at.turned.reshape(found.force.shape[0], at.k)[:, : found.force.shape[1]]
        force = float(np.sum(turned * found.force)) / pair.lever
        return MovingMoment(
            time, result, force, float(motion.velocity[-1]) * pair.lever, balance.residuals(before),
            balance.energies(before), state,
        )  # fmt: skip

    def _history(self, at: SearchedContact, found: Equilibrium, stand: Stand) -> FrictionHistory | None:
        if not self.friction:
            return None
        return replace(FrictionHistory.of(self.pair.model, at.contact, found), stand=stand)


def _patch(at: SearchedContact, found: Equilibrium) -> ContactPatch | None:
    pressed = found.traction[:, 0]
    return ContactPatch.of(at.contact.geometry, pressed) if pressed.any() else None
