"""The least gap of two exact flanks across their contact line, its place and the relative curvature there.

Across the line the gap is nearly a parabola, whose vertex the modifications move: a relief of 60 µm by half a
millimetre. Where the vertex lies beyond the tip's edge of one of the gears, that edge is the nearest point. At the kink
where a linear relief starts the gap is a parabola over the width of the contact only: it is fitted there again for
each load.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.line.stations import Stations
from evolvent.gears.pressure.relief_starts import kinks
from evolvent.gears.unloaded_error import Facing, RigidFlanks
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

STEPS = (0.1, 0.1, 0.05, 0.05, 0.02, 0.02)
"""Distances of the three points through which a parabola is fitted, each about the vertex of the one before, over the
nominal relative radius of curvature. The points lie on both flanks."""
SMALLEST, FARTHEST = 1e-3, 4.0
"""Least such distance where the flanks have no room for it, and largest step to a vertex, over the distance."""
WITHIN = 0.3
"""Largest such distance over that from the base circle, where the involute ends."""
SAMPLES, ZOOMS = 17, 5
"""Samples of the gap by which its least value is found, and how often about the least one: 8 mm to 0.25 µm."""
STRAIGHTEST = 0.1
"""Least curvature of a fitted parabola over that of the flanks without modifications, for the step to its vertex."""


Across = Callable[..., Floats]
"""Function of distances (p, k) and of indices (p,): see `gap_across`."""


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
    """(p,) whether the end of a flank is nearest: the edge of a tip, or of the mate's where the root side ends."""


def nominal_arcs(pair: GearPair, member: Member, roll_distance: Floats) -> Floats:
    """Profile arc ρ²/2r_b (p,) [mm] from a gear's base circle to the contact line of flanks without modifications, at
    roll distances (p,) [mm]."""
    roll = pair.pitch_point_roll_lengths[member] + member.sign * roll_distance
    return np.asarray(np.sign(roll) * roll**2 / (2.0 * pair.gears[member].base_radius))


@dataclass(frozen=True, eq=False)
class GapProfile:
    """The gap across the contact lines at points (p,), both gears at their nominal rotations. Distances are from the
    line of flanks without modifications [mm of profile arc], positive towards the pinion's tip."""

    across: Across
    """Function of distances (p, k): gap (p, k) along the normal [mm]; of those of some rows with their indices."""
    low: Floats
    """(p,) least distance at which both flanks have points."""
    high: Floats
    """(p,) largest distance at which both flanks have points."""
    room: Floats
    """(p, 2) distance of the line from the base circles of pinion and wheel [mm of profile arc]."""
    radius: Floats
    """(p,) relative radius of curvature of flanks without modifications [mm]."""
    kinked: bool
    """Whether a flank has kinks, where a linear relief starts or in a chart."""

    @staticmethod
    def of(flanks: RigidFlanks, stations: Stations, free: Member) -> GapProfile:
        """The gap at the points of a position's lines. free: gear that turns under load."""
        pair, ξ = flanks.pair, stations.roll_distance
        pinion, wheel = (nominal_arcs(pair, member, ξ) for member in Member)
        ends = [np.square(Flank(gear).roll_lengths) / (2.0 * gear.base_radius) for gear in pair.gears]
        low = np.maximum(ends[0][0] - pinion, wheel - ends[1][1])
        high = np.maximum(low, np.minimum(ends[0][1] - pinion, wheel - ends[1][0]))
        radius = pair.relative_curvature_radius(np.clip(ξ, *pair.path_of_contact))
        across = gap_across(flanks, stations, free)
        return GapProfile(across, low, high, np.column_stack([pinion, wheel]), radius, _kinked(flanks))

    def least(self) -> LineGap:
        """The least gap, by fits each about the vertex of the one before; where the flanks have kinks, which fits
        would miss, from the least sample on."""
        place = self._least_sample() if self.kinked else np.clip(np.zeros_like(self.radius), self.low, self.high)
        for step in STEPS[-1:] if self.kinked else STEPS:
            found = self.fitted(place, step * self.radius)
            place = found.shift
        return found

    def _least_sample(self) -> Floats:
        """Distances (p,) of the least gap, by samples each about the least one of those before. The gap is convex."""
        low, high = self.low, self.high
        share, rows = np.linspace(0.0, 1.0, SAMPLES), np.arange(len(low))
        for _ in range(ZOOMS):
            places = low[:, None] + (high - low)[:, None] * share
            i = self.across(places).argmin(axis=1)
            low, high = places[rows, np.maximum(i - 1, 0)], places[rows, np.minimum(i + 1, SAMPLES - 1)]
        return np.asarray(places[rows, i])

    def fitted(self, place: Floats, reach: Floats) -> LineGap:
        """The least gap by a parabola through three points about a distance (p,), `reach` (p,) [mm] apart, as far as
        both flanks have them."""
        room = WITHIN * np.minimum(self.room[:, 0] + place, self.room[:, 1] - place)
        h = np.clip(0.5 * (self.high - self.low), SMALLEST * self.radius, np.minimum(reach, room))
        inner = self.high - self.low > 2.0 * h
        middle = np.where(inner, np.clip(place, self.low + h, self.high - h), 0.5 * (self.low + self.high))
        before, there, after = self.across(middle[:, None] + h[:, None] * np.array([-1.0, 0.0, 1.0])).T
        slope, curvature = (after - before) / (2.0 * h), (after - 2.0 * there + before) / h**2
        bent = np.maximum(curvature, STRAIGHTEST / self.radius)
        vertex = middle + np.clip(-slope / bent, -FARTHEST * h, FARTHEST * h)
        shift = np.clip(vertex, self.low, self.high)
        move, edge = shift - middle, (vertex <= self.low) | (vertex >= self.high)
        least = there + slope * move + 0.5 * curvature * move**2
        return LineGap(least, shift, np.where(edge, self.radius, 1.0 / bent), edge)


def _kinked(flanks: RigidFlanks) -> bool:
    """Whether flanks have kinks."""
    return bool(kinks(flanks.pair)) or any(chart is not None for chart in flanks.charts)


def gap_across(flanks: RigidFlanks, stations: Stations, free: Member) -> Across:
    """Function of distances (p, k) from the nominal line, towards the pinion's tip, and of the indices (p,) of their
    points, by default all: gap (p, k) along the normal [mm]."""
    mate, pair = free.mate, flanks.pair
    teeth, row = np.unique(stations.point_tooth, return_inverse=True)
    facing = Facing.of_teeth(PairRotation(pair, stations.angle), teeth, free)[row]
    base, cosine = pair.gears[mate].base_radius, math.cos(pair.pinion.base_helix_angle)
    arc = nominal_arcs(pair, mate, stations.roll_distance)

    def gaps(distance: Floats, rows: Ints | None = None) -> Floats:
        own = np.arange(len(arc)) if rows is None else rows
        roll = np.sqrt(np.maximum(2.0 * base * (arc[own, None] + mate.sign * distance), 0.0))
        z = np.broadcast_to(stations.point_z[own, None], roll.shape)
        turned = Facing(facing.turn[own], facing.shift[own])
        return flanks.extended_gap(turned, free, roll, z)[0] * cosine

    return gaps
