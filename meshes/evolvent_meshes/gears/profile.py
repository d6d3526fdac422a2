"""Exact transverse profile of one tooth sector at mid-face, in the gear's frame.

The half profile at θ > 0 runs from the sector's cut at θ = π/z over root arc, fillet, involute, the edge of a chamfered
or rounded tip (`gears.form.tip_edge`) and tip arc to the tooth's centre line θ = 0 (`SEGMENTS`, in this order);
`mirror` gives the other half. The involute has no modifications; `evolvent_meshes.gears.flank` has them.

The fillet is cut by the tip of the generating rack, `evolvent_meshes.gears.form.rack_tip`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.form.tip_edge import TipEdge
from evolvent_meshes.gears.gear import GearParameters

SEGMENTS = ("root", "fillet", "involute", "edge", "tip")
FILLET_TABLE = 513
"""Points of the table of the fillet's arc length over its parameter; points of the fillet are exact."""


def polar(radius: ArrayLike, angle: ArrayLike) -> Floats:
    """Points (…, 2) [mm] at radii (…) [mm] and polar angles (…) [rad]."""
    r, theta = np.asarray(radius, dtype=float), np.asarray(angle, dtype=float)
    return np.stack([r * np.cos(theta), r * np.sin(theta)], axis=-1)


def mirror(points: Floats) -> Floats:
    """Mirror images (…, 2) of points (…, 2) on the other half of the tooth, θ → −θ."""
    return np.asarray(points * np.array([1.0, -1.0]))


@dataclass(frozen=True)
class Profile:
    """Half profile of a tooth sector, from θ = π/z (cut) to θ = 0 (centre of the tooth); points (…, 2) [mm].

    gear: the gear.
    """

    gear: GearParameters

    @property
    def sector_angle(self) -> float:
        """Angle θ of the cut, π/z [rad]."""
        return math.pi / self.gear.z

    @property
    def radii(self) -> tuple[float, float, float]:
        """Radii of the root, root form and tip circles [mm]."""
        return self.gear.root_diameter / 2.0, self.gear.root_form_diameter / 2.0, self.gear.tip_diameter / 2.0

    @property
    def roll_lengths(self) -> tuple[float, float]:
        """Roll lengths ρ at the root form circle and the tip form circle [mm]."""
        return self.gear.rack_form_roll_length, self.gear.roll_length(self.gear.tip_form_diameter)

    @property
    def tip_angle(self) -> float:
        """Angle θ at which the tip circle begins [rad]."""
        return self.gear.half_angle(self.gear.tip_diameter) if self.edge is None else self.edge.end[1]

    @property
    def edge(self) -> TipEdge | None:
        """Chamfer or rounding of the tip; None of a sharp one."""
        return self.gear.tip_edge

    @property
    def corner_radius(self) -> float:
        """Radius at which the mesh of the flank ends [mm]: of the tip circle, or on a rounding."""
        return self.gear.tip_diameter / 2.0 if self.edge is None else self.edge.corner[0]

    @property
    def root_angle(self) -> float:
        """Angle θ at which fillet and root arc meet [rad], at most π/z; π/z for a full round root without arc."""
        return float(self.gear.rack_tip.generated(math.pi / 2.0)[1])

    def angle(self, radius: ArrayLike) -> Floats:
        """Angles θ(r) (…) [rad] of involute, and chamfer or rounding of the tip, at radii r ≥ r_b (…) [mm]."""
        involute = self._involute_angle(self.roll_length(radius))
        if self.edge is None:
            return np.asarray(involute)
        return np.where(np.asarray(radius) > self.edge.form[0], self.edge.angle(radius), involute)

    def roll_length(self, radius: ArrayLike) -> Floats:
        """Roll lengths ρ(r) = √(r² − r_b²) (…) [mm] at radii (…) [mm]; 0 below the base circle."""
        r, base = np.asarray(radius, dtype=float), self.gear.base_radius
        return np.sqrt(np.maximum((r - base) * (r + base), 0.0))

    def radius(self, roll_length: ArrayLike) -> Floats:
        """Radii r(ρ) = √(r_b² + ρ²) (…) [mm] at roll lengths (…) [mm]."""
        return np.hypot(self.gear.base_radius, np.asarray(roll_length, dtype=float))

    def _involute_angle(self, roll_length: Floats) -> Floats:
        tangent = roll_length / self.gear.base_radius
        return np.asarray(self.gear.base_half_angle - (tangent - np.arctan(tangent)))

    def involute(self, radius: ArrayLike) -> Floats:
        """Points (…, 2) of the involute at radii (…) [mm]."""
        return polar(radius, self._involute_angle(self.roll_length(radius)))

    def involute_at_roll(self, roll_length: ArrayLike) -> Floats:
        """Points (…, 2) of the involute at roll lengths ρ (…) [mm]."""
        rho = np.asarray(roll_length, dtype=float)
        return polar(self.radius(rho), self._involute_angle(rho))

    def normal(self, roll_length: ArrayLike) -> Floats:
        """Outward unit normals (…, 2) of the involute at roll lengths ρ (…) [mm], tangent to the base circle."""
        angle = self.gear.base_half_angle - np.asarray(roll_length, dtype=float) / self.gear.base_radius
        return np.stack([-np.sin(angle), np.cos(angle)], axis=-1)

    @cached_property
    def _fillet_table(self) -> tuple[Floats, Floats]:
        """Arc lengths (n,) from the root arc [mm], and directions (n,) of the rack tip's normal [rad]."""
        ends = self.gear.form_direction
        psi = np.linspace(math.pi / 2.0, math.nan if ends is None else ends, FILLET_TABLE)
        steps = np.linalg.norm(np.diff(polar(*self.gear.rack_tip.generated(psi)), axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)]), psi

    def fillet(self, t: ArrayLike) -> Floats:
        """Points (…, 2) of the fillet at t ∈ [0, 1] (…), by arc length from the root arc to the root form circle."""
        length, psi = self._fillet_table
        return polar(*self.gear.rack_tip.generated(np.interp(np.asarray(t, dtype=float) * length[-1], length, psi)))

    def root_arc(self, t: ArrayLike) -> Floats:
        """Points (…, 2) of the root circle at t ∈ [0, 1] (…), from the cut θ = π/z to the fillet."""
        angle = self.sector_angle + np.asarray(t, dtype=float) * (self.root_angle - self.sector_angle)
        return polar(np.full_like(angle, self.radii[0]), angle)

    def involute_arc(self, t: ArrayLike) -> Floats:
        """Points (…, 2) of the involute at t ∈ [0, 1] (…), by arc length from root to tip form circle."""
        start, end = self.roll_lengths
        squares = start**2 + np.asarray(t, dtype=float) * (end**2 - start**2)  # arc length is ρ² / 2r_b
        return self.involute_at_roll(np.sqrt(squares))

    def edge_line(self, t: ArrayLike) -> Floats:
        """Points (…, 2) of chamfer or rounding with its chord at t ∈ [0, 1] (…), from the tip form circle to the tip
        circle; of a sharp tip its corner."""
        points = [polar(self.radii[2], self.tip_angle)] * 2
        if self.edge is not None:
            radii = self.edge.radii(FILLET_TABLE)
            points = [*polar(radii, self.edge.angle(radii)), points[0]]
        line = np.array(points)
        length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        wanted = np.asarray(t, dtype=float) * length[-1]
        return np.stack([np.interp(wanted, length, line[:, k]) for k in (0, 1)], axis=-1)

    def tip_arc(self, t: ArrayLike) -> Floats:
        """Points (…, 2) of the tip circle at t ∈ [0, 1] (…), from where it begins to the tooth's centre line."""
        angle = self.tip_angle * (1.0 - np.asarray(t, dtype=float))
        return polar(np.full_like(angle, self.radii[2]), angle)

    def segment(self, name: str, t: ArrayLike) -> Floats:
        """Points (…, 2) of one of SEGMENTS at t ∈ [0, 1] (…), by arc length in the direction of the half profile."""
        curves = self.root_arc, self.fillet, self.involute_arc, self.edge_line, self.tip_arc
        return dict(zip(SEGMENTS, curves, strict=True))[name](t)

    @property
    def arc_lengths(self) -> dict[str, float]:
        """Arc length [mm] of each of SEGMENTS."""
        root, _, tip = self.radii
        start, end = self.roll_lengths
        return {
            "root": root * (self.sector_angle - self.root_angle),
            "fillet": float(self._fillet_table[0][-1]),
            "involute": (end**2 - start**2) / (2.0 * self.gear.base_radius),
            "edge": 0.0 if self.edge is None else self.edge.length + self.edge.chord,
            "tip": tip * self.tip_angle,
        }

    def outline(self, points_per_segment: int = 33) -> Floats:
        """Points (n, 2) of the profile of the whole sector, θ from −π/z to π/z, for figures and area integrals."""
        t = np.linspace(0.0, 1.0, points_per_segment)
        shown = [name for name in SEGMENTS if name != "edge" or self.edge is not None]
        pieces = [self.segment(name, t)[int(i > 0) :] for i, name in enumerate(shown)]
        half = np.concatenate(pieces)
        return np.concatenate([mirror(half), half[-2::-1]])
