"""The part of the flanks that is searched: a window about each contact line on the path of contact or near it."""

from __future__ import annotations

import numpy as np

from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.kinematics import PairRotation
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member

EXTENSION = 0.5  # [module of ξ] beyond the path of contact, where deflection may keep tip edges in contact


def arc_distance(pinion: GearBody, stand: PairRotation, tooth: Ints | int, node: Ints) -> Floats:
    """Distance [mm of profile arc] of pinion flank nodes from their slice's contact line; where that has left the
    flank, from the flank's end on that side."""
    pair, base = stand.pair, pinion.gear.base_radius
    ρ = pinion.roll_length
    ρ_line = pair.pitch_point_roll_lengths[Member.PINION] + pair.roll_distance(stand.angle, tooth, pinion.z[node])
    start, end = pair.path_of_contact
    low, high = (pair.pitch_point_roll_lengths[Member.PINION] + ξ for ξ in (start, end))
    return np.abs(ρ[node] ** 2 - np.clip(ρ_line, low, high) ** 2) / (2.0 * base)


def placed_flanks(bodies: tuple[GearBody, ...], stand: PairRotation, tooth: int) -> tuple[Surface, Surface]:
    """The flanks of a tooth pair, pinion's and wheel's, in the common frame."""
    d = bodies[Member.PINION].d
    first, second = (
        body.flank.moved(stand.rotation(gear, d, tooth), stand.centre(gear, d)) for gear, body in zip(Member, bodies)
    )
    return first, second


def facets_in_window(pinion: GearBody, stand: PairRotation, tooth: int, half_width: float) -> Bools:
    """Facets (m,) bool of the pinion that have a node within the window."""
    near = _near_line(pinion, stand, tooth, half_width)
    return np.asarray(near[pinion.flank.facets].any(axis=1))


def _near_line(pinion: GearBody, stand: PairRotation, tooth: int, half_width: float) -> Bools:
    """Flank nodes (n,) bool within the window; all where its half-width is infinite."""
    every = np.arange(len(pinion.flank.points))
    if np.isinf(half_width):
        return np.ones(len(every), dtype=bool)
    return (arc_distance(pinion, stand, tooth, every) <= half_width) & near_path(stand, tooth, pinion.z)


def near_path(stand: PairRotation, tooth: int, z: Floats) -> Bools:
    """Heights z (h,) bool at which the contact line of a tooth pair is on the path of contact, or near enough its ends
    that deflection can bring the tip's edge into contact."""
    start, end = stand.pair.path_of_contact
    ξ = stand.roll_distance(tooth, z)
    beyond = EXTENSION * stand.pair.pinion.normal_module
    return np.asarray((ξ > start - beyond) & (ξ < end + beyond))
