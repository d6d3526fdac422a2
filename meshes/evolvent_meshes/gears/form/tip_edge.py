"""The edge between flank and tip circle in the transverse section: sharp, chamfered or rounded.

A chamfer is a straight line at 45° to the radius on which it begins. A rounding is an arc that touches flank and tip
circle. Both begin on the involute at the tip form diameter d_Fa (ISO 21771:2007, 4.5), where the active flank ends.

A mesh has a corner at the end of its flank, and none can be where an arc goes on smoothly. So the flank takes the first
`ON_FLANK` of a rounding's turn, about 20°, more than a mate's flank can reach, and a chord takes the rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from evolvent_meshes.arrays import Floats

ON_FLANK = 1.0 / 3.0
"""Fraction of a rounding's turn that the flank takes."""
CHAMFER = math.pi / 4.0
"""Angle between a chamfer and the radius on which it begins [rad]."""


@dataclass(frozen=True)
class TipEdge:
    """Edge of a tooth's tip at θ > 0, in polar coordinates."""

    form: tuple[float, float]
    """Radius [mm] and θ [rad] at the beginning of the edge, on the involute."""
    corner: tuple[float, float]
    """Radius [mm] and θ [rad] at the end of the flank's mesh."""
    end: tuple[float, float]
    """Radius [mm] and θ [rad] at the beginning of the tip circle."""
    centre: tuple[float, float] | None
    """Radius [mm] and θ [rad] of the centre of a rounding's arc; None of a chamfer."""
    radius: float
    """Radius of a rounding's arc [mm]; 0 of a chamfer."""

    @staticmethod
    def chamfered(form: tuple[float, float], tip: float) -> TipEdge:
        """A chamfer. form: radius and θ where it begins. tip: radius of the tip circle [mm]."""
        end = tip, form[1] + CHAMFER - math.acos(form[0] * math.cos(CHAMFER) / tip)
        return TipEdge(form, end, end, None, 0.0)

    @staticmethod
    def rounded(form: tuple[float, float], tip: float, base: float, radius: float) -> TipEdge:
        """A rounding of this radius. form, tip: as of `chamfered`. base: radius of the base circle [mm]."""
        roll = math.sqrt(form[0] ** 2 - base**2)
        γ = form[1] - math.atan(roll / base)  # of the involute's normal at the form circle
        centre = tip - radius, γ + math.atan((roll - radius) / base)
        begin = γ + math.pi / 2.0
        turned = begin + ON_FLANK * (centre[1] - begin)
        x = centre[0] * math.cos(centre[1]) + radius * math.cos(turned)
        y = centre[0] * math.sin(centre[1]) + radius * math.sin(turned)
        return TipEdge(form, (math.hypot(x, y), math.atan2(y, x)), (tip, centre[1]), centre, radius)

    def angle(self, radius: ArrayLike) -> Floats:
        """Angles θ (…) [rad] of the edge at radii (…) [mm] from the beginning to the corner."""
        r = np.asarray(radius, dtype=float)
        if self.centre is None:
            start, θ = self.form
            return np.asarray(θ + CHAMFER - np.arccos(np.clip(start * math.cos(CHAMFER) / r, -1.0, 1.0)))
        c, θ = self.centre
        return np.asarray(θ + np.arccos(np.clip((r**2 + c**2 - self.radius**2) / (2.0 * r * c), -1.0, 1.0)))

    @property
    def length(self) -> float:
        """Length of the edge from the beginning to the corner [mm]."""
        radii = self.radii(64)
        points = radii[:, None] * np.column_stack([np.cos(self.angle(radii)), np.sin(self.angle(radii))])
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    @property
    def chord(self) -> float:
        """Length of the chord from the corner to the tip circle [mm]."""
        (r, θ), (tip, end) = self.corner, self.end
        return math.sqrt(max(0.0, r**2 + tip**2 - 2.0 * r * tip * math.cos(θ - end)))

    def radii(self, count: int) -> Floats:
        """Radii (count + 1,) [mm] from the beginning to the corner, evenly along it."""
        share = np.linspace(0.0, 1.0, count + 1)
        first, last = (np.array([r * math.cos(θ), r * math.sin(θ)]) for r, θ in (self.form, self.corner))
        if self.centre is None:
            return np.asarray(np.linalg.norm(first + share[:, None] * (last - first), axis=1))
        c, θ = self.centre
        middle = np.array([c * math.cos(θ), c * math.sin(θ)])
        begin, stop = (math.atan2(*(point - middle)[::-1]) for point in (first, last))
        turned = begin + share * (stop - begin)
        arc = middle + self.radius * np.column_stack([np.cos(turned), np.sin(turned)])
        radii = np.linalg.norm(arc, axis=1)
        radii[[0, -1]] = self.form[0], self.corner[0]
        return np.asarray(radii)

    def drop(self, share: ArrayLike) -> Floats:
        """How far (…) the top of the tooth lies below its tip circle, over the depth of the corner below it, at shares
        (…) of the corner's θ, from -1 to 1; 1 where the corner is on the tip circle and nothing lies below it."""
        (r, corner), (tip, end) = self.corner, self.end
        if tip - r < 1e-12 * tip:
            return np.ones_like(np.asarray(share, dtype=float))
        θ = np.abs(np.asarray(share, dtype=float)) * corner
        first, last = (np.array([ρ * math.cos(φ), ρ * math.sin(φ)]) for ρ, φ in (self.corner, self.end))
        along = (last - first) / np.linalg.norm(last - first)
        normal = math.atan2(along[0], -along[1])  # of the chord
        distance = first @ [math.cos(normal), math.sin(normal)]
        top = np.where(θ > end, distance / np.cos(θ - normal), tip)
        return np.asarray((tip - top) / (tip - r))
