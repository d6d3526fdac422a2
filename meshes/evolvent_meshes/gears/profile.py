"""The exact transverse profile of one tooth sector, mid-face section, in the gear's own frame. NumPy only.

The half profile of the θ > 0 flank runs from the sector's cut at θ = π/z over root arc, fillet, involute and tip arc to
the tooth's centre line θ = 0 (`SEGMENTS`, in this order); `mirror` gives the other half. The involute carries no
modifications: those belong to `evolvent_meshes.gears.flank`.

The fillet is the envelope of the generating rack's rounded tip. The rack is straight along its teeth, so the transverse
section of a helical gear is cut by the transverse section of the rack: the normal section with its tip circle stretched
by 1/cos β along the pitch line, an ellipse. This is exact; the usual circle of a virtual spur gear is not needed. The
law of gearing gives the rack's travel at which a point of the tip cuts: its normal passes through the pitch point
(Litvin and Fuentes, Gear Geometry and Applied Theory, 2004, chapter 6; ISO 6336-3 uses the same fillet).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters

SEGMENTS = ("root", "fillet", "involute", "tip")
FILLET_TABLE = 513
"""Points of the table that spreads the fillet's parameter by arc length; the points themselves stay exact."""


def polar(radius: ArrayLike, angle: ArrayLike) -> Floats:
    """Points (…, 2) from radii [mm] and polar angles [rad]."""
    r, theta = np.asarray(radius, dtype=float), np.asarray(angle, dtype=float)
    return np.stack([r * np.cos(theta), r * np.sin(theta)], axis=-1)


def mirror(points: Floats) -> Floats:
    """The points (…, 2) of the other half of the tooth: θ → −θ."""
    return np.asarray(points * np.array([1.0, -1.0]))


@dataclass(frozen=True)
class Profile:
    """Half profile of a gear's tooth sector, θ from π/z (cut) to 0 (tooth centre); all points (…, 2) in mm."""

    gear: GearParameters

    @property
    def sector_angle(self) -> float:
        """θ of the cut, π/z."""
        return math.pi / self.gear.z

    @property
    def radii(self) -> tuple[float, float, float]:
        """(root, form, tip) radius: root arc | fillet | involute | tip corner."""
        return self.gear.root_diameter / 2.0, self.gear.root_form_diameter / 2.0, self.gear.tip_diameter / 2.0

    @property
    def roll_lengths(self) -> tuple[float, float]:
        """ρ_y at the two ends of the involute, form circle and tip circle."""
        return self.gear.rack_form_roll_length, self.gear.roll_length(self.gear.tip_diameter)

    @property
    def tip_angle(self) -> float:
        """θ of the tip corner."""
        return self.gear.half_angle(self.gear.tip_diameter)

    @property
    def root_angle(self) -> float:
        """θ where fillet and root arc meet, ≤ π/z (equal: a full round root, no arc)."""
        return float(self._generated(math.pi / 2.0)[1])

    def angle(self, radius: ArrayLike) -> Floats:
        """θ(r) of the involute [rad], radii ≥ r_b [mm]."""
        return np.asarray(self._involute_angle(self.roll_length(radius)))

    def roll_length(self, radius: ArrayLike) -> Floats:
        """ρ(r) = √(r² − r_b²) [mm]."""
        r, base = np.asarray(radius, dtype=float), self.gear.base_radius
        return np.sqrt(np.maximum((r - base) * (r + base), 0.0))

    def radius(self, roll_length: ArrayLike) -> Floats:
        """r(ρ) = √(r_b² + ρ²) [mm]."""
        return np.hypot(self.gear.base_radius, np.asarray(roll_length, dtype=float))

    def _involute_angle(self, roll_length: Floats) -> Floats:
        tangent = roll_length / self.gear.base_radius
        return np.asarray(self.gear.base_half_angle - (tangent - np.arctan(tangent)))

    def involute(self, radius: ArrayLike) -> Floats:
        """Points of the exact involute at radii [mm]."""
        return polar(radius, self.angle(radius))

    def involute_at_roll(self, roll_length: ArrayLike) -> Floats:
        """Points of the exact involute at roll lengths ρ [mm] from the base tangent point."""
        rho = np.asarray(roll_length, dtype=float)
        return polar(self.radius(rho), self._involute_angle(rho))

    def normal(self, roll_length: ArrayLike) -> Floats:
        """Outward unit normals (…, 2) of the involute at roll lengths ρ: along the tangent to the base circle."""
        angle = self.gear.base_half_angle - np.asarray(roll_length, dtype=float) / self.gear.base_radius
        return np.stack([-np.sin(angle), np.cos(angle)], axis=-1)

    @cached_property
    def _rack_tip_centre(self) -> tuple[float, float]:
        """Centre of the tip circle in the rack's normal section: (half land, height over the pitch line ≤ 0)."""
        depth = (self.gear.reference_diameter - self.gear.root_diameter) / 2.0
        return self.gear.rack_tip_half_land, self.gear.rack_tip_radius - depth

    def _generated(self, direction: ArrayLike) -> tuple[Floats, Floats]:
        """(r, θ) cut by the rack tip's point whose normal stands at an angle from the pitch line, α_n to π/2.

        u is the tangential, v the radial coordinate from the pitch point in the rack's frame. The rack travels s while
        the gear turns by s/r; u, v cuts at s = v n_u/n_v − u, when its normal passes through the pitch point.
        """
        psi = np.asarray(direction, dtype=float)
        stretch, reference = math.cos(self.gear.helix_angle), self.gear.reference_diameter / 2.0
        land, height = self._rack_tip_centre
        u = -(land + self.gear.rack_tip_radius * np.cos(psi)) / stretch
        v = height - self.gear.rack_tip_radius * np.sin(psi)
        tangential = v * stretch * np.cos(psi) / np.sin(psi)  # u + s
        turn = (tangential - u) / reference
        radius = np.hypot(tangential, reference + v)
        return radius, np.asarray(self.sector_angle + np.arctan2(tangential, reference + v) - turn)

    @cached_property
    def _fillet_table(self) -> tuple[Floats, Floats]:
        """(arc length from the root arc [mm], direction of the rack tip's normal)."""
        psi = np.linspace(math.pi / 2.0, self.gear.normal_pressure_angle, FILLET_TABLE)
        steps = np.linalg.norm(np.diff(polar(*self._generated(psi)), axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)]), psi

    def fillet(self, t: ArrayLike) -> Floats:
        """Exact trochoid points at t ∈ [0, 1], by arc length from the root arc (0) to the form circle (1)."""
        length, psi = self._fillet_table
        return polar(*self._generated(np.interp(np.asarray(t, dtype=float) * length[-1], length, psi)))

    def root_arc(self, t: ArrayLike) -> Floats:
        """Points of the root circle at t ∈ [0, 1] from the cut θ = π/z to the fillet."""
        angle = self.sector_angle + np.asarray(t, dtype=float) * (self.root_angle - self.sector_angle)
        return polar(np.full_like(angle, self.radii[0]), angle)

    def flank(self, t: ArrayLike) -> Floats:
        """Exact involute points at t ∈ [0, 1], by arc length from the form circle to the tip corner."""
        start, end = self.roll_lengths
        squares = start**2 + np.asarray(t, dtype=float) * (end**2 - start**2)  # arc length is ρ² / 2r_b
        return self.involute_at_roll(np.sqrt(squares))

    def tip_arc(self, t: ArrayLike) -> Floats:
        """Points of the tip circle at t ∈ [0, 1] from the tip corner to the tooth's centre line."""
        angle = self.tip_angle * (1.0 - np.asarray(t, dtype=float))
        return polar(np.full_like(angle, self.radii[2]), angle)

    def segment(self, name: str, t: ArrayLike) -> Floats:
        """Points of one of SEGMENTS at fractions t ∈ [0, 1] of its arc length, in the order of the half profile."""
        curves = dict(zip(SEGMENTS, (self.root_arc, self.fillet, self.flank, self.tip_arc), strict=True))
        return curves[name](t)

    @property
    def arc_lengths(self) -> dict[str, float]:
        """Arc length [mm] of each of SEGMENTS."""
        root, _, tip = self.radii
        start, end = self.roll_lengths
        return {
            "root": root * (self.sector_angle - self.root_angle),
            "fillet": float(self._fillet_table[0][-1]),
            "involute": (end**2 - start**2) / (2.0 * self.gear.base_radius),
            "tip": tip * self.tip_angle,
        }

    def outline(self, points_per_segment: int = 33) -> Floats:
        """(n, 2) points of the whole sector's profile, θ from −π/z to π/z, for pictures and area integrals."""
        t = np.linspace(0.0, 1.0, points_per_segment)
        pieces = [self.segment(name, t)[int(i > 0) :] for i, name in enumerate(SEGMENTS)]
        half = np.concatenate(pieces)
        return np.concatenate([mirror(half), half[-2::-1]])
