"""Exact loaded flank of a gear, and contact lines of two flanks.

The loaded flank of tooth 0 is the involute helicoid at θ > 0 (docs/design.md). Its coordinates are z and the roll
length ρ ≥ 0, the transverse radius of curvature. With

    γ = ψ_b − ρ/r_b + twist·z,   e = (cos γ, sin γ),   t = (−sin γ, cos γ):
    point = r_b e + ρ t,   outward normal n = (cos β_b t, −hand sin β_b)

it is a developable surface: straight along its generators, of curvature radius ρ / cos β_b across them (Litvin and
Fuentes, Gear Geometry and Applied Theory, 2004, chapter 14). A parallel surface is the same helicoid rotated, so that
the distance of a point from the flank is a closed form. Modifications are offsets −c(ρ, z) n.

Two flanks touch along straight generators in the plane of action, at roll distances ξ from the pitch point:
`PairGeometry.roll_distance`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.flank_depth import MICROMETRE
from evolvent_meshes.gears.pair import GearPair


def transverse_frame(angle: Floats) -> tuple[Floats, Floats]:
    """Unit vectors e(γ) and t(γ) (…, 3) of the transverse plane, at angles γ (…) [rad]."""
    cosine, sine, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    return np.stack([cosine, sine, zero], axis=-1), np.stack([-sine, cosine, zero], axis=-1)


@dataclass(frozen=True)
class Flank:
    """Loaded flank (θ > 0) of tooth 0 in the gear's frame, with its modifications.

    gear: the gear.
    Roll lengths and z are scalars or arrays that broadcast to a shape (…) [mm].
    """

    gear: GearParameters

    @property
    def roll_lengths(self) -> tuple[float, float]:
        """Roll lengths ρ at the root form circle and the tip form circle, the range of the flank [mm]."""
        return self.gear.rack_form_roll_length, self.gear.roll_length(self.gear.tip_form_diameter)

    def roll_length(self, radius: ArrayLike) -> Floats:
        """Roll lengths ρ (…) [mm] at radii (…) [mm]; 0 below the base circle."""
        r, base = np.asarray(radius, dtype=float), self.gear.base_radius
        return np.sqrt(np.maximum((r - base) * (r + base), 0.0))

    def _broadcast(self, roll_length: ArrayLike, z: ArrayLike) -> tuple[Floats, Floats, Floats, Floats]:
        rho, height = np.broadcast_arrays(np.asarray(roll_length, dtype=float), np.asarray(z, dtype=float))
        angle = self.gear.base_half_angle - rho / self.gear.base_radius + self.gear.twist * height
        radial, tangent = transverse_frame(angle)
        return rho, height, radial, tangent

    def point(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Points (…, 3) [mm] of the modified flank; (ρ, z) are coordinates on the helicoid, before the offset."""
        offset = self.modification(roll_length, z)
        return self.helicoid_point(roll_length, z) - offset[..., None] * self.helicoid_normal(roll_length, z)

    def helicoid_point(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Points (…, 3) [mm] of the involute helicoid without modifications."""
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
        """Unit vectors (…, 3) along the straight generators towards +z, the principal direction of curvature 0."""
        _, _, _, tangent = self._broadcast(roll_length, z)
        directions = self.gear.hand * math.sin(self.gear.base_helix_angle) * tangent
        directions[..., 2] = math.cos(self.gear.base_helix_angle)
        return directions

    def normal(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Outward unit normals (…, 3) of the modified flank, from its exact tangents along ρ and z."""
        rho, height, radial, tangent = self._broadcast(roll_length, z)
        helicoid = self.helicoid_normal(rho, height)
        offset, (slope_roll, slope_z) = self.modification(rho, height), self.gear.flank_depth.slopes(rho, height)
        base, cosine = self.gear.base_radius, math.cos(self.gear.base_helix_angle)
        remaining = rho - offset * cosine  # roll length of the modified point
        along_roll = (remaining / base)[..., None] * radial - slope_roll[..., None] * helicoid
        along_z = self.gear.twist * (base * tangent - remaining[..., None] * radial) - slope_z[..., None] * helicoid
        along_z[..., 2] += 1.0
        normals = np.cross(along_z, along_roll)
        return np.asarray(normals / np.linalg.norm(normals, axis=-1, keepdims=True))

    def principal_curvatures(self, roll_length: ArrayLike) -> tuple[Floats, Floats]:
        """Principal curvatures (…) [1/mm] of the helicoid, convex positive: 0 along the generator, cos β_b / ρ across.

        Modifications of micrometres are neglected; they change slopes, not the radii of Hertz' formulas.
        """
        rho = np.asarray(roll_length, dtype=float)
        return np.zeros_like(rho), np.asarray(math.cos(self.gear.base_helix_angle) / rho)

    def modification(self, roll_length: ArrayLike, z: ArrayLike) -> Floats:
        """Material removed along the normal, c(ρ, z) (…) [mm]; not negative on the evaluated flank."""
        rho, height = np.broadcast_arrays(np.asarray(roll_length, dtype=float), np.asarray(z, dtype=float))
        return self.gear.flank_depth.at(rho, height)

    def project(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Coordinates ρ and z (…) of the feet of points (…, 3) on the helicoid, and distances (…) from the flank [mm].

        The distance from the modified flank is measured along the normal of the helicoid and positive outside the
        tooth. It is exact; inside the base cylinder, where there is no involute, it is NaN.
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
        """Signed distances (…) [mm] of points (…, 3) from the modified flank, positive outside; see `project`."""
        return self.project(points)[2]


@dataclass(frozen=True)
class ContactLine:
    """Contact line of a tooth pair, a straight segment in the plane of action.

    tooth: index i of the tooth pair.
    z: of both ends, ascending [mm].
    roll_distance: ξ of both ends [mm].
    """

    tooth: int
    z: tuple[float, float]
    roll_distance: tuple[float, float]

    def points(self, count: int) -> tuple[Floats, Floats]:
        """Roll distances ξ and z (count,) [mm] of evenly spaced points, ends included."""
        return np.linspace(*self.roll_distance, count), np.linspace(*self.z, count)


def contact_lines(pair: GearPair, rotation: float) -> list[ContactLine]:
    """Contact lines of the undeformed flanks without modifications at pinion rotation φ [rad], by tooth index."""
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
    """Rotations (…) [rad] of the pinion's and the wheel's frame about +z at pinion rotations φ (…) [rad].

    At φ = 0 the loaded flanks of tooth pair 0 touch at the pitch point: the centre lines of the teeth are half the
    working tooth thickness beside the line of centres. Conjugate flanks without deformation touch at every φ.
    """
    phi = np.asarray(rotation, dtype=float)
    diameter_1, diameter_2 = pair.working_pitch_diameters
    first = phi - pair.pinion.half_angle(diameter_1)
    return first, np.asarray(math.pi - pair.wheel.half_angle(diameter_2) - phi / pair.ratio)


def action_plane_points(pair: GearPair, roll_distance: ArrayLike, z: ArrayLike) -> Floats:
    """Points (…, 3) [mm] of the plane of action at roll distances ξ and z (…) [mm], fixed frame, aligned axes."""
    xi, height = np.broadcast_arrays(np.asarray(roll_distance, dtype=float), np.asarray(z, dtype=float))
    angle, pitch = pair.working_pressure_angle, pair.working_pitch_diameters[0] / 2.0
    return np.stack([pitch + xi * math.sin(angle), xi * math.cos(angle), height], axis=-1)


def contact_normal(pair: GearPair) -> Floats:
    """Outward unit normal (3,) of the pinion's flank at all contact lines, fixed frame, aligned axes."""
    angle, base = pair.working_pressure_angle, pair.pinion.base_helix_angle
    axial = -pair.pinion.hand * math.sin(base)
    return np.array([math.cos(base) * math.sin(angle), math.cos(base) * math.cos(angle), axial])


def misalignment_rotation(pair: GearPair) -> Floats:
    """Rotation vector (3,) [rad] of the wheel about its centre (a, 0, 0), in the plane of action, fixed frame.

    It moves the wheel's axis along the line of action by misalignment_um over the common face width, at +z away from
    the pinion's loaded flank.
    """
    angle = pair.working_pressure_angle
    tilt = math.atan(pair.misalignment_um * MICROMETRE / pair.face_width)
    return tilt * np.array([-math.cos(angle), math.sin(angle), 0.0])


def misalignment_shift(pair: GearPair) -> float:
    """Axial position [mm] of the misaligned wheel's centre, at which the flanks stay at the pitch point in mid-face.

    A tilt about the centre alone moves a wheel's flank there axially, by tilt·ρ_2: helical flanks would open or close
    as a whole, and turn against each other, by what an axial adjustment of the wheel makes.
    """
    tilt = math.atan(pair.misalignment_um * MICROMETRE / pair.face_width)
    return -tilt * pair.pitch_point_roll_lengths[1]


def separation(pair: GearPair, roll_distance: ArrayLike, z: ArrayLike) -> Floats:
    """Normal gap (…) [mm] between the flanks at nominal angles, from modifications and misalignment.

    Negative where the flanks overlap. The misalignment is of first order: `misalignment_rotation` and
    `misalignment_shift` rotate the plane of action about the pitch point, and the axial part of that opens the gap of
    helical flanks too.

    roll_distance: ξ (…) [mm].
    z: (…) [mm].
    """
    xi, height = np.asarray(roll_distance, dtype=float), np.asarray(z, dtype=float)
    rho_1, rho_2 = pair.curvature_radii(xi)
    base, slope = pair.pinion.base_helix_angle, pair.misalignment_um * MICROMETRE / pair.face_width
    from_pitch_point = rho_2 - pair.pitch_point_roll_lengths[1]
    tilt = slope * (height * math.cos(base) - pair.pinion.hand * math.sin(base) * from_pitch_point)
    return np.asarray(Flank(pair.pinion).modification(rho_1, z) + Flank(pair.wheel).modification(rho_2, z) + tilt)
