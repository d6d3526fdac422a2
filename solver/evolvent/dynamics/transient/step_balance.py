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
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState
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
    """Relative residuals of the balances of a time step. NaN where there is no step before."""

    momentum: float
    """Residual of the equations of motion, over the forces in them: the larger one of ψ and of the modes."""
    reaction: float
    """Sum of the forces on both gears, and their moments about the axes less the torques of the result, over the force
    or the load."""
    moment: float
    """Sum of the moments of the forces on both gears about one axis, over the force and the base radius. The points
    opposite each other on both flanks are a gap apart, so that it falls with the mesh."""
    motion: float
    """Energy residual of modes and ψ, over this energy and the work on them."""
    exchange: float
    """Energy residual between rotation, contact and motion, over the energy that the load transmits: in a step, or on
    the whole way from one position to the next."""

    def larger(self, other: Residuals) -> Residuals:
        """The larger ones of both, the known one where only one is known."""
        return Residuals(*np.fmax(astuple(self), astuple(other)).tolist())


NOTHING_KNOWN = Residuals(*[UNKNOWN] * 5)
"""Residuals before the first time step: NaN."""


@dataclass(frozen=True)
class StepEnergies:
    """Energies converted in a time step, or in several [N·mm; N in 2D]. NaN where there is no step before."""

    passed: float
    """Energy that the load transmits: its torque on the pinion times the rotation in the step."""
    rotation: float
    """Energy that the nominal rotation puts in at the pinion, less what it takes out at the wheel."""
    given: float
    """Work of the contact on modes and ψ."""
    friction: float
    """Energy lost to friction in the contact."""
    stored: float
    """Energy stored by the residual static compliance of both gears and by the contact."""
    damping: float
    """Energy lost to the damping of mesh and modes."""
    numerical: float
    """Energy taken out by the time scheme, less the increase of the scheme's energy of the same state where steps
    change their length."""

    @staticmethod
    def summed(steps: Iterable[StepEnergies]) -> StepEnergies:
        """Energies of several time steps together."""
        return StepEnergies(*np.sum([astuple(step) for step in steps], axis=0).tolist())

    @property
    def left(self) -> float:
        """Unbalanced energy: rotation − given − friction − stored."""
        return self.rotation - self.given - self.friction - self.stored


@dataclass(frozen=True)
class StepEnd:
    """End of a time step, with which the balance of the next one begins."""

    acceleration: Floats
    """Acceleration (m + 1,) of modes and ψ at the start of the step."""
    forces: Floats
    """Forces p (m + 1,) on modes and ψ at the end of the step."""
    damping: Floats
    """Damping forces D v (m + 1,) at the end of the step."""
    powers: tuple[float, float]
    """Work of rotation, and of friction in the nominal sliding, per radian of the pinion at the end of the step [N·mm;
    N in 2D]."""
    motion: float
    """Energy of modes and ψ in the time scheme [N·mm; N in 2D]."""
    stored: float
    """Energy of the residual static compliance and of the contact [N·mm; N in 2D]."""
    converted: float = 0.0
    """Increase of `motion` as the length of the steps changed [N·mm; N in 2D]."""

    def in_steps_of(self, energy: SchemeEnergy, state: KinematicState, before: Floats) -> StepEnd:
        """End of the step for a next one of another length, with the energy of its scheme. state, before: motion, and
        acceleration (m + 1,) one step before it, converted to that length."""
        motion = energy.of(state, before)
        return replace(self, acceleration=before, motion=motion, converted=motion - self.motion)

    def earlier(self, pair: MovingPair) -> StepEnd:
        """End of the step with the teeth renumbered by one pitch. Energies stay the same."""
        acceleration, forces, damping = (
            pair.earlier(each, 1) for each in (self.acceleration, self.forces, self.damping)
        )
        return replace(self, acceleration=acceleration, forces=forces, damping=damping)


@dataclass(frozen=True)
class StepBalance:
    """A solved time step, for its balances of momentum, reaction and energy."""

    step: PairStep
    """Equations of the step, from the state at its start."""
    span: float
    """Nominal rotation of the pinion in the step [rad]."""
    state: KinematicState
    """Position, velocity and acceleration of modes and ψ at the end of the step."""
    result: PositionResult
    """Result of the position at the end of the step."""
    sums: NodalSums
    """Nodal sums of the contact forces at the end of the step."""
    stored: float
    """Energy of the residual static compliance and of the contact [N·mm; N in 2D], see `stored_energy`."""
    slip_work: float
    """Work of friction beyond that in the nominal sliding, see `work_beyond_nominal`."""

    @cached_property
    def end(self) -> StepEnd:
        """End of the step, with which the next balance begins."""
        pair = self.step.pair
        powers = self.sums.torques[0] - self.sums.torques[1] / pair.model.pair.ratio, self.result.friction_loss
        begin = self.step.step.state.acceleration
        damping = self.step.step.system.damping * self.state.velocity
        return StepEnd(begin, self._forces, damping, powers, self._energy.of(self.state, begin), self.stored)

    def energies(self, before: StepEnd | None) -> StepEnergies:
        """Energies of the step. before: None where there is no step before."""
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
        """Residuals of all balances of the step. before: None where there is no step before."""
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
        """Forces p (m + 1,) on modes and ψ by the nodal sums."""
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
        """Contact force, or the load where that is larger, to which residuals are relative."""
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
    """Stored energy ½ fᵀC_r f of both gears beyond their modes, and ∫ (λ²/γ + τ²/γ_t)/2 of the contact [N·mm; N in
    2D]."""
    if not found.force.any():
        return 0.0
    f, operator = with_components(found.force, at.k).ravel(), at.contact.operator
    modal = at.modes.T @ f / pair.frequencies
    rest = 0.5 * float(f @ at.compliance.times(f)) - 0.5 * float(modal @ modal)
    squares = found.traction**2 / operator.slope(found.traction.shape[1])
    return rest + 0.5 * float(np.sum(operator.weights[:, None] * squares))
