"""State of a gear pair at the start of a time step, and a time step as solved."""

from __future__ import annotations

from dataclasses import dataclass, replace

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.transient.time_schemes.scheme_energy import SchemeEnergy
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeScheme
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
    """State of a gear pair at the start of a time step."""

    motion: KinematicState
    """Position, velocity and acceleration of modes and ψ."""
    history: FrictionHistory | None
    """Friction history; None without friction."""
    vibration: Floats
    """Amplitudes (m,) of the modes beyond those by the contact forces in statics."""
    patch: ContactPatch | None = None
    """The last contact patch, None where it is not known or nothing touched."""
    before: StepEnd | None = None
    """End of the previous step, for the balance of the next one; None where there is no previous step."""
    length: float = 0.0
    """Length of the previous step [s]."""
    halvings: int = 0
    """Halvings k of the next step, which is 2⁻ᵏ of the way between two positions."""
    mesh_force: float | None = None
    """Mesh force at the end of the previous step [N; N/mm in 2D]; None where there is no previous step."""
    energy: float = 0.0
    """Largest energy so far, of modes and ψ, of the residual static compliance and of the contact [N·mm; N in 2D]."""

    def previous_jump(self, pair: MovingPair, geometry: ContactGeometry) -> PreviousJump | None:
        """Friction history interpolated to the nodes of a contact, None without friction."""
        if self.history is None:
            return None

        def vibration(member: Member) -> Floats:
            return pair.vibration(member, geometry.rows(member)[0], self.vibration)

        (before,) = previous_jumps(geometry, [self.history], vibration)
        return before

    def for_step(self, pair: MovingPair, scheme: TimeScheme, length: float) -> PairState:
        """State converted to a time step of this length [s]. The first step has no previous one, and needs no
        conversion."""
        if self.before is None or length == self.length:
            return self
        stretch = length / self.length
        motion, acceleration = stretched(scheme, self.motion, self.before.acceleration, stretch)
        energy = SchemeEnergy(pair.system, scheme, length)
        return replace(self, motion=motion, before=self.before.in_steps_of(energy, motion, acceleration))


@dataclass(frozen=True)
class SolvedStep:
    """A solved time step, before it is accepted or rejected."""

    step: PairStep
    """Equations of the step, from the state at its start."""
    begin: PairState
    """State at the start, converted to the length of the step."""
    halvings: int
    """Halvings k of the step, which is 2⁻ᵏ of the way between two positions."""
    at: SearchedContact
    """Searched contact at the end of the step."""
    found: Equilibrium
    """Equilibrium of the contact at the end of the step."""
    motion: KinematicState
    """Position, velocity and acceleration of modes and ψ at the end of the step."""
    stored: float
    """Energy of the residual static compliance and of the contact at the end of the step [N·mm; N in 2D]."""
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
        """Largest energy up to the end of the step, as `PairState.energy` [N·mm; N in 2D]."""
        return max(self.begin.energy, motion_energy(self.step.pair.system, self.motion) + self.stored)

    @property
    def error(self) -> float:
        """Estimated relative error of the step (changed_length.py)."""
        return step_error(self.step.step, self.motion, self.energy)
