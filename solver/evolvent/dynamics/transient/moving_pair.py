"""A gear pair with inertia: coordinates, mass, damping and stiffness.

Coordinates are the modes of the pinion, those of the wheel, and one rotation ψ, by which the gears turn beyond the
nominal rotation, each in its share.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evolvent.contact.transient.time_schemes.time_scheme import LinearSystem
from evolvent.dynamics.modes.gear_modes import GearModes
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.gear_model import GearModel
from evolvent.gears.ring.ring_compliance import MappedNodes
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class Drive:
    """Rotation of the gears beyond the nominal one, as one coordinate ψ.

    With the pinion at constant speed the wheel's inertia alone swings. Where both gears are free, ψ is the motion
    against each other that leaves the nominal rotation alone (I_1 a_1 = I_2 a_2/u): the equivalent mass of the
    torsional model.
    """

    shares: tuple[float, float]
    """Rotations a of pinion and wheel about +z by a unit ψ."""
    inertia: float
    """Moment of inertia Σ a² I of ψ [t·mm²; t·mm in 2D]."""
    torques: tuple[float, float]
    """Load torques of pinion and wheel, both positive [N·mm; N in 2D]."""

    @staticmethod
    def at_constant_speed(driven: Member, inertia: float, torques: tuple[float, float]) -> Drive:
        """Drive with one gear at constant speed. driven: the other gear; inertia: its moment of inertia."""
        shares = (0.0, 1.0) if driven is Member.WHEEL else (1.0, 0.0)
        return Drive(shares, inertia, torques)

    @staticmethod
    def free(ratio: float, inertias: tuple[float, float], torques: tuple[float, float]) -> Drive:
        """Drive with both gears free to turn. ratio: u."""
        pinion, wheel = inertias
        shares = 1.0, ratio * pinion / wheel
        return Drive(shares, pinion + shares[1] ** 2 * wheel, torques)

    @property
    def torque(self) -> float:
        """Load torque Σ a T on ψ [N·mm; N in 2D]."""
        return sum(share * torque for share, torque in zip(self.shares, self.torques))

    def rotations(self, ψ: float) -> tuple[float, float]:
        """Rotations of pinion and wheel beyond the nominal ones by ψ [rad]."""
        return self.shares[0] * ψ, self.shares[1] * ψ

    def of(self, rotations: tuple[float, float], base_radii: tuple[float, float]) -> float:
        """Rotation ψ [rad] with the transmission error of two rotations [rad] of pinion and wheel."""
        error = sum(radius * rotation for radius, rotation in zip(base_radii, rotations))
        return error / self.lever(base_radii)

    def lever(self, base_radii: tuple[float, float]) -> float:
        """Transmission error by a unit ψ [mm]."""
        return sum(radius * share for radius, share in zip(base_radii, self.shares))


@dataclass(frozen=True)
class MovingPair:
    """A condensed pair with inertia; m modes of both gears together."""

    model: GearModel
    """Condensed gears and their contact, without inertia."""
    gears: tuple[GearModes, GearModes]
    """Modes of pinion and wheel."""
    drive: Drive
    """Rotation of the gears beyond the nominal one."""
    damping_ratio: float
    """Damping ratio ζ of each mode."""
    mesh_damping: float
    """Damping of the mesh: force along the line of action per unit rate of the transmission error [N·s/mm; N·s/mm² in
    2D]."""
    damping_in_separation: bool = False
    """Whether the damping of the mesh acts on separated flanks, too."""

    @cached_property
    def frequencies(self) -> Floats:
        """Natural frequencies ω (m,) of both gears with held bores [rad/s]."""
        return np.concatenate([gear.modes.frequencies for gear in self.gears])

    @property
    def count(self) -> int:
        """Number m of modes of both gears."""
        return len(self.frequencies)

    @property
    def base_radii(self) -> tuple[float, float]:
        """Base radii of pinion and wheel [mm]."""
        pinion, wheel = self.model.pair.gears
        return pinion.base_radius, wheel.base_radius

    @property
    def lever(self) -> float:
        """Transmission error by a unit ψ [mm]."""
        return self.drive.lever(self.base_radii)

    @cached_property
    def system(self) -> LinearSystem:
        """Mass, damping and stiffness of modes and ψ, (m + 1) coordinates, with flanks in contact."""
        m, ω = self.count, self.frequencies
        mass = np.eye(m + 1)
        spun = [share * gear.spun for share, gear in zip(self.drive.shares, self.gears)]
        mass[m, :m] = mass[:m, m] = np.concatenate(spun)
        mass[m, m] = self.drive.inertia
        damping = np.append(2.0 * self.damping_ratio * ω, self.mesh_damping * self.lever**2)
        return LinearSystem(mass, damping, np.append(ω**2, 0.0))

    @cached_property
    def system_apart(self) -> LinearSystem:
        """Mass, damping and stiffness of modes and ψ, (m + 1) coordinates, with separated flanks."""
        if self.damping_in_separation:
            return self.system
        return replace(self.system, damping=np.append(self.system.damping[:-1], 0.0))

    def earlier(self, coordinates: Floats, pitches: int) -> Floats:
        """Coordinates (m + 1,) of the same motion so many angular pitches earlier, where other teeth stand as these."""
        parts = self._split(coordinates)
        moved = [g.modes.earlier(part, -member.sign * pitches) for member, g, part in zip(Member, self.gears, parts)]
        return np.concatenate([*moved, coordinates[self.count :]])

    def modal_forces(self, position: PositionResult) -> Floats:
        """Forces (m,) on the modes of both gears by the contact forces of a position [N·mm per unit amplitude]."""
        rows, forces = (position.pinion_rows, position.wheel_rows), (position.pinion_forces, position.wheel_forces)
        return np.concatenate([
            np.einsum("kdm,kd->m", self.displacements(member, rows[member]), forces[member]) for member in Member
        ])

    def static(self, modal: Floats) -> Floats:
        """Amplitudes (m,) of the modes of both gears under forces (m,) on them, in statics."""
        return modal / self.frequencies**2

    def displacements(self, member: Member, rows: Ints) -> Floats:
        """Displacements (k, d, m) of rows (k, 2), tooth and node, of a gear by unit amplitudes of its modes, in its own
        frame."""
        d, gear, z = self.model.bodies[member].d, self.gears[member], self.model.pair.gears[member].z
        result = np.zeros((len(rows), d, gear.count))
        for tooth in np.unique(rows[:, 0]):
            here = np.flatnonzero(rows[:, 0] == tooth)
            own = gear.at(int(tooth), rows[here, 1], d).reshape(len(here), d, -1)
            result[here] = np.einsum("ab,kbm->kam", turn(2.0 * np.pi * tooth / z, d), own)
        return result

    def vibration(self, member: Member, rows: Ints, amplitudes: Floats) -> Floats:
        """Displacements (k, d) of rows (k, 2) of a gear by amplitudes (m,) of all modes."""
        return self.displacements(member, rows) @ self._split(amplitudes)[member]

    def mode_jumps(self, geometry: ContactGeometry, k: int) -> Floats:
        """Jumps Φ (n·k, m) by unit modes at the contact of a position [mm]."""
        moving = [member for member in Member if self.gears[member].count]
        if not moving:
            return np.zeros((geometry.operator.n * k, 0))
        return np.hstack([self._jumps(geometry, member, k) for member in moving])

    def _jumps(self, geometry: ContactGeometry, member: Member, k: int) -> Floats:
        d, gear, rows = geometry.d, self.gears[member], []
        pitch = 2.0 * np.pi / self.model.pair.gears[member].z
        for t, E in zip(geometry.teeth, geometry.jump_maps(member, k)):
            tooth, nodes = member.sign * t.tooth, t.coupled_nodes(member)
            part = MappedNodes(tooth, nodes, E).of_turned(turn(tooth * pitch, d))
            rows.append(part.jumps(gear.at(tooth, nodes, d)))
        return np.concatenate(rows)

    def _split(self, amplitudes: Floats) -> tuple[Floats, Floats]:
        pinion, wheel = np.split(amplitudes[: self.count], [self.gears[0].count])
        return pinion, wheel
