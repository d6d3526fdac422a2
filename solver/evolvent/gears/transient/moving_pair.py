"""A gear pair with inertia: what moves, and a time step as the contact system of a position.

Coordinates are the modes of the pinion, those of the wheel, and one rotation ψ, by which the gears turn beyond the nominal
rotation, each in its share (`RotorShares`). With Φ the jumps of the contact by unit modes, H those by ψ, D the matrix and
b the known part of a time step (contact/transient/time_scheme.py), eliminating the modes leaves, at ψ_s where the flanks
were searched and ψ = ψ_s + δ,

    J = Φ D_q⁻¹ (b_q − D_qψ ψ_s) + (H − Φ D_q⁻¹ D_qψ) δ − (A − Φ (Ω⁻² − D_q⁻¹) Φᵀ) f ,
    (H − Φ D_q⁻¹ D_qψ)ᵀ f + D' δ = T + b_ψ − D_ψq D_q⁻¹ b_q − D' ψ_s ,    D' = D_ψψ − D_ψq D_q⁻¹ D_qψ .
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.jump_compliance import DenseCompliance
from evolvent.contact.transient.time_scheme import LinearSystem, TimeStep
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.gear_model import GearModel
from evolvent.gears.modes.gear_modes import GearModes
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class MovingPair:
    """A condensed pair with inertia; m modes of both gears together."""

    model: GearModel
    """The pair without inertia."""
    gears: tuple[GearModes, GearModes]
    """Modes of pinion and wheel."""
    shares: tuple[float, float]
    """Rotations of pinion and wheel about +z by a unit ψ: (0, 1) where the pinion turns at constant speed."""
    inertias: tuple[float, float]
    """Moments of inertia of pinion and wheel, with what turns with them [t·mm²; t·mm in 2D]."""
    damping_ratio: float = 0.0
    """ζ of each mode."""
    rotor_damping: float = 0.0
    """Torque against ψ per unit velocity [N·mm·s; N·s in 2D]."""

    @cached_property
    def frequencies(self) -> Floats:
        """ω (m,) [rad/s]."""
        return np.concatenate([gear.modes.frequencies for gear in self.gears])

    @property
    def count(self) -> int:
        """m."""
        return len(self.frequencies)

    @cached_property
    def system(self) -> LinearSystem:
        """Of modes and ψ, (m + 1) coordinates."""
        m, ω = self.count, self.frequencies
        mass = np.eye(m + 1)
        mass[m, :m] = mass[:m, m] = np.concatenate([s * gear.spun for s, gear in zip(self.shares, self.gears)])
        mass[m, m] = sum(s**2 * inertia for s, inertia in zip(self.shares, self.inertias))
        return LinearSystem(mass, np.append(2.0 * self.damping_ratio * ω, self.rotor_damping), np.append(ω**2, 0.0))

    def earlier(self, coordinates: Floats, pitches: int) -> Floats:
        """Coordinates (m + 1,) of the same motion so many angular pitches earlier, where other teeth stand as these."""
        parts = np.split(coordinates, [self.gears[0].count, self.count])
        moved = [
            gear.modes.earlier(part, -member.sign * pitches) for member, gear, part in zip(Member, self.gears, parts)
        ]
        return np.concatenate([*moved, parts[2]])

    def torque(self, angle: float) -> float:
        """T [N·mm; N in 2D] on ψ at a pinion rotation: of the gear with the torque."""
        return self.shares[self.model.load.on] * self.model.load.at(angle)

    def mode_jumps(self, geometry: ContactGeometry, k: int) -> Floats:
        """Φ (n·k, m) [mm] at the contact of a position."""
        return np.hstack([self._jumps(geometry, member, k) for member in Member])

    def _jumps(self, geometry: ContactGeometry, member: Member, k: int) -> Floats:
        d, gear, rows = geometry.d, self.gears[member], []
        for t, map in zip(geometry.teeth, geometry.jump_maps(member, k)):
            nodes, tooth = t.coupled_nodes(member), member.sign * t.tooth
            own = gear.at(tooth, nodes, d).reshape(len(nodes), d, -1)
            turned = np.einsum("ab,nbm->nam", geometry.stand.turned_by(member, tooth, d), own)
            rows.append(map.jumps(turned.reshape(len(nodes) * d, -1)))
        return np.concatenate(rows)


@dataclass(frozen=True)
class ResistedContact:
    """The contact of one position with what does not depend on the step: n·k jumps, m modes."""

    geometry: ContactGeometry
    """Where the flanks face each other."""
    compliance: DenseCompliance
    """A, static."""
    modes: Floats
    """Φ (n·k, m)."""
    turned: Floats
    """H (n·k,), jumps by a unit ψ."""


@dataclass(frozen=True)
class PairStep:
    """One time step of a pair."""

    pair: MovingPair
    """The pair."""
    step: TimeStep
    """From the state at its begin, on modes and ψ."""
    angle: float
    """Nominal rotation of the pinion at its end [rad]."""

    def system(self, contact: ResistedContact, operator_of: object, searched: float) -> CondensedSystem:
        """See the module; searched: ψ_s [rad]."""
        raise NotImplementedError
