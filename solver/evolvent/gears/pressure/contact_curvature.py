"""Relative radius of curvature across the contact of loaded flanks, on the nominal contact line and where they touch.

Under load teeth bend and tilt, and both flanks touch some hundredths of a millimetre beside the nominal contact line.
Near the base circle, where an involute's radius of curvature changes most, that moves Hertz' p0 by several per cent.
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair


def nominal_radius(pair: GearPair, roll_distance: Floats) -> Floats:
    """R (n,) [mm] on the contact line at roll distances ξ (n,) [mm]; beyond the path of contact that of its end."""
    return pair.relative_curvature_radius(np.clip(roll_distance, *pair.path_of_contact))


def radius_in_place(pair: GearPair, roll_distance: Floats, arcs: tuple[Floats, Floats]) -> Floats:
    """R (n,) [mm] of contacts beside the contact line at roll distances ξ (n,) [mm]; NaN on no involute.

    arcs: on (pinion, wheel) the profile arc s (n,) [mm] from the contact line to the contact, positive towards the tip.
    An involute's arc is ρ²/2r_b from its base circle on, so that ρ² = ρ_0² + 2 r_b s, with ρ_0 on the line.
    """
    curvature = np.zeros(len(roll_distance))
    for gear, on_line, arc in zip(pair.gears, pair.curvature_radii(roll_distance), arcs):
        squared = np.square(on_line) + 2.0 * gear.base_radius * arc
        curvature += 1.0 / np.sqrt(np.where(squared > 0.0, squared, np.nan))
    return np.asarray(1.0 / (curvature * np.cos(pair.pinion.base_helix_angle)))
