"""Where flank modifications move the contact from the line on which conjugate flanks touch."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

PLACES = 200
"""Places along the profile at which slopes of modifications are looked at."""
SAMPLES = 21
"""Places across a contact line of which the one with the least gap is taken, twice."""


@lru_cache(maxsize=16)
def farthest_moved(pair: GearPair) -> float:
    """Largest distance [mm of profile arc] by which flank modifications move the contact from the line of flanks
    without: the slope of a modification along the profile times the relative radius of curvature."""
    ξ = np.linspace(*pair.path_of_contact, PLACES)
    radius, moved = pair.relative_curvature_radius(ξ), 0.0
    for member, gear, pitch_point in zip(Member, pair.gears, pair.pitch_point_roll_lengths):
        roll, half = pitch_point + member.sign * ξ, 0.5 * gear.face_width
        slopes = gear.flank_depth.slopes(roll[:, None], np.array([[-half, 0.0, half]]))[0]
        moved += float(np.max(np.abs(slopes) * (radius * gear.base_radius / roll)[:, None]))
    return moved


def nearest_places(pair: GearPair, ξ: Floats, z: Floats, edges: tuple[Floats, Floats]) -> Floats:
    """Distances (h,) from the line of conjugate flanks to where flanks with modifications are nearest to each other
    [mm of profile arc], positive towards the pinion's tip: where c²/2ρ and the depths of both flanks are least. Where
    the line has left the flanks, that is near a tip edge.

    ξ, z: roll distances of the line and heights (h,) [mm].
    edges: distances (h,) to the ends of what both flanks share [mm].
    """
    low, high = edges
    nearest, farthest = np.minimum(np.maximum(low, 0.0), high), farthest_moved(pair)
    low, high = np.maximum(low, nearest - farthest), np.minimum(high, nearest + farthest)
    row = np.arange(len(z))
    for _ in range(2):  # the second time between the neighbours of the least one
        c = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, SAMPLES)
        k = np.argmin(_gap(pair, ξ[:, None], z[:, None], c), axis=1)
        low, high = c[row, np.maximum(k - 1, 0)], c[row, np.minimum(k + 1, SAMPLES - 1)]
    return np.asarray(c[row, k])


def _gap(pair: GearPair, ξ: Floats, z: Floats, c: Floats) -> Floats:
    """Distances (h, s) of the flanks at distances c (h, s) from lines with roll distances and heights (h, 1) [mm]."""
    conjugate = c**2 / (2.0 * pair.relative_curvature_radius(np.clip(ξ, *pair.path_of_contact)))
    return np.asarray(conjugate + modified_depth(pair, ξ, z, c))


def modified_depth(pair: GearPair, ξ: Floats, z: Floats, c: Floats) -> Floats:
    """Depth (…) that modifications of both flanks take away at distances c from lines with roll distances ξ and heights
    z [mm]."""
    depth = np.zeros(np.broadcast_shapes(np.shape(ξ), np.shape(z), np.shape(c)))
    for member, gear, pitch_point in zip(Member, pair.gears, pair.pitch_point_roll_lengths):
        arc = (pitch_point + member.sign * ξ) ** 2 / (2.0 * gear.base_radius) + member.sign * c
        depth += gear.flank_depth.at(np.sqrt(2.0 * gear.base_radius * np.maximum(arc, 0.0)), z)
    return depth
