"""Tip-edge zones: the parts of the path of contact in which a tip edge bears and the pressure is singular.

Peak pressures are taken between these zones. A zone begins where the contact reaches the last row of facets before a
tip edge. On a helical pair the slices of a contact line enter it one after the other, so one of them always lies near
the zone's limit. On a spur pair all slices enter at once, between two positions: there the contact at the last position
outside is shifted, at constant width, until it reaches that row.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

AT_LIMIT = 0.01
"""A slice within this roll distance [mm] of a zone's limit lies at the limit. The limit is the place of a slice that
bears on the edge; with another mesh or friction coefficient that slice lies a micrometre beside it, and round-off must
not decide whether it counts."""

Cut = tuple[PositionResult, Slices]
"""A position and its slices."""


def path_between_zones(pair: GearPair, cuts: Sequence[Cut], rows: tuple[float, float]) -> tuple[float, float]:
    """Limits of the tip-edge zones: the roll distances [mm] between which no slice bears on a tip edge.

    cuts: all positions with their slices; rows: transverse curvature radii [mm] at which the last row of facets before
    the tip begins, of pinion and wheel (`FlankFacets.row_before_tip`).
    """
    start, end = pair.path_of_contact
    if pair.pinion.base_helix_angle == 0.0:
        first, last = (_spur_limit(pair, cuts, rows, gear) for gear in (Member.WHEEL, Member.PINION))
        return max(start, -first), min(end, last)
    edges = np.concatenate([cut.roll_distance[cut.edge] for _, cut in cuts])
    return float(edges[edges < 0.0].max(initial=start)), float(edges[edges > 0.0].min(initial=end))


def _spur_limit(pair: GearPair, cuts: Sequence[Cut], rows: tuple[float, float], gear: Member) -> float:
    """Limit of a spur pair's zone in which this gear's tip bears, as a distance from the pitch point [mm]; infinite
    where the tip never bears. It lies between the outermost slice that does not bear and the innermost that does."""
    slices = [
        (gear.sign * float(ξ), result, cut, k)
        for result, cut in cuts for k, ξ in enumerate(cut.roll_distance) if gear.sign * ξ > 0.0
    ]
    edge = min((distance for distance, _, cut, k in slices if cut.edge[k]), default=np.inf)
    outside = [each for each in slices if each[0] < edge]
    if edge == np.inf or not outside:
        return edge
    last = max(distance for distance, *_ in outside)
    reached = min(_reached(pair, result, cut, k, gear, rows[gear]) for x, result, cut, k in outside if x == last)
    return float(np.clip(reached, last + min(2.0 * AT_LIMIT, 0.5 * (edge - last)), edge))


def _reached(pair: GearPair, result: PositionResult, cut: Slices, k: int, gear: Member, row: float) -> float:
    """Distance from the pitch point [mm] at which the contact of slice k, shifted at constant width, reaches the row of
    facets that begins at the curvature radius `row`: arc lengths of an involute grow with the square of that radius."""
    c = result.contact
    here = (c.tooth == cut.tooth[k]) & (np.abs(c.z - cut.z[k]) <= 0.5 * cut.width[k])
    outermost = float((c.across, c.opposite)[gear][here].max())
    squared = row**2 - 2.0 * pair.gears[gear].base_radius * outermost
    return float(np.sqrt(max(squared, 0.0))) - pair.pitch_point_roll_lengths[gear]
