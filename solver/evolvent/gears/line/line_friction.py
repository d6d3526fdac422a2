"""Friction of a line contact in the direction of sliding, which is known: it reverses at the pitch point.

The flanks of a pair slide in the transverse section, along the profile, by (1 + 1/u) ξ per radian of the pinion
(ISO 21771:2007), ξ the roll distance from the pitch point. Where the pinion drives, friction acts towards the tips on
both gears at ξ > 0, towards the roots at ξ < 0; where the wheel drives, the other way round. With a load q per length
and Coulomb's μ it is μ q, and the torques of pinion and wheel over their base radii are

    Σ_j q_j (H_j + μ M_1j),   Σ_j q_j (H_j + μ M_2j),      M_kj = ∫ h_j d (ρ_k / r_bk) ds

with the hats h_j of `Stations`, the direction d of −1 or 1 and the roll lengths of the contact on both gears,
ρ_1 = r_b1 tan α_wt + ξ and ρ_2 = r_b2 tan α_wt − ξ. The driving gear's power exceeds the other one's by that of
friction, μ ∫ q |ξ| (1 + 1/u) ds per radian of the pinion, at each position.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent.gears.line.stations import Stations
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

AT_PITCH_POINT = 1e-9
"""Roll distance over the normal module up to which a point lies at the pitch point, where friction keeps its former
direction."""


@dataclass(frozen=True, eq=False)
class LineFriction:
    """Friction at a position of m stations, for each unit of the friction coefficient."""

    direction: Floats
    """(p,) direction of friction at the points of the stations, see `direction_at`."""
    compliance: Floats
    """(m, m) work of normal displacements under tangential loads [mm² per N·mm], added to B."""
    moments: tuple[Floats, Floats]
    """(m,) moments M of a unit load per length about the axes of pinion and wheel, over their base radii [mm]."""
    sliding: Floats
    """(m,) sliding velocity per radian of the pinion under each hat, times its integral [mm²/rad]."""


def sliding_direction(pair: GearPair, stations: Stations, driving: Member) -> Floats:
    """Direction (p,) of friction at the points of the stations, see `direction_at`."""
    return direction_at(pair, stations.roll_distance, stations.point_lengths, driving)


def direction_at(pair: GearPair, roll_distance: Floats, length: Floats, driving: Member) -> Floats:
    """Direction (p,) of friction at roll distances (p,) [mm]: 1 towards the tips of both gears, −1 towards their roots.
    A point stands for a `length` (p,) of the line [mm]; where the pitch point lies in it, this is the mean. driving:
    the gear that drives."""
    ξ, least = driving.sign * roll_distance, AT_PITCH_POINT * pair.pinion.normal_module
    half = np.maximum(0.5 * math.sin(pair.pinion.base_helix_angle) * length, least)
    return np.asarray(np.where((half > least) & (np.abs(ξ) < half), ξ / half, np.where(ξ > least, 1.0, -1.0)))


def line_friction(
    pair: GearPair, stations: Stations, direction: Floats, compliance: Floats, driving: Member
) -> LineFriction:
    """Friction at a position. direction: (p,) of `sliding_direction`. compliance: (m, m) of `friction_compliance`.
    driving: the gear that drives."""
    ξ, hats = stations.roll_distance, stations.hats
    rolls = [pair.pitch_point_roll_lengths[gear] + gear.sign * ξ for gear in Member]
    pinion, wheel = (np.asarray(hats.T @ (direction * ρ)) / gear.base_radius for ρ, gear in zip(rolls, pair.gears))
    sliding = driving.sign * np.asarray(hats.T @ (direction * ξ)) * (1.0 + 1.0 / pair.ratio)
    return LineFriction(direction, compliance, (pinion, wheel), sliding)
