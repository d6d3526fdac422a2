"""The loaded flank in the coordinates of a mesh: the angle of its points at radius and height."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.profile import Profile, polar

_FIXED_POINT_STEPS = 6


def on_flank(gear: GearParameters, points: Floats) -> Floats:
    """Points (n, 3) of tooth 0, moved about the gear's axis onto its loaded flank with modifications [mm]."""
    radius, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    angle = Profile(gear).angle(radius) + gear.twist * z
    if not gear.modifications.is_empty:
        angle = angle + modification_angle(gear, radius, z)
    return np.column_stack([polar(radius, angle), z])


def modification_angle(gear: GearParameters, radius: Floats, z: Floats) -> Floats:
    """Angle [rad] about the axis from the helicoid to the modified flank, at radii and heights [mm] (broadcast).

    The modified point of (ρ, z0) lies at roll length ρ − c cos β_b and height z0 + c hand sin β_b. A fixed-point
    iteration for (ρ, z0), which contracts with the slope of the modification, brings it to the given radius and height.
    """
    flank = Flank(gear)
    wanted, height = np.broadcast_arrays(flank.roll_length(radius), z)
    rho, level = wanted, height
    for _ in range(_FIXED_POINT_STEPS):
        offset = flank.modification(rho, level)
        rho = wanted + offset * np.cos(gear.base_helix_angle)
        level = height - offset * gear.hand * np.sin(gear.base_helix_angle)
    modified, plain = flank.point(rho, level), flank.helicoid_point(wanted, height)
    across = plain[..., 0] * modified[..., 1] - plain[..., 1] * modified[..., 0]
    return np.asarray(np.arctan2(across, (plain[..., :2] * modified[..., :2]).sum(axis=-1)))
