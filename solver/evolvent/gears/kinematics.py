"""Kinematics of a gear pair: the rotating frames of both gears, and the nominal slip of their flanks.

The pinion turns by θ_1 = φ − ψ_1 + ε_1, the wheel by θ_2 = π − ψ_2 − φ z_1/z_2 + ε_2. ψ is the half angle of the tooth
on the working pitch circle, so that φ = 0 puts the flanks of tooth pair 0 at the pitch point in the mid-face section; ε
is the rotation beyond the nominal one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import misalignment_rotation, misalignment_shift
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.rotation import turn

E_Z = np.array([0.0, 0.0, 1.0])

ROUNDING = 1e-9
"""Distance from the pitch point, over the step of ξ, below which a position is taken as standing at it."""


@dataclass(frozen=True)
class PairRotation:
    """Angular position of both gears."""

    pair: GearPair
    """The gears' geometry."""
    angle: float
    """Nominal pinion rotation φ [rad]."""
    beyond_nominal: tuple[float, float] = (0.0, 0.0)
    """Rotations of pinion and wheel beyond the nominal ones, about +z [rad]; finite, not linearised."""

    @property
    def turns(self) -> tuple[float, float]:
        """Rotations (θ_1, θ_2) of the gears' frames [rad]."""
        pinion, wheel = self.pair.gears
        d1, d2 = self.pair.working_pitch_diameters
        return (
            self.angle - pinion.half_angle(d1) + self.beyond_nominal[0],
            np.pi - wheel.half_angle(d2) - self.angle / self.pair.ratio + self.beyond_nominal[1],
        )

    def turned(self, gear: Member, δ: float) -> PairRotation:
        """Angular position with δ [rad] added to the rotation of a gear."""
        ε = list(self.beyond_nominal)
        ε[gear] += δ
        return replace(self, beyond_nominal=(ε[0], ε[1]))

    @property
    def transmission_error(self) -> float:
        """Transmission error r_b1 φ_1 − r_b2 φ_2 [mm]."""
        pinion, wheel = self.pair.gears
        return float(pinion.base_radius * self.beyond_nominal[0] + wheel.base_radius * self.beyond_nominal[1])

    def centre(self, gear: Member, d: int) -> Floats:
        """Centre (d,) of a gear [mm]; that of a misaligned wheel lies beside mid-face, see `misalignment_shift`."""
        if gear == Member.PINION:
            return np.zeros(d)
        return np.array([self.pair.centre_distance, 0.0, misalignment_shift(self.pair)])[:d]

    def rotation(self, gear: Member, d: int, tooth: int = 0) -> Floats:
        """Rotation matrix (d, d) from the frame of a gear's tooth i, turned by ±2πi/z, to the common frame."""
        own = turn(self.turns[gear] + gear.sign * 2.0 * np.pi * tooth / self.pair.gears[gear].z, d)
        return own if d == 2 else self.tilt(gear) @ own

    def tilt(self, gear: Member) -> Floats:
        """Rotation matrix (3, 3) of a gear's misalignment; that of the pinion is the identity."""
        return Rotation.from_rotvec(misalignment_rotation(self.pair)).as_matrix() if gear == Member.WHEEL else np.eye(3)

    def axis(self, gear: Member) -> Floats:
        """Unit vector (3,) of a gear's axis."""
        return self.tilt(gear)[:, 2]

    def roll_distance(self, tooth: int, z: Floats) -> Floats:
        """Roll distance ξ [mm] of tooth pair i's contact line at heights z."""
        return self.pair.roll_distance(self.angle, tooth, z)


def line_of_action(pair: GearPair, d: int) -> Floats:
    """Two unit vectors (2, d): n along the line of action in the transverse section, from pinion to wheel, in which ξ
    grows, and e_z × n, along which the pinion slides over the wheel by (1 + 1/u) ξ per radian."""
    α = pair.working_pressure_angle
    return np.array([[np.sin(α), np.cos(α), 0.0], [-np.cos(α), np.sin(α), 0.0]])[:, :d]


def spin(points: Floats, centre: Floats, axis: Floats = E_Z) -> Floats:
    """Displacement a × (x − c) per radian about an axis (3,), (n, d); in 2D the axis is z."""
    arm = points - centre
    if arm.shape[1] == 2:
        return np.column_stack([-arm[:, 1], arm[:, 0]])
    return np.cross(axis, arm)


def nominal_slip(rate: Floats, ξ_now: Floats, ξ_before: Floats, along: Floats, ratio: float, span: float) -> Floats:
    """Slip ∫v_s dt over a step at the nominal ratio, per node (n, d) [mm].

    rate: (n, d) velocity of the pinion relative to the wheel per radian of φ at the present position [mm/rad].
    ξ_now, ξ_before: (n,) roll distance of the contact line in the node's transverse slice [mm].
    along: (n, d) unit tangent in which the velocity grows with ξ, by 1 + 1/u.
    ratio: u. span: Δφ of the step [rad].

    Where ξ changes sign within the step, slip counts from the pitch point on, because it reverses there. The sign is
    that of the slice, not of the point, so that all points of a contact patch reverse together. At the pitch point
    itself, to rounding, friction keeps its former direction.
    """
    step = ξ_now - ξ_before
    earlier = rate - (1.0 + 1.0 / ratio) * step[:, None] * along
    zero = ROUNDING * np.abs(step)
    crossed = (np.abs(ξ_now) > zero) & (np.sign(ξ_now) * ξ_before < zero)
    part = np.where(crossed, ξ_now / np.where(step == 0.0, 1.0, step), 1.0)
    mean = np.where(crossed[:, None], 0.5 * rate, 0.5 * (rate + earlier))
    return mean * (span * part)[:, None]
