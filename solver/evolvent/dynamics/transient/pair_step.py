"""A time step of a gear pair as the contact system of a position.

With Φ the jumps of the contact by unit modes, H those by ψ, A the static compliance, D the matrix and b the known part
of the time step (contact/transient/time_schemes/time_scheme.py), eliminating the modes leaves, at ψ_s where the flanks
were searched and with ψ = ψ_s + δ,

    J = Φ D_q⁻¹ (b_q − D_qψ ψ_s) + H' δ − (A − Φ (Ω⁻² − D_q⁻¹) Φᵀ) f ,    H' = H − Φ D_q⁻¹ D_qψ ,
    H'ᵀ f + D' δ = T + b_ψ − D_ψq D_q⁻¹ b_q − D' ψ_s ,                    D' = D_ψψ − D_ψq D_q⁻¹ D_qψ .
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.newton.applied_compliance import with_modes
from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium, free_motion, with_components
from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeStep
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.fem.parallel.memory import array_bytes
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.overlap_check import UnsearchedOverlap, overlap_outside, unsearched_overlaps
from evolvent.gears.contact.pair_contact import GearContact
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class SearchedContact:
    """The contact of a position as searched, with k components, n·k jumps and m modes: no state enters it."""

    contact: GearContact
    """Contact between the flanks that face each other."""
    searched: float
    """Rotation ψ_s at which the flanks were searched [rad]."""
    modes: Floats
    """Jumps Φ (n·k, m) by unit modes [mm]."""
    turned: Floats
    """Jumps H (n·k,) by a unit ψ [mm/rad]."""
    k: int
    """Number of components of the contact forces."""
    teeth: tuple[int, ...]
    """Tooth pairs that may touch."""

    @cached_property
    def compliance(self) -> JumpCompliance:
        """Static compliance A (n·k, n·k) [mm/N], assembled when flanks first touch: in flight nothing needs it."""
        return self.contact.geometry.compliance(self.k)

    @property
    def is_condensed(self) -> bool:
        """Whether the compliance has been assembled."""
        return "compliance" in vars(self)

    @property
    def bytes_now(self) -> int:
        """Memory [bytes] of matrices, search results, and what solutions have derived from them so far; without the
        gears."""
        others = [value for name, value in vars(self).items() if name != "compliance"]
        return array_bytes(others, GearBody) + (self.compliance.nbytes if self.is_condensed else 0)

    @property
    def counted_bytes(self) -> int:
        """Memory [bytes] that counts in a store: `bytes_now`; with a compliance, its value when this was first asked
        for."""
        return self._condensed_bytes if self.is_condensed else self.bytes_now

    @cached_property
    def _condensed_bytes(self) -> int:
        return self.bytes_now

    @cached_property
    def _unsearched(self) -> tuple[UnsearchedOverlap, ...]:
        """Overlaps of the undeformed flanks outside the window."""
        return unsearched_overlaps(self.contact.geometry, self.teeth)

    def overlap_outside(self, pair: MovingPair, found: Equilibrium) -> bool:
        """Whether flanks overlap where the window was not searched, deflected as in statics under the same forces: the
        modes' own vibration hardly moves one flank against the other there. Raises SearchError."""
        turned = pair.drive.rotations(float(found.motion[0]))
        return overlap_outside(self.contact, self._unsearched, found.force, turned) > 0.0

    @staticmethod
    def of(pair: MovingPair, contact: GearContact, searched: float, k: int) -> SearchedContact:
        """Searched contact with the jumps by modes and ψ."""
        geometry = contact.geometry
        turned = sum(share * spin[:, :k] for share, spin in zip(pair.drive.shares, geometry.spins))
        return SearchedContact(contact, searched, pair.mode_jumps(geometry, k), np.ravel(turned), k, pair.model.teeth)


@dataclass(frozen=True)
class PairStep:
    """One time step of a pair with m modes."""

    pair: MovingPair
    """Gear pair with its inertia."""
    step: TimeStep
    """Time step of modes and ψ (m + 1), from the state at its start."""

    def system(self, at: SearchedContact) -> CondensedSystem:
        """Contact system at the end of the step, in δ = ψ − ψ_s."""
        slow = 1.0 / self.pair.frequencies**2 - 1.0 / self._modal
        return CondensedSystem(
            operator=at.contact.operator,
            compliance=with_modes(at.compliance, at.modes, -slow),
            motion=self._turned(at),
            jump=self._jump(at),
            load=self._load(at),
            resistance=self._resistance,
            lever=np.array([self.pair.lever]),
        )

    def in_flight(self, at: SearchedContact, k: int) -> Equilibrium | None:
        """Solution of k components without contact forces. None where points overlap without them, or where nothing but
        contact holds the rotation."""
        free = free_motion(self._turned(at), self._jump(at), self._load(at), self._resistance)
        if free is None:
            return None
        δ, operator, jump = free[0], at.contact.operator, free[1].reshape(-1, at.k)
        if (operator.trial(jump)[:, 0] > 0.0).any():
            return None
        force, traction = np.zeros((len(jump), k)), np.zeros((len(operator.weights), k))
        return Equilibrium(force, traction, δ, jump[:, :k], 0, 0.0)

    def state(self, at: SearchedContact, found: Equilibrium) -> KinematicState:
        """Position, velocity and acceleration of modes and ψ at the end of the step."""
        m, D, b = self.pair.count, self.step.matrix, self.step.known
        ψ = at.searched + float(found.motion[0])
        pushed = at.modes.T @ with_components(found.force, at.k).ravel()
        q = (b[:m] - D[:m, m] * ψ - pushed) / self._modal
        return self.step.after(np.append(q, ψ))

    def _turned(self, at: SearchedContact) -> Floats:
        """Jumps H' (n·k, 1) by a unit δ with the modes eliminated."""
        return (at.turned - at.modes @ self._push)[:, None]

    def _jump(self, at: SearchedContact) -> Floats:
        """The part of J that is known (n·k,)."""
        return at.modes @ (self.step.known[: self.pair.count] / self._modal - self._push * at.searched)

    def _load(self, at: SearchedContact) -> Floats:
        """The right side of the balance of δ (1,)."""
        m, b = self.pair.count, self.step.known
        return self.pair.drive.torque + b[m:] - self._push @ b[:m] - self._resistance[0] * at.searched

    @cached_property
    def _resistance(self) -> Floats:
        """Coefficient D' (1, 1) of δ with the modes eliminated."""
        m, D = self.pair.count, self.step.matrix
        return D[m:, m:] - D[m:, :m] @ self._push[:, None]

    @cached_property
    def _push(self) -> Floats:
        """Coupling D_q⁻¹ D_qψ (m,) of the modes to ψ."""
        return self.step.matrix[: self.pair.count, self.pair.count] / self._modal

    @cached_property
    def _modal(self) -> Floats:
        """Diagonal D_q (m,) of the step's matrix for the modes."""
        return np.diag(self.step.matrix)[: self.pair.count]
