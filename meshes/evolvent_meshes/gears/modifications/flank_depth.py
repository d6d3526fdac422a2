"""Depth of a modified flank below the involute helicoid, and its slopes, at roll lengths and heights.

Profile modifications depend on the roll length ρ (`GearGeometry.roll_length`), in which a tooth's contact moves evenly,
modifications of the lead on z, and twist on their product.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.modifications.modifications import Modifications

MICROMETRE = 1e-3
"""Micrometre [mm]."""
Order = Literal[0, 1]
"""Order of a derivative: 0: a modification [µm], 1: its derivative [µm/mm]."""


@dataclass(frozen=True)
class Kink:
    """Convex kink of the profile where a linear relief begins.

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
        total = np.zeros(np.broadcast_shapes(np.shape(roll_length), np.shape(z)))
        for each in (*self._profile(roll_length, 0), *self._lead(z, 0)):
            total += each
        if twist := self.given.twist_um:
            total += twist * self._share(roll_length) * (z / self.face_width) + 0.25 * abs(twist)
        return np.asarray(MICROMETRE * total)

    def slopes(self, roll_length: Floats, z: Floats) -> tuple[Floats, Floats]:
        """Slopes (∂c/∂ρ, ∂c/∂z) (…) at roll lengths and heights (…) [mm]."""
        along_roll, along_z = np.zeros((2, *np.broadcast_shapes(np.shape(roll_length), np.shape(z))))
        for each in self._profile(roll_length, 1):
            along_roll += each
        for each in self._lead(z, 1):
            along_z += each
        if twist := self.given.twist_um:
            along_roll += twist / (self.tip - self.start) * (z / self.face_width)
            along_z += twist / self.face_width * self._share(roll_length)
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

    def _share(self, rho: Floats) -> Floats:
        """Distance from the middle of the evaluated profile, over its length."""
        return (rho - 0.5 * (self.start + self.tip)) / (self.tip - self.start)

    def _profile(self, rho: Floats, order: Order) -> Iterator[Floats]:
        """Modifications of the profile that there are."""
        given, (low, high), length = self.given, (self.start, self.tip), self.tip - self.start
        if given.tip_relief_um:
            begin = self._roll(given.tip_relief_start_diameter)
            yield _relief(given.tip_relief_um, rho - begin, high - begin, given.tip_relief_parabolic, order)
        if given.root_relief_um:
            end, sign = self._roll(given.root_relief_end_diameter), 1.0 - 2.0 * order
            yield sign * _relief(given.root_relief_um, end - rho, end - low, given.root_relief_parabolic, order)
        if given.profile_crowning_um:
            yield _crowning(given.profile_crowning_um, self._share(rho), length, order)
        if given.profile_slope_um:
            yield _slope(given.profile_slope_um, self._share(rho), length, order)

    def _lead(self, z: Floats, order: Order) -> Iterator[Floats]:
        """Modifications of the lead that there are."""
        given, width = self.given, self.face_width
        if given.lead_crowning_um:
            yield _crowning(given.lead_crowning_um, z / width, width, order)
        if given.helix_slope_um:
            yield _slope(given.helix_slope_um, z / width, width, order)
        if given.end_relief_um:
            length = given.end_relief_length or 0.0
            sign, distance = np.sign(z) ** order, np.abs(z) - (0.5 * width - length)
            yield sign * _relief(given.end_relief_um, distance, length, given.end_relief_parabolic, order)

    def _roll(self, diameter: float | None) -> float:
        """Roll length at a diameter [mm]; 0 below the base circle, or where no relief begins."""
        return 0.0 if diameter is None else math.sqrt(max(0.0, (0.5 * diameter) ** 2 - self.base_radius**2))


def _relief(amount: float, distance: Floats, length: float, parabolic: bool, order: Order) -> Floats:
    """Relief or its derivative: 0 up to a distance of 0, and from there to the amount at the length."""
    share = np.maximum(distance, 0.0) / length
    if order:
        return np.asarray(amount / length * (2.0 * share if parabolic else share > 0.0))
    return np.asarray(amount * (share**2 if parabolic else share))


def _crowning(amount: float, share: Floats, length: float, order: Order) -> Floats:
    """A parabola from 0 in the middle to the amount at both ends. share: distance from the middle over the length."""
    return 8.0 * amount / length * share if order else 4.0 * amount * share**2


def _slope(amount: float, share: Floats, length: float, order: Order) -> Floats:
    """Slope modification or its derivative: from 0 at the start of the length to the amount at its end; a negative one
    from its end to its start."""
    return np.full_like(share, amount / length) if order else amount * share + 0.5 * abs(amount)
