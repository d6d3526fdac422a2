"""Contact points of a line contact: Hertz' half-ellipse for the load per length and the curvature at each place.

So a position of a line contact has the form in which resolved ones are stored and evaluated. Places are the middles of
parts of the layers of the pinion's mesh, with the exact load on each.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np

from evolvent.contact.hertz import line_half_width
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.line.line_friction import direction_at
from evolvent.gears.line.line_result import LineResult
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

PARTS = 3
"""Parts of a layer of the pinion's mesh."""
ACROSS = 8
"""Points across a half-ellipse. The rule (Chebyshev's second kind) has its force and second moment exactly."""


@dataclass(frozen=True, eq=False)
class _Places:
    """Places (k,) along the contact lines that bear load."""

    tooth: Ints
    """Tooth pair."""
    z: Floats
    """Height [mm]."""
    length: Floats
    """Length of the line for which a place stands [mm; 1 in the plane]."""
    load: Floats
    """Load per length [N/mm]."""
    shift: Floats
    """Distance of the contact from the line of flanks without modifications, as of `LineGap` [mm]."""
    radius: Floats
    """Relative radius of curvature [mm]."""
    edge: Bools
    """Whether the place bears on the edge of a tip or near to it."""


def line_points(pair: GearPair, result: LineResult, heights: Floats | None, driving: Member) -> ContactPoints:
    """The contact of a position. heights: of the ends of the layers of the pinion's mesh (l + 1,) [mm]; None in the
    plane. driving: the gear that drives."""
    teeth = list(_places(result, heights))
    at = _Places(*(np.concatenate([getattr(each, f.name) for each in teeth]) for f in fields(_Places)))
    θ = np.arange(1, ACROSS + 1) * np.pi / (ACROSS + 1)
    half = line_half_width(at.load, at.radius, result.position.system.modulus)
    pressure = (2.0 * at.load / (np.pi * half))[:, None] * np.sin(θ)
    weights = (half * at.length)[:, None] * (np.pi / (ACROSS + 1) * np.sin(θ))
    across = (at.shift[:, None] + half[:, None] * np.cos(θ)).ravel()
    ξ = pair.roll_distance(result.position.stations.angle, at.tooth, at.z)
    direction = direction_at(pair, ξ, at.length, driving)
    columns = 1 if result.friction == 0.0 else 2 if heights is None else 3
    traction, rate = np.zeros((pressure.size, columns)), np.zeros((pressure.size, 2 if heights is None else 3))
    sliding = np.repeat((1.0 + 1.0 / pair.ratio) * ξ, ACROSS)
    traction[:, 0], rate[:, 1] = pressure.ravel(), sliding
    if columns > 1:
        traction[:, 1] = result.friction * (direction[:, None] * pressure).ravel()
    sticks = np.repeat((np.abs(direction) < 1.0) & (result.friction > 0.0), ACROSS)
    return ContactPoints(
        np.repeat(at.tooth, ACROSS), np.repeat(at.z, ACROSS), np.repeat(ξ, ACROSS), across, -across, weights.ravel(),
        traction, rate, sliding, sticks, np.repeat(at.edge, ACROSS),
    )


def _places(result: LineResult, heights: Floats | None) -> Iterator[_Places]:
    """Places of each tooth pair that bears."""
    stations, gap = result.position.stations, result.position.gap
    bears = result.position.bears_on_edge(result.equilibrium.load).astype(float)
    for tooth in result.teeth:
        of, at = stations.tooth == tooth, stations.point_tooth == tooth
        if heights is None:
            z, length, force = np.zeros(1), np.ones(1), np.array([result.force(tooth)])
        else:
            ends = _parts(heights, *stations.z[of][[0, -1]])
            z, length = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends) / result.cosine
            force = np.diff(result.force_below(tooth, ends))
        shift, radius, edge = (
            np.interp(z, stations.point_z[at], each[at]) for each in (gap.shift, gap.radius, bears)
        )
        k = force > 0.0
        load = force[k] / length[k]
        yield _Places(np.full(k.sum(), tooth), z[k], length[k], load, shift[k], radius[k], edge[k] > 0.0)


def _parts(heights: Floats, low: float, high: float) -> Floats:
    """Ends of the parts of layers between two heights [mm], ascending."""
    steps = np.arange(PARTS) / PARTS
    ends = np.append((heights[:-1, None] + np.diff(heights)[:, None] * steps).ravel(), heights[-1])
    return np.concatenate([[low], ends[(ends > low) & (ends < high)], [high]])
