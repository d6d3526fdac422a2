"""Stations along the contact lines of a position: where a line contact has its unknown loads per length.

The load per length of a tooth pair's contact line is a sum of hats over height, which end where the line does: at the
ends of the common face, or `BEYOND` the path of contact, where only a tip's edge can touch. The end of the path of
contact is always a station, so that no hat reaches across it. In the plane each tooth pair has one station.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.pair import GearPair

BEYOND = 0.5
"""Roll distance beyond the path of contact [normal modules] within which deflection may bring a tip's edge into
contact."""
SHORTEST = 0.4
"""Length of the first and the last hat of a line over that of the others, below which two become one."""
NEAR_END = 0.15, 0.4
"""Distances of further stations from the ends of the face, over the spacing of the others: within twice the half-width
of the contact the load falls there."""
APART = 0.1
"""Least distance of such a station from another one, over the spacing."""
GAUSS = np.array([-1.0, 1.0]) / math.sqrt(3.0)
"""Points of the rule between two stations, of equal weights: exact for a hat times a quadratic function."""


@dataclass(frozen=True, eq=False)
class Stations:
    """Stations (m,) of a position, and points (p,) on the lines by which hats are integrated."""

    angle: float
    """Rotation φ of the pinion [rad]."""
    tooth: Ints
    """(m,) tooth pair of each station."""
    z: Floats
    """(m,) height of each station [mm]."""
    point_tooth: Ints
    """(p,) tooth pair of each point."""
    point_z: Floats
    """(p,) height of each point [mm]."""
    roll_distance: Floats
    """(p,) roll distance ξ of each point on rigid flanks without modifications [mm]."""
    hats: sp.csr_matrix
    """(p, m) hats at the points, times the length of the line that a point stands for [mm; 1 in the plane]."""

    @cached_property
    def lengths(self) -> Floats:
        """(m,) integral ℓ of each hat along its line [mm; 1 in the plane]."""
        return np.asarray(self.hats.sum(axis=0)).ravel()

    @cached_property
    def point_lengths(self) -> Floats:
        """(p,) length of the line that each point stands for [mm; 1 in the plane]."""
        return np.asarray(self.hats.sum(axis=1)).ravel()

    def mean(self, values: Floats) -> Floats:
        """(m,) mean of values (p,) under each hat."""
        return np.asarray((self.hats.T @ values) / self.lengths)


def stations_at(pair: GearPair, angle: float, spacing: float | None) -> Stations:
    """Stations at a pinion rotation [rad]. spacing: of the stations along the face [mm]; None in the plane."""
    lines = list(_plane_lines(pair, angle) if spacing is None else _lines(pair, angle, spacing))
    z, point_z = (np.concatenate(each) for each in zip(*((line.z, line.points) for line in lines)))
    teeth = np.array([line.tooth for line in lines])
    tooth, point_tooth = (np.repeat(teeth, [line.hats.shape[axis] for line in lines]) for axis in (1, 0))
    ξ, hats = pair.roll_distance(angle, point_tooth, point_z), sp.block_diag([line.hats for line in lines])
    return Stations(angle, tooth, z, point_tooth, point_z, ξ, hats.tocsr())


@dataclass(frozen=True, eq=False)
class _Line:
    """The contact line of a tooth pair."""

    tooth: int
    """Tooth pair."""
    z: Floats
    """Heights of its stations [mm]."""
    points: Floats
    """Heights of its points [mm]."""
    hats: sp.csr_matrix
    """Hats at the points, see `Stations`."""


def _plane_lines(pair: GearPair, angle: float) -> Iterator[_Line]:
    """One station of each tooth pair within reach."""
    start, end = pair.path_of_contact
    beyond, pitch, here = BEYOND * pair.pinion.normal_module, pair.pinion.transverse_base_pitch, _here(pair, angle)
    for tooth in range(math.ceil((start - beyond - here) / pitch), math.floor((end + beyond - here) / pitch) + 1):
        yield _Line(tooth, np.zeros(1), np.zeros(1), sp.csr_matrix(np.ones((1, 1))))


def _lines(pair: GearPair, angle: float, spacing: float) -> Iterator[_Line]:
    """Stations of each tooth pair within reach, evenly spaced over the face but for the ends."""
    slope, half = math.tan(pair.pinion.base_helix_angle), 0.5 * pair.face_width
    even = np.linspace(-half, half, max(1, round(2.0 * half / spacing)) + 1)
    (start, end), beyond = pair.path_of_contact, BEYOND * pair.pinion.normal_module
    reach, here, pitch = half * slope, _here(pair, angle), pair.pinion.transverse_base_pitch
    first = math.ceil((start - beyond - reach - here) / pitch)
    for tooth in range(first, math.floor((end + beyond + reach - here) / pitch) + 1):
        limits = np.array([start - beyond, start, end, end + beyond]) - (here + tooth * pitch)
        fixed = np.array([-half, half])
        if slope > 0.0:
            low, *ends, high = np.clip(np.sort(pair.pinion.hand * limits / slope), -half, half)
            fixed = np.unique([low, *ends, high])
        z = _with_ends(_on_line(even, fixed), half, even[1] - even[0])
        if len(z) > 1:
            yield _Line(tooth, z, *_hats(z, math.cos(pair.pinion.base_helix_angle)))


def _here(pair: GearPair, angle: float) -> float:
    """Roll distance of tooth pair 0 at mid-face [mm]."""
    return float(pair.roll_distance(angle))


def _on_line(even: Floats, fixed: Floats) -> Floats:
    """Heights of the stations of a line: the fixed ones, and those of `even` between them that are not too near."""
    near = SHORTEST * (even[1] - even[0])
    between = even[(even > fixed[0]) & (even < fixed[-1])]
    far = np.abs(between[:, None] - fixed).min(axis=1, initial=np.inf) > near
    kept = fixed[np.append(True, np.diff(fixed) > 1e-6)]
    return np.sort(np.concatenate([kept, between[far]]))


def _with_ends(z: Floats, half: float, spacing: float) -> Floats:
    """Heights of the stations of a line with further ones near the ends of the face, where the line goes there. half:
    half the face width [mm]."""
    near = np.outer([-1.0, 1.0], half - spacing * np.array(NEAR_END)).ravel()
    within = near[(near > z[0]) & (near < z[-1])]
    return np.sort(np.append(z, within[np.abs(within[:, None] - z).min(axis=1, initial=np.inf) > APART * spacing]))


def _hats(z: Floats, cosine: float) -> tuple[Floats, sp.csr_matrix]:
    """Heights of the points between stations, and the hats there. cosine: height over length of the line."""
    middle, step = 0.5 * (z[1:] + z[:-1]), np.diff(z)
    points = (middle[:, None] + 0.5 * step[:, None] * GAUSS).ravel()
    weight, rise = np.repeat(0.5 * step, 2) / cosine, np.tile(0.5 * (1.0 + GAUSS), len(step))
    left, rows = np.repeat(np.arange(len(step)), 2), np.arange(len(points))
    values = np.concatenate([weight * (1.0 - rise), weight * rise])
    places = np.concatenate([rows, rows]), np.concatenate([left, left + 1])
    return points, sp.csr_matrix((values, places), (len(points), len(z)))
