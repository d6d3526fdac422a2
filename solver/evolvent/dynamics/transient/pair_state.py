"""What a time step of a gear pair begins with, and what it results in."""

from __future__ import annotations

from dataclasses import dataclass, replace

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.transient.time_schemes.scheme_energy import SchemeEnergy
from evolvent.contact.transient.time_schemes.time_scheme import MotionState, TimeScheme
from evolvent.dynamics.transient.changed_length import motion_energy, step_error, stretched
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_step import PairStep, SearchedContact
from evolvent.dynamics.transient.step_balance import StepEnd
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.friction_history import FrictionHistory, PreviousJump, previous_jumps
from evolvent.gears.sweep.slip import work_beyond_nominal
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


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
    length: float = 0.0
    """Of the step before [s]."""
    halvings: int = 0
    """k of the next step: it is 2⁻ᵏ of the way between two positions."""
    mesh_force: float | None = None
    """At the end of the step before [N; N/mm in 2D], None where there is no step before."""
    energy: float = 0.0
    """The largest so far, of vibration, modes, static rest and contact [N·mm; N in 2D]."""

    def previous_jump(self, pair: MovingPair, geometry: ContactGeometry) -> PreviousJump | None:
        """Friction history interpolated to the nodes of a contact, None without friction."""
        if self.history is None:
            return None

        def vibration(member: Member) -> Floats:
            return pair.vibration(member, geometry.rows(member)[0], self.vibration)

        (before,) = previous_jumps(geometry, [self.history], vibration)
        return before

    def for_step(self, pair: MovingPair, scheme: TimeScheme, length: float) -> PairState:
        """The same for a step of this length [s]. The first step begins without a past, and needs nothing of it."""
        if self.before is None or length == self.length:
            return self
        stretch = length / self.length
        motion, acceleration = stretched(scheme, self.motion, self.before.acceleration, stretch)
        energy = SchemeEnergy(pair.system, scheme, length)
        return replace(self, motion=motion, before=self.before.in_steps_of(energy, motion, acceleration))


@dataclass(frozen=True)
class SolvedStep:
    """A time step that may count or not."""

    step: PairStep
    """From its begin."""
    begin: PairState
    """For a step of its length."""
    halvings: int
    """k, see `PairState.halvings`."""
    at: SearchedContact
    """The contact at its end."""
    found: Equilibrium
    """Of that contact."""
    motion: MotionState
    """At its end."""
    stored: float
    """Energy of rest and contact there."""
    jump_before: PreviousJump | None
    """Friction history interpolated to this contact, None without friction."""

    @property
    def slip_work(self) -> float:
        """Work of friction beyond that in the nominal sliding [N·mm; N in 2D]."""
        if self.jump_before is None or self.begin.history is None:
            return 0.0
        return work_beyond_nominal(self.at.contact, self.found, self.jump_before, self.begin.history)

    @property
    def touches(self) -> bool:
        """Whether flanks press on each other."""
        return bool((self.found.traction[:, 0] > 0.0).any())

    @property
    def energy(self) -> float:
        """The largest so far, see `PairState`."""
        return max(self.begin.energy, motion_energy(self.step.pair.system, self.motion) + self.stored)

    @property
    def error(self) -> float:
        """Estimated (changed_length.py)."""
        return step_error(self.step.step, self.motion, self.energy)
