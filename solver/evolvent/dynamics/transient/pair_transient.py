"""A gear pair over time at constant nominal speed, in equal steps of a mesh period.

Positions repeat with the mesh, so that search, compliance and modes of each are kept and used again: from the second
mesh period on a step is the solution of its contact system alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, frictional, frictionless, normal_part
from evolvent.contact.transient.time_scheme import MotionState, TimeScheme, TimeStep
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_step import PairStep, SearchedContact
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


@dataclass(frozen=True)
class PairMoment:
    """A pair at the end of a time step."""

    time: float
    """[s]."""
    result: PositionResult
    """The position, with teeth numbered as in a pitch from rotation 0 on."""
    state: PairState
    """To go on from."""
    mesh_force: float
    """Torque of the contact on ψ over its lever [N; N/mm in 2D]."""
    rate: float
    """Of the transmission error [mm/s]."""


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
    def time_step(self) -> float:
        """[s]."""
        return self.contacts.step_angle / self.speed

    def run(self, state: PairState, periods: int) -> Iterator[PairMoment]:
        """Time steps of so many mesh periods, from a state at pinion rotation 0. Raises NotConverged, SearchError."""
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
        return replace(state, motion=motion, history=history, vibration=pair.earlier(state.vibration, 1))

    def _advanced(self, state: PairState, phase: int, time: float) -> PairMoment:
        """The next time step. Raises NotConverged, SearchError."""
        step = PairStep(self.pair, TimeStep(self.pair.system, self.scheme, state.motion, self.time_step))
        predicted = float(state.motion.position[-1] + self.time_step * state.motion.velocity[-1])
        at, found = self.contacts.solved(phase, predicted, lambda at: self._equilibrium(step, at, state))
        return self._moment(step, at, found, phase, time)

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

    def _moment(self, step: PairStep, at: SearchedContact, found: Equilibrium, phase: int, time: float) -> PairMoment:
        pair, contact = self.pair, at.contact
        motion = step.state(at, found)
        angle = phase * self.contacts.step_angle
        stand = Stand(pair.model.pair, angle, pair.drive.rotations(float(motion.position[-1])))
        result = replace(
            position_result(pair.model, contact, found, self.friction, NO_STIFFNESS, 0), stand=stand
        )
        rows = result.pinion_rows, result.wheel_rows
        static = pair.static(rows, (result.pinion_forces, result.wheel_forces))
        history = None
        if self.friction:
            history = replace(FrictionHistory.of(pair.model, contact, found), stand=stand)
        pressed = found.traction[:, 0]
        patch = ContactPatch.of(contact.geometry, pressed) if pressed.any() else None
        state = PairState(motion, history, motion.position[: pair.count] - static, patch)
        turned = at.turned.reshape(found.force.shape[0], at.k)[:, : found.force.shape[1]]
        force = float(np.sum(turned * found.force)) / pair.lever
        return PairMoment(time, result, state, force, float(motion.velocity[-1]) * pair.lever)
