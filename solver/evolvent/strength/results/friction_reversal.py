"""Where the histories of contact fatigue do not hold, as friction reverses while the contact passes."""

from __future__ import annotations

import numpy as np

from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

REACH = 2.0
"""Half-widths within which the contact makes most of the stress by friction at a point, across the contact line."""
SLIDES = 0.99
"""Share of μ from which on all of a slice slides."""


def flank_distance(pair: GearPair, member: Member, roll_distance: Floats) -> Floats:
    """Length (n,) [mm] along a gear's profile from the pitch point to the contact at roll distances ξ (n,) [mm],
    positive where the profile's radius of curvature ρ is larger: (ρ² − ρ(0)²)/(2 r_b), as an involute is ∫ ρ dρ/r_b
    long."""
    radius, at_pitch = (pair.curvature_radii(ξ)[member] for ξ in (roll_distance, np.zeros(1)))
    return np.asarray((radius**2 - at_pitch**2) / (2.0 * pair.gears[member].base_radius))


def passes_pitch_line(pair: GearPair, member: Member, loads: FlankLoads) -> Bools:
    """Points (n,) that lie within two half-widths of the contact as this passes the pitch line, where sliding reverses.
    """
    across = flank_distance(pair, member, loads.roll_distance) * np.cos(pair.gears[member].base_helix_angle)
    return np.asarray(np.abs(across) < REACH * loads.half_width)


def near_reversal(pair: GearPair, member: Member, loads: FlankLoads, friction: float) -> Bools:
    """Points (n,) whose history, that of the friction of one position, does not hold: the contact passes the pitch
    point, where sliding reverses, while it is within two half-widths of the point; or the slice does not slide as a
    whole. None without friction. friction: μ."""
    if friction == 0.0:
        return np.zeros(len(loads.peak), dtype=bool)
    return np.asarray(passes_pitch_line(pair, member, loads) | (loads.friction < SLIDES * friction))
