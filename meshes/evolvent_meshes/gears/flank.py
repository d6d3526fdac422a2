"""The exact loaded flank of a gear, and where two of them touch.

The loaded flank of tooth 0 is the involute helicoid at θ > 0 (docs/design.md). Its coordinates are z and the roll
length ρ ≥ 0 (transverse distance from the base cylinder along the tangent, the transverse curvature radius). With

    γ = ψ_b − ρ/r_b + twist·z,   e = (cos γ, sin γ),   t = (−sin γ, cos γ):
    point = r_b e + ρ t,   outward normal n = (cos β_b t, −hand sin β_b)

it is a developable surface: straight along its generators, curvature radius ρ / cos β_b across them (Litvin and
Fuentes, Gear Geometry and Applied Theory, 2004, chapter 14). A parallel surface is the same helicoid turned, so the
distance of a point from it is a closed form. Modifications are offsets −c(ρ, z) n.

Two flanks touch along straight generators in the plane of action. Roll distance ξ of pair i at z, φ: `GearPair`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

MICROMETRE = 1e-3


def frame(angle: Floats) -> tuple[Floats, Floats]:
    """Unit vectors e(γ), t(γ) (…, 3) of the transverse plane."""
    cosine, sine, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    return np.stack([cosine, sine, zero], axis=-1), np.stack([-sine, cosine, zero], axis=-1)


@dataclass(frozen=True)
class Flank:
    """Loaded flank (θ > 0) of tooth 0 in the gear's own frame, with the gear's modifications. Lengths in mm.

    Roll lengths and z are scalars or arrays of one shape (or broadcastable), called (…) below.
    """

    gear: GearParameters

    @property
    def roll_lengths(self) -> tuple[float, float]:
        """ρ at the form circle and at the tip circle: the range of the flank."""
        return self.gear.rack_form_roll_length, self.gear.roll_length(self.gear.tip_diameter)

    def roll_length(self, radius: ArrayLike) -> Floats:
        """ρ (…) at radii r ≥ r_b; 0 below the base circle."""
        r, base = np.asarray(radius, dtype=float), self.gear.base_radius
        return np.sqrt(np.maximum((r - base) * (r + base), 0.0))

    def _broadcast(self, roll_length: ArrayLike, z: ArrayLike) -> tuple[Floats, Floats, Floats, Floats]:
        rho, height = np.broadcast_arrays(np.asarray(roll_length, dtype=float), np.asarray(z, dtype=float))
        radial, tangent = frame(self.gear.base_half_angle - rho / self.gear.base_radius + self.gear.twist * height)
        return rho, height, radial, tangent

    def point(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Points (…, 3) of the modified flank; (ρ, z) are those of the helicoid's point, before the offset."""
        offset = self.modification(roll_length, z)
        return self.helicoid_point(roll_length, z) - offset[..., None] * self.helicoid_normal(roll_length, z)

    def helicoid_point(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Points (…, 3) of the involute helicoid without modifications."""
        rho, height, radial, tangent = self._broadcast(roll_length, z)
        points = self.gear.base_radius * radial + rho[..., None] * tangent
        points[..., 2] = height
        return points

    def helicoid_normal(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Outward unit normals (…, 3) of the involute helicoid."""
        _, _, _, tangent = self._broadcast(roll_length, z)
        normals = math.cos(self.gear.base_helix_angle) * tangent
        normals[..., 2] = -self.gear.hand * math.sin(self.gear.base_helix_angle)
        return normals

    def generator(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Unit vectors (…, 3) along the straight generators, towards +z: the principal direction of curvature 0."""
        _, _, _, tangent = self._broadcast(roll_length, z)
        directions = self.gear.hand * math.sin(self.gear.base_helix_angle) * tangent
        directions[..., 2] = math.cos(self.gear.base_helix_angle)
        return directions

    def normal(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Outward unit normals (…, 3) of the modified flank, from its exact tangents along ρ and z."""
        rho, height, radial, tangent = self._broadcast(roll_length, z)
        helicoid = self.helicoid_normal(rho, height)
        offset, (slope_roll, slope_z) = self.modification(rho, height), self._modification_slopes(rho, height)
        base, cosine = self.gear.base_radius, math.cos(self.gear.base_helix_angle)
        rest = rho - offset * cosine  # roll length of the modified point on its tangent
        along_roll = (rest / base)[..., None] * radial - slope_roll[..., None] * helicoid
        along_z = self.gear.twist * (base * tangent - rest[..., None] * radial) - slope_z[..., None] * helicoid
        along_z[..., 2] += 1.0
        normals = np.cross(along_z, along_roll)
        return np.asarray(normals / np.linalg.norm(normals, axis=-1, keepdims=True))

    def principal_curvatures(self, roll_length: ArrayLike) -> tuple[Floats, Floats]:
        """(0 along the generator, cos β_b / ρ across it) [1/mm], convex positive, of the helicoid.

        Modifications of micrometres are left out: they change slopes, not Hertz' radii.
        """
        rho = np.asarray(roll_length, dtype=float)
        return np.zeros_like(rho), np.asarray(math.cos(self.gear.base_helix_angle) / rho)

    def modification(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Material taken off along the normal, c(ρ, z) ≥ 0 [mm], shape (…)."""
        rho, height = np.broadcast_arrays(np.asarray(roll_length, dtype=float), np.asarray(z, dtype=float))
        given = self.gear.modifications
        relief, _ = self._relief(rho)
        crowning = given.lead_crowning_um * MICROMETRE * (2.0 * height / self.gear.face_width) ** 2
        return np.asarray(relief + crowning)

    def _modification_slopes(self, rho: Floats, height: Floats) -> tuple[Floats, Floats]:
        """(∂c/∂ρ, ∂c/∂z)."""
        crowning = self.gear.modifications.lead_crowning_um * MICROMETRE
        return self._relief(rho)[1], np.asarray(8.0 * crowning * height / self.gear.face_width**2)

    def _relief(self, rho: Floats) -> tuple[Floats, Floats]:
        """Tip relief [mm] and its derivative by ρ; it goes on with the same law past the tip circle."""
        given = self.gear.modifications
        if given.tip_relief_um == 0.0 or given.tip_relief_start_diameter is None:
            return np.zeros_like(rho), np.zeros_like(rho)
        start = self.gear.roll_length(given.tip_relief_start_diameter)
        length, height = self.roll_lengths[1] - start, given.tip_relief_um * MICROMETRE
        part = np.maximum(rho - start, 0.0) / length
        if given.tip_relief_parabolic:
            return np.asarray(height * part**2), np.asarray(2.0 * height * part / length)
        return np.asarray(height * part), np.where(part > 0.0, height / length, 0.0)

    def project(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Feet (ρ, z) on the helicoid and signed distances from the modified flank of points (…, 3), each (…).

        The distance is measured along the helicoid's normal, positive outside the tooth, and exact for points outside
        the base cylinder (inside it there is no involute: nan).
        """
        points = np.asarray(points, dtype=float)
        gear, z = self.gear, points[..., 2]
        radius = np.hypot(points[..., 0], points[..., 1])
        rho = np.where(radius >= gear.base_radius, self.roll_length(radius), np.nan)
        tangent = rho / gear.base_radius
        flank = gear.base_half_angle - (tangent - np.arctan(tangent)) + gear.twist * z
        angle = np.arctan2(points[..., 1], points[..., 0]) - flank
        angle = (angle + math.pi) % (2.0 * math.pi) - math.pi
        height = gear.base_radius * angle * math.cos(gear.base_helix_angle)
        foot = rho - height * math.cos(gear.base_helix_angle)
        foot_z = z + gear.hand * math.sin(gear.base_helix_angle) * height
        return foot, foot_z, np.asarray(height + self.modification(foot, foot_z))

    def distance(self, points: Floats) -> Floats:
        """Signed normal distances (…) [mm] of points (…, 3) from the modified flank, positive outside."""
        return self.project(points)[2]


@dataclass(frozen=True)
class ContactLine:
    """Contact line of tooth pair i: a straight segment between (ξ, z) ends [mm], z ascending."""

    tooth: int
    z: tuple[float, float]
    roll_distance: tuple[float, float]

    def points(self, count: int) -> tuple[Floats, Floats]:
        """`count` evenly spaced (ξ, z), ends included."""
        return np.linspace(*self.roll_distance, count), np.linspace(*self.z, count)


def contact_lines(pair: GearPair, rotation: float) -> list[ContactLine]:
    """Contact lines of the undeformed, unmodified flanks at pinion rotation φ [rad], by ascending tooth index."""
    start, end = pair.path_of_contact
    slope, half_width = pair.pinion.hand * math.tan(pair.pinion.base_helix_angle), pair.face_width / 2.0
    lines = []
    for tooth in pair.teeth_in_contact(rotation):
        middle = float(pair.roll_distance(rotation, tooth))
        low, high = -half_width, half_width
        if slope != 0.0:
            low, high = sorted(((start - middle) / slope, (end - middle) / slope))
            low, high = max(low, -half_width), min(high, half_width)
        lines.append(ContactLine(tooth, (low, high), (middle + slope * low, middle + slope * high)))
    return lines


def nominal_angles(pair: GearPair, rotation: ArrayLike) -> tuple[Floats, Floats]:
    """Rotations [rad] of the pinion's and the wheel's frame about +z at pinion rotation φ [rad], design.md conventions.

    At φ = 0 the loaded flanks of tooth pair 0 meet at the pitch point: each tooth stands half its working tooth
    thickness beside the line of centres. Undeformed, conjugate flanks stay in touch.
    """
    phi = np.asarray(rotation, dtype=float)
    diameter_1, diameter_2 = pair.working_pitch_diameters
    first = phi - pair.pinion.half_angle(diameter_1)
    return first, np.asarray(math.pi - pair.wheel.half_angle(diameter_2) - phi / pair.ratio)


def contact_points(pair: GearPair, roll_distance: ArrayLike, z: ArrayLike) -> Floats:
    """Points (…, 3) in space of the plane of action at (ξ, z), aligned axes."""
    xi, height = np.broadcast_arrays(np.asarray(roll_distance, dtype=float), np.asarray(z, dtype=float))
    angle, pitch = pair.operating_pressure_angle, pair.working_pitch_diameters[0] / 2.0
    return np.stack([pitch + xi * math.sin(angle), xi * math.cos(angle), height], axis=-1)


def contact_normal(pair: GearPair) -> Floats:
    """Outward unit normal (3,) of the pinion's flank along every contact line, in space, aligned axes."""
    angle, base = pair.operating_pressure_angle, pair.pinion.base_helix_angle
    axial = -pair.pinion.hand * math.sin(base)
    return np.array([math.cos(base) * math.sin(angle), math.cos(base) * math.cos(angle), axial])


def misalignment_rotation(pair: GearPair) -> Floats:
    """Rotation vector (3,) [rad] in space of the wheel about its centre (a, 0, 0), in the plane of action.

    It moves the wheel's axis along the line of action by misalignment_um over the common face width, away from the
    pinion's loaded flank at +z.
    """
    angle = pair.operating_pressure_angle
    tilt = math.atan(pair.misalignment_um * MICROMETRE / pair.face_width)
    return tilt * np.array([-math.cos(angle), math.sin(angle), 0.0])


def separation(pair: GearPair, roll_distance: ArrayLike, z: ArrayLike) -> Floats:
    """Normal gap (…) [mm] that modifications and misalignment leave at (ξ, z) between flanks at nominal angles.

    The misalignment, to first order: `misalignment_rotation` turns the plane of action in itself about the foot of the
    wheel's centre on it, ξ = ρ_C2, so that helical flanks also feel its axial part. Negative where flanks overlap.
    """
    xi, height = np.asarray(roll_distance, dtype=float), np.asarray(z, dtype=float)
    rho_1, rho_2 = pair.curvature_radii(xi)
    base, slope = pair.pinion.base_helix_angle, pair.misalignment_um * MICROMETRE / pair.face_width
    tilt = slope * (height * math.cos(base) - pair.pinion.hand * math.sin(base) * rho_2)
    return np.asarray(Flank(pair.pinion).modification(rho_1, z) + Flank(pair.wheel).modification(rho_2, z) + tilt)
