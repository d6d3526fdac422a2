"""The least gap of two exact flanks across their contact line, its place and the relative curvature there.

Across the line the gap is nearly a parabola, whose vertex the modifications move: a relief of 60 µm by half a
millimetre. Where the vertex lies beyond the tip's edge of one of the gears, that edge is the nearest point.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.line.stations import Stations
from evolvent.gears.unloaded_error import Facing, RigidFlanks
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

STEPS = (0.1, 0.1, 0.05, 0.05, 0.02, 0.02)
"""Distances of the three points through which a parabola is fitted, each about the vertex of the one before, over the
nominal relative radius of curvature. The points lie on both flanks."""
SMALLEST, FARTHEST = 1e-3, 4.0
"""Least such distance where the flanks have no room for it, and largest step to a vertex, over the distance."""
WITHIN = 0.3
"""Largest such distance over that from the base circle, where the involute ends."""
STRAIGHTEST = 0.1
"""Least curvature of a fitted parabola over that of the flanks without modifications, for the step to its vertex."""


@dataclass(frozen=True, eq=False)
class LineGap:
    """The gap at points (p,) of the contact lines."""

    gap: Floats
    """(p,) least gap along the normal [mm]."""
    shift: Floats
    """(p,) its distance from the line of flanks without modifications [mm of profile arc], positive towards the
    pinion's tip."""
    radius: Floats
    """(p,) relative radius of curvature there [mm]."""
    edge: Bools
    """(p,) whether the edge of a tip is nearest."""


def nominal_arcs(pair: GearPair, member: Member, roll_distance: Floats) -> Floats:
    """Profile arc ρ²/2r_b (p,) [mm] from a gear's base circle to the contact line of flanks without modifications, at
    roll distances (p,) [mm]."""
    roll = pair.pitch_point_roll_lengths[member] + member.sign * roll_distance
    return np.asarray(np.sign(roll) * roll**2 / (2.0 * pair.gears[member].base_radius))


def line_gap(flanks: RigidFlanks, stations: Stations, free: Member) -> LineGap:
    """Gap at the points of a position's lines, both gears at their nominal rotations. free: gear that turns under
    load."""
    pair, mate, ξ = flanks.pair, free.mate, stations.roll_distance
    inside = np.clip(ξ, *pair.path_of_contact)
    radius, arcs = pair.relative_curvature_radius(inside), {m: nominal_arcs(pair, m, ξ) for m in Member}
    low, high = _limits(pair, arcs, mate)
    gaps = gap_across(flanks, stations, free, arcs[mate])
    place = np.clip(np.zeros_like(radius), low, high)
    for step in STEPS:
        room = np.minimum(arcs[mate] + place, arcs[free] - place)
        h = np.clip(0.5 * (high - low), SMALLEST * radius, np.minimum(step * radius, WITHIN * room))
        middle = np.where(high - low > 2.0 * h, np.clip(place, low + h, high - h), 0.5 * (low + high))
        before, there, after = gaps(middle[:, None] + h[:, None] * np.array([-1.0, 0.0, 1.0])).T
        slope, curvature = (after - before) / (2.0 * h), (after - 2.0 * there + before) / h**2
        bent = np.maximum(curvature, STRAIGHTEST / radius)
        vertex = middle + np.clip(-slope / bent, -FARTHEST * h, FARTHEST * h)
        place = np.clip(vertex, low, high)
        move = place - middle
        least = there + slope * move + 0.5 * curvature * move**2
    edge = (vertex <= low) | (vertex >= high)
    return LineGap(least, mate.sign * place, np.where(edge, radius, 1.0 / bent), edge)


def _limits(pair: GearPair, arcs: dict[Member, Floats], mate: Member) -> tuple[Floats, Floats]:
    """Distances (p,) from the nominal line, towards the tip of `mate`, between which both flanks have points [mm]."""
    own, other = (np.square(Flank(gear).roll_lengths) / (2.0 * gear.base_radius) for gear in _own_first(pair, mate))
    low = np.maximum(own[0] - arcs[mate], arcs[mate.mate] - other[1])
    high = np.minimum(own[1] - arcs[mate], arcs[mate.mate] - other[0])
    return low, np.maximum(low, high)


def _own_first(pair: GearPair, member: Member) -> tuple[GearParameters, GearParameters]:
    """A gear and its mate."""
    return pair.gears[member], pair.gears[member.mate]


def gap_across(flanks: RigidFlanks, stations: Stations, free: Member, arc: Floats) -> Callable[[Floats], Floats]:
    """Function of distances (p, k) from the nominal line: gap (p, k) along the normal [mm]."""
    mate, pair = free.mate, flanks.pair
    teeth, row = np.unique(stations.point_tooth, return_inverse=True)
    facing = Facing.of_teeth(PairRotation(pair, stations.angle), teeth, free)[row]
    base, cosine = pair.gears[mate].base_radius, math.cos(pair.pinion.base_helix_angle)

    def gaps(distance: Floats) -> Floats:
        roll = np.sqrt(np.maximum(2.0 * base * (arc[:, None] + distance), 0.0))
        z = np.broadcast_to(stations.point_z[:, None], roll.shape)
        return flanks.extended_gap(facing, free, roll, z)[0] * cosine

    return gaps
