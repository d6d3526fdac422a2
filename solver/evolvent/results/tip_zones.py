"""Where the zones begin in which a tip's edge bears: between them lie the pressures that a run's figures are of.

A zone begins where the contact reaches the last row of facets before an edge. A helical line's slices enter it one
after the other, so one of them is always near its end. A spur pair's enter it all at once, between two positions: there
the contact of the last position outside is moved on, as wide as it is, until it reaches the row.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evolvent.gears.sweep.position import PositionResult
from evolvent.results.contact_slices import Slices
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

AT_THE_END = 0.01
"""Roll distance [mm] within which a slice is at the end of a tip-edge zone. An end is the place of a slice that bears
on the edge; at the same position another mesh or friction coefficient has its own a micrometre beside it, and
round-off must not decide whether that counts."""

Cut = tuple[PositionResult, Slices]
"""A position and its slices."""


def path_between_zones(pair: GearPair, cuts: Sequence[Cut], rows: tuple[float, float]) -> tuple[float, float]:
    """Roll distances [mm] between which no slice bears on a tip edge. rows: transverse curvature radii [mm] at which
    the last row of facets before the tip begins, pinion and wheel."""
    start, end = pair.path_of_contact
    if pair.pinion.base_helix_angle == 0.0:
        first, last = (_beginning(pair, cuts, rows, gear) for gear in (Member.WHEEL, Member.PINION))
        return max(start, -first), min(end, last)
    edges = np.concatenate([cut.ξ[cut.edge] for _, cut in cuts])
    return float(edges[edges < 0.0].max(initial=start)), float(edges[edges > 0.0].min(initial=end))


def _beginning(pair: GearPair, cuts: Sequence[Cut], rows: tuple[float, float], gear: Member) -> float:
    """Of the zone of a spur pair in which this gear's tip bears: the distance from the pitch point [mm] towards it,
    infinite where it never does. At most the one of the nearest slice that bears, and more than those of all nearer
    ones."""
    slices = [
        (gear.sign * float(ξ), result, cut, k)
        for result, cut in cuts for k, ξ in enumerate(cut.ξ) if gear.sign * ξ > 0.0
    ]  # fmt: skip
    edge = min((distance for distance, _, cut, k in slices if cut.edge[k]), default=np.inf)
    outside = [each for each in slices if each[0] < edge]
    if edge == np.inf or not outside:
        return edge
    last = max(distance for distance, *_ in outside)
    reached = min(_reached(pair, result, cut, k, gear, rows[gear]) for x, result, cut, k in outside if x == last)
    return float(np.clip(reached, last + min(2.0 * AT_THE_END, 0.5 * (edge - last)), edge))


def _reached(pair: GearPair, result: PositionResult, cut: Slices, k: int, gear: Member, row: float) -> float:
    """The distance from the pitch point [mm] at which the contact of a slice would reach the row that begins at the
    curvature radius `row`: arcs of an involute go with the square of these radii."""
    c = result.contact
    here = (c.tooth == cut.tooth[k]) & (np.abs(c.z - cut.z[k]) <= 0.5 * cut.width[k])
    outermost = float((c.across, c.opposite)[gear][here].max())
    squared = row**2 - 2.0 * pair.gears[gear].base_radius * outermost
    return float(np.sqrt(max(squared, 0.0))) - pair.pitch_point_roll_lengths[gear]


def row_before_tip(roll_lengths: Floats, order: int) -> float:
    """The curvature radius [mm] at which the last row of facets of this order begins, from those of a flank's nodes."""
    return float(np.unique(np.round(roll_lengths, 9))[-1 - order])
