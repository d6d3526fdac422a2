"""Depth of a modified flank below the involute helicoid, and its slopes, at roll lengths and heights.

Profile modifications depend on the roll length ρ (`GearGeometry.roll_length`), in which a tooth's contact moves evenly,
modifications of the lead on z, and twist on their product.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.modifications.modifications import Modifications

MICROMETRE = 1e-3
"""[mm]."""
Curve = tuple[Floats, Floats]
"""A modification [µm] and its derivative [µm/mm]."""


@dataclass(frozen=True)
class Kink:
    """Where a linear relief begins: a convex kink of the profile.

    relief: its term.
    roll_length: ρ [mm].
    turn: by how much the slope ∂c/∂ρ changes.
    """

    relief: str
    roll_length: float
    turn: float


@dataclass(frozen=True)
class FlankDepth:
    """Depth of a flank with modifications, defined beyond its edges too.

    given: the modifications.
    base_radius: r_b [mm].
    start: roll length at the profile control diameter [mm].
    tip: roll length at the tip circle [mm].
    face_width: b [mm].
    """

    given: Modifications
    base_radius: float
    start: float
    tip: float
    face_width: float

    def at(self, roll_length: Floats, z: Floats) -> Floats:
        """Material removed c (…) [mm], normal to the helicoid, at roll lengths and heights (…) [mm]."""
        share, height = self._twisted(roll_length, z)
        twist = self.given.twist_um * share * height + 0.25 * abs(self.given.twist_um)
        return np.asarray(MICROMETRE * (self._profile(roll_length)[0] + self._lead(z)[0] + twist))

    def slopes(self, roll_length: Floats, z: Floats) -> tuple[Floats, Floats]:
        """Slopes (∂c/∂ρ, ∂c/∂z) (…) at roll lengths and heights (…) [mm]."""
        (share, height), twist = self._twisted(roll_length, z), self.given.twist_um
        along_roll = self._profile(roll_length)[1] + twist * height / (self.tip - self.start)
        along_z = self._lead(z)[1] + twist * share / self.face_width
        return np.asarray(MICROMETRE * along_roll), np.asarray(MICROMETRE * along_z)

    @property
    def kinks(self) -> tuple[Kink, ...]:
        """Kinks along the profile, where linear reliefs of tip and root begin. That of a linear end relief is none of
        them: every contact line crosses it."""
        given, found = self.given, []
        if given.tip_relief_um and not given.tip_relief_parabolic:
            at = self._roll(given.tip_relief_start_diameter)
            found.append(Kink("tip relief", at, MICROMETRE * given.tip_relief_um / (self.tip - at)))
        if given.root_relief_um and not given.root_relief_parabolic:
            at = self._roll(given.root_relief_end_diameter)
            found.append(Kink("root relief", at, MICROMETRE * given.root_relief_um / (at - self.start)))
        return tuple(found)

    def _twisted(self, rho: Floats, z: Floats) -> tuple[Floats, Floats]:
        """Distances from the middle of the evaluated profile, over its length, and from mid-face, over its width."""
        middle, length = 0.5 * (self.start + self.tip), self.tip - self.start
        return (rho - middle) / length, z / self.face_width

    def _profile(self, rho: Floats) -> Curve:
        given, (low, high) = self.given, (self.start, self.tip)
        relief, end = self._roll(given.tip_relief_start_diameter), self._roll(given.root_relief_end_diameter)
        tip = _relief(given.tip_relief_um, rho - relief, high - relief, given.tip_relief_parabolic)
        root = _relief(given.root_relief_um, end - rho, end - low, given.root_relief_parabolic)
        crowning = _crowning(given.profile_crowning_um, rho - 0.5 * (low + high), high - low)
        slope = _slope(given.profile_slope_um, rho - 0.5 * (low + high), high - low)
        return tip[0] + root[0] + crowning[0] + slope[0], tip[1] - root[1] + crowning[1] + slope[1]

    def _lead(self, z: Floats) -> Curve:
        given, width = self.given, self.face_width
        crowning, slope = _crowning(given.lead_crowning_um, z, width), _slope(given.helix_slope_um, z, width)
        length = given.end_relief_length or 0.0
        end = _relief(given.end_relief_um, np.abs(z) - (0.5 * width - length), length, given.end_relief_parabolic)
        return crowning[0] + slope[0] + end[0], crowning[1] + slope[1] + np.sign(z) * end[1]

    def _roll(self, diameter: float | None) -> float:
        """Roll length at a diameter [mm]; 0 below the base circle, or where no relief begins."""
        return 0.0 if diameter is None else math.sqrt(max(0.0, (0.5 * diameter) ** 2 - self.base_radius**2))


def _relief(amount: float, distance: Floats, length: float, parabolic: bool) -> Curve:
    """From 0 at a distance of 0 and before it to the amount at the length."""
    if amount == 0.0:
        return np.zeros_like(distance), np.zeros_like(distance)
    share = np.maximum(distance, 0.0) / length
    if parabolic:
        return amount * share**2, 2.0 * amount * share / length
    return amount * share, np.where(share > 0.0, amount / length, 0.0)


def _crowning(amount: float, from_middle: Floats, length: float) -> Curve:
    """A parabola from 0 in the middle to the amount at both ends of the length."""
    share = 2.0 * from_middle / length
    return amount * share**2, 4.0 * amount * share / length


def _slope(amount: float, from_middle: Floats, length: float) -> Curve:
    """From 0 at the start of the length to the amount at its end; a negative one from its end to its start."""
    share = from_middle / length
    return amount * share + 0.5 * abs(amount), np.full_like(share, amount / length)
