"""Compliance near the ends of the face that neither a half-space nor the meshes of a line contact have.

A load per length q in front of the end of a body finds less material around it. What the meshes do not resolve of that,
between their half-width w and that of the contact, b, is

    (2/(π E*)) q κ ln[(d' + √(d'² + w²)) / (d' + √(d'² + b²))],      d' = 1.5 d

at a distance d from the end, for each body in its part of 1/E*. Beside an upright end, loads and their mirror images
leave no shear on it (Hetényi's method for the quarter-space); the normal stress that they leave there makes the body
softer, and more so where the edge is acute. The law and κ are fitted to finite element bodies
(`evidence/benchmarks/line/face_ends.py`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.fem.material import Material
from evolvent.gears.line.stations import Stations
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

REACH = 1.5
"""Distance d' over the distance d from the end."""


@dataclass(frozen=True, eq=False)
class FaceEnds:
    """Ends of both gears' faces, as the stations of a position see them."""

    distance: Floats
    """(m, k) distance d of the stations from k ends [mm], in the mean under each hat."""
    factor: Floats
    """(k,) κ of each end, times the part of the compliance 1/E* that its gear has."""

    @staticmethod
    def of(pair: GearPair, materials: Sequence[Material], stations: Stations) -> FaceEnds:
        """Four ends: two of the pinion and two of the wheel."""
        compliance = np.array([1.0 / material.plane_modulus for material in materials])
        distance, factor = [], []
        for member, material, share in zip(Member, materials, compliance / compliance.sum()):
            gear = pair.gears[member]
            for side in (-1.0, 1.0):
                θ = side * gear.hand * gear.base_helix_angle
                distance.append(stations.mean(0.5 * gear.face_width - side * stations.point_z))
                factor.append(share * softness(θ, material.poissons_ratio))
        return FaceEnds(np.stack(distance, axis=1), np.array(factor))

    def extra(self, half_width: Floats, carried: Floats) -> tuple[Floats, Floats]:
        """Compliance (m,) by which the stations are softer, over 2/(π E*), and what it falls by as q grows by 1 %, over
        1 %. half_width: b (m,), carried: w (m,), not below b [mm]."""
        d, b, w = REACH * self.distance, half_width[:, None], carried[:, None]
        root = np.sqrt(d**2 + b**2)
        logarithm = np.log((d + np.sqrt(d**2 + w**2)) / (d + root))
        return logarithm @ self.factor, (0.5 * b**2 / (root * (d + root))) @ self.factor


def softness(angle: float, poissons_ratio: float) -> float:
    """κ of an end whose face makes an angle of 90° − θ with the flank, through the material. angle: θ [rad].

    Fitted to finite element bodies with θ from −30° to 30° and ν from 0.2 to 0.4, within 0.03 of them or 5 %.
    """
    ν = poissons_ratio
    return 2.5 * ν**2 + (0.21 + 1.5 * ν) * math.expm1((3.75 - 1.28 * ν) * angle)
