"""Starts of linear tip and root reliefs of a spur pair, and the contacts that cover them.

There the flank has a convex kink by the angle 2α. A contact covers it while the kink lies between the contact's rims.
On the side of the flank without relief these are ±b about the nominal contact line, b Hertz' half-width for the load.
On the relieved side the flank is turned by 2α and touches where its normal is along the line of action, 2αR nearer to
the kink (R: relative radius of curvature), so that the contact leaves the kink at b + 2αR. Outside, the pressure is
that of Hertz (tests/solver/gears/pressure/test_relief_starts.py). The mesh rounds the kink within the facet in which it
lies: one facet is added on either side.

The contact line of a helical pair crosses the kink at every position, in some slices; none of them is marked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

STEPS = 8
"""Fixed-point steps in which the limit of a zone is found: each reduces the error to a tenth or less, by as much as the
contact's width changes over its reach."""


@dataclass(frozen=True)
class ReliefStart:
    """Start of a linear tip or root relief."""

    member: Member
    """The gear with the relief."""
    relief: str
    """Tip relief or root relief."""
    roll_distance: float
    """Roll distance ξ of the kink from the pitch point [mm]."""
    towards: int
    """Sign of ξ − ξ_kink on the relieved side."""
    angle: float
    """Angle of the kink 2α [rad]."""
    roll: float
    """Derivative of ξ by the flank's arc length."""

    def reach(self, contact: ContactWidth, side: int) -> Floats:
        """Distance in ξ (n,) [mm] up to which contacts cover the kink. side: 1 the relieved side, −1 the other one."""
        turned = contact.radius * self.angle if side > 0 else 0.0
        return np.asarray(self.roll * (contact.half_width + turned + contact.facet[:, self.member]))

    def covered(self, contact: ContactWidth) -> Bools:
        """Whether contacts (n,) cover the kink: (n,) bool."""
        away = self.towards * (contact.roll_distance - self.roll_distance)
        return np.asarray((-self.reach(contact, -1) < away) & (away < self.reach(contact, 1)))


@dataclass(frozen=True, eq=False)
class ContactWidth:
    """Widths of n line contacts of a spur pair."""

    roll_distance: Floats
    """Roll distance ξ (n,) of the nominal contact line from the pitch point [mm]."""
    half_width: Floats
    """Hertz' half-width b (n,) for the line load [mm]."""
    radius: Floats
    """Relative radius of curvature R (n,) [mm]."""
    facet: Floats
    """Arc lengths (n, 2) of the facets of pinion and wheel there [mm]."""

    def at(self, x: float) -> ContactWidth:
        """The contact at a roll distance x [mm], interpolated; roll distances are ascending."""
        ξ = self.roll_distance
        half_width, radius, *facet = (
            np.interp([x], ξ, each) for each in (self.half_width, self.radius, *self.facet.T)
        )
        return ContactWidth(np.array([x]), half_width, radius, np.column_stack(facet))


def relief_starts(pair: GearPair) -> tuple[ReliefStart, ...]:
    """The places of a spur pair; empty for a helical pair. Wear and measured flanks do not change them."""
    return () if pair.pinion.base_helix_angle != 0.0 else kinks(pair)


def kinks(pair: GearPair) -> tuple[ReliefStart, ...]:
    """The places of a spur or helical pair."""
    found = []
    for member, gear, pitch_point in zip(Member, pair.gears, pair.pitch_point_roll_lengths):
        for kink in gear.flank_depth.kinks:
            roll = gear.base_radius / kink.roll_length  # an involute's arc is ρ²/2r_b
            ξ, outward = member.sign * (kink.roll_length - pitch_point), 1 if kink.relief == "tip relief" else -1
            found.append(ReliefStart(member, kink.relief, ξ, member.sign * outward, kink.turn * roll, roll))
    return tuple(found)


def over_relief_starts(pair: GearPair, contact: ContactWidth) -> Bools:
    """Whether contacts (n,) cover the start of a relief: (n,) bool."""
    return covering(relief_starts(pair), contact)


def covering(starts: Sequence[ReliefStart], contact: ContactWidth) -> Bools:
    """Whether contacts (n,) cover one of some kinks: (n,) bool."""
    covered = [start.covered(contact) for start in starts]
    return np.any([np.zeros(len(contact.roll_distance), dtype=bool), *covered], axis=0)


def zone_limits(pair: GearPair, contact: ContactWidth) -> list[float]:
    """Roll distances [mm] at which a contact begins to cover the start of a relief or ceases to.

    contact: at ascending roll distances. Limits beyond these and limits at which another start is covered are left out.
    """
    found, ξ = [], contact.roll_distance
    for start in relief_starts(pair):
        others = [other for other in relief_starts(pair) if other != start]
        for side in (-1, 1):
            x = start.roll_distance
            for _ in range(STEPS):
                x = start.roll_distance + side * start.towards * float(start.reach(contact.at(x), side)[0])
            if ξ[0] < x < ξ[-1] and not any(other.covered(contact.at(x))[0] for other in others):
                found.append(x)
    return found
