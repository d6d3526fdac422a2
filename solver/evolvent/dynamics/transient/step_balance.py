"""The balances of a time step: momentum, action and reaction, energy; by nodal sums, not by the step's own arithmetic.

Momentum. With the forces p that the nodal sums give on modes and ψ, the state that was reached has to fulfil

    M ((1 − α) a_{n+1} + α a_n) + D v_{n+1} + K z_{n+1} = p_{n+1} .

Energy. That of the motion has an exact balance in time steps under any forces, with the work of the contact forces by
the trapezoidal rule (contact/transient/time_schemes/scheme_energy.py), also of a step of another length than the one
before (changed_length.py), and of one at whose end alone, or at whose begin alone, the damping of the mesh
acts, with the work of each end's own damping. There is no exact one between this work and what the flanks store: other
nodes and points are in contact at the end of a step than at its begin, the nominal rotation moves them on in between,
and the normals are those before deflection. Over a step

    rotation = given + friction + stored + (what is left)

rotation: ½ Σ (T_1 − T_2/u) Δφ, what the nominal rotation puts in at the pinion less what it takes out at the wheel;
given: to modes and ψ; friction: in the nominal sliding, by the power at both ends, and in the slip beyond it, see
`work_beyond_nominal`; stored: ½ fᵀC_r f and ∫ (λ²/γ + τ²/γ_t)/2. Over a mesh period of a steady motion nothing is
stored, and what is left corresponds to `pitch_imbalance` of statics.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import astuple, dataclass, replace
from functools import cached_property

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, with_components
from evolvent.contact.transient.time_schemes.scheme_energy import SchemeEnergy
from evolvent.contact.transient.time_schemes.time_scheme import MotionState
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.nodal_sums import NodalSums
from evolvent.dynamics.transient.pair_step import PairStep, SearchedContact
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

UNKNOWN = float("nan")
TINY = 1e-300


@dataclass(frozen=True)
class Residuals:
    """What balances are missed by, relative. NaN where there is no step before."""

    momentum: float
    """Of the equations of motion, over the forces in them: the larger one of ψ and of the modes."""
    reaction: float
    """Sum of the forces on both gears, and their moments about the axes less the torques of the result, over the force
    or the load."""
    moment: float
    """Sum of the moments of the forces on both gears about one axis, over the force and the base radius. The points
    opposite each other on both flanks are a gap apart, so that it falls with the mesh."""
    motion: float
    """Energy of modes and ψ, over this energy and the work on them."""
    exchange: float
    """Energy between rotation, contact and motion, over what the load passes on: in a step, or on the whole way from
    one position to the next."""

    def larger(self, other: Residuals) -> Residuals:
        """The larger ones of both, the known one where only one is known."""
        return Residuals(*np.fmax(astuple(self), astuple(other)).tolist())


NOTHING_KNOWN = Residuals(*[UNKNOWN] * 5)
"""Of no step."""


@dataclass(frozen=True)
class StepEnergies:
    """What energy does in a time step, or in several [N·mm; N in 2D]. NaN where there is no step before."""

    passed: float
    """What the load passes on: its torque on the pinion times the step."""
    rotation: float
    """That the nominal rotation puts in at the pinion, less what it takes out at the wheel."""
    given: float
    """By the contact to modes and ψ."""
    friction: float
    """Lost to friction."""
    stored: float
    """By the static rest of both gears and the contact."""
    damping: float
    """Lost to the damping of mesh and modes."""
    numerical: float
    """Taken out by the time scheme, less what the same state has more of its energy where steps change their length.
    """

    @staticmethod
    def summed(steps: Iterable[StepEnergies]) -> StepEnergies:
        """Of several steps."""
        return StepEnergies(*np.sum([astuple(step) for step in steps], axis=0).tolist())

    @property
    def left(self) -> float:
        """What contact and rotation do not account for."""
        return self.rotation - self.given - self.friction - self.stored


@dataclass(frozen=True)
class StepEnd:
    """What the balance of the next time step begins with."""

    acceleration: Floats
    """(m + 1,) at the begin of the step."""
    forces: Floats
    """p (m + 1,) at its end."""
    damping: Floats
    """D v (m + 1,) at its end."""
    powers: tuple[float, float]
    """Of rotation and of friction in the nominal sliding at its end, per radian of the pinion [N·mm; N in 2D]."""
    motion: float
    """Energy of modes and ψ as the scheme keeps it."""
    stored: float
    """Energy of rest and contact."""
    converted: float = 0.0
    """What `motion` is more than before the length of the steps changed."""

    def in_steps_of(self, energy: SchemeEnergy, state: MotionState, before: Floats) -> StepEnd:
        """The same for a step of another length, with the energy of its scheme: `state` and the acceleration one step
        before it (m + 1,) are those of that length."""
        motion = energy.of(state, before)
        return replace(self, acceleration=before, motion=motion, converted=motion - self.motion)

    def earlier(self, pair: MovingPair) -> StepEnd:
        """The same a pitch earlier, where the other teeth stand as these do. Energies are the same."""
        acceleration, forces, damping = (
            pair.earlier(each, 1) for each in (self.acceleration, self.forces, self.damping)
        )
        return replace(self, acceleration=acceleration, forces=forces, damping=damping)


@dataclass(frozen=True)
class StepBalance:
    """The end of a time step, as its balances see it."""

    step: PairStep
    """From the state at its begin."""
    span: float
    """Nominal rotation of the pinion in it [rad]."""
    state: MotionState
    """At its end."""
    result: PositionResult
    """Of the position at its end."""
    sums: NodalSums
    """Of its contact forces."""
    stored: float
    """Energy of rest and contact, see `stored_energy`."""
    slip_work: float
    """Work of friction beyond that in the nominal sliding, see `work_beyond_nominal`."""

    @cached_property
    def end(self) -> StepEnd:
        """What the next balance begins with."""
        pair = self.step.pair
        powers = self.sums.torques[0] - self.sums.torques[1] / pair.model.pair.ratio, self.result.friction_loss
        begin = self.step.step.state.acceleration
        damping = self.step.step.system.damping * self.state.velocity
        return StepEnd(begin, self._forces, damping, powers, self._energy.of(self.state, begin), self.stored)

    def energies(self, before: StepEnd | None) -> StepEnergies:
        """Of the step. before: None where there is no step before."""
        drive, lever = self.step.pair.drive, self.step.pair.lever
        passed = drive.torque / lever * self.step.pair.base_radii[0] * self.span
        if before is None:
            return StepEnergies(passed, *([UNKNOWN] * 6))
        begin, end = self.step.step.state, self.end
        moved = self.state.position - begin.position
        mean, damping = 0.5 * (before.forces + end.forces), 0.5 * (before.damping + end.damping)
        given = float(mean @ moved) - drive.torque * float(moved[-1])
        rotation, friction = (0.5 * self.span * (one + other) for one, other in zip(before.powers, end.powers))
        return StepEnergies(
            passed, rotation, given, friction + self.slip_work, end.stored - before.stored, float(damping @ moved),
            self._energy.taken(before.acceleration, self.state) - before.converted,
        )

    def residuals(self, before: StepEnd | None) -> Residuals:
        """Of all balances. before: as in `energies`."""
        energies = self.energies(before)
        motion = UNKNOWN if before is None else self._motion(energies, before)
        exchange = abs(energies.left) / energies.passed
        return Residuals(self._momentum, self._reaction, self._moment, motion, exchange)

    def _motion(self, energies: StepEnergies, before: StepEnd) -> float:
        moved = float(self.state.position[-1] - self.step.step.state.position[-1])
        worked, reached = self.step.pair.drive.torque * moved, self.end.motion
        missed = reached - before.motion - energies.given - worked + energies.damping + energies.numerical
        missed += before.converted
        return abs(missed) / (reached + before.motion + abs(energies.given) + abs(worked))

    @property
    def _energy(self) -> SchemeEnergy:
        step = self.step.step
        return SchemeEnergy(step.system, step.scheme, step.length)

    @cached_property
    def _forces(self) -> Floats:
        """p (m + 1,)."""
        drive = self.step.pair.drive
        against = [load - taken for load, taken in zip(drive.torques, self.sums.torques)]
        return np.append(self.sums.modal, np.dot(drive.shares, against))

    @property
    def _momentum(self) -> float:
        step, m, p = self.step.step, self.step.pair.count, self._forces
        α, system = step.scheme.alpha, step.system
        inertia = system.mass @ ((1.0 - α) * self.state.acceleration + α * step.state.acceleration)
        held = system.damping * self.state.velocity + system.stiffness * self.state.position
        missed, torque = inertia + held - p, self.step.pair.drive.torque
        modal = sum(float(np.linalg.norm(part[:m])) for part in (inertia, held, p))
        turning = abs(torque) + abs(p[m] - torque)
        return max(abs(float(missed[m])) / turning, float(np.linalg.norm(missed[:m])) / max(modal, TINY))

    @property
    def _force(self) -> float:
        """Of the contact, or of the load where that is larger."""
        load = self.step.pair.drive.torque / self.step.pair.lever
        return max(load, float(np.linalg.norm(self.sums.resultants[0])))

    @property
    def _reaction(self) -> float:
        forces = float(np.linalg.norm(self.sums.resultants.sum(axis=0)))
        radii = self.step.pair.base_radii
        moments = [
            abs(self.sums.torques[gear] - self.result.torques[gear]) / radii[gear] for gear in Member
        ]
        return max(forces, *moments) / self._force

    @property
    def _moment(self) -> float:
        return abs(sum(self.sums.about_pinion)) / (self._force * self.step.pair.base_radii[0])


def stored_energy(pair: MovingPair, at: SearchedContact, found: Equilibrium) -> float:
    """½ fᵀC_r f of both gears beyond their modes, and ∫ (λ²/γ + τ²/γ_t)/2 of the contact [N·mm; N in 2D]."""
    if not found.force.any():
        return 0.0
    f, operator = with_components(found.force, at.k).ravel(), at.contact.operator
    modal = at.modes.T @ f / pair.frequencies
    rest = 0.5 * float(f @ at.compliance.times(f)) - 0.5 * float(modal @ modal)
    squares = found.traction**2 / operator.slope(found.traction.shape[1])
    return rest + 0.5 * float(np.sum(operator.weights[:, None] * squares))
