"""Backlash of a scene's vibration against that of its gears."""

from __future__ import annotations

import math

from evolvent.scene.schema.errors import InputProblem, shown
from evolvent_meshes.gears.pair import GearPair

AGREES = 1.0
"""Backlashes closer than this are the same [µm]: drawings have whole micrometres."""


def backlash_conflict(pair: GearPair, given_um: float) -> InputProblem | None:
    """Why a backlash along the line of action [µm] cannot be that of gears with tooth thickness allowances, from which
    it follows; None where it can, or where the gears have no allowances."""
    if not any(gear.tooth_thickness_allowance_um for gear in pair.gears):
        return None
    follows = 1e3 * pair.circumferential_backlash * math.cos(pair.working_pressure_angle)
    if abs(given_um - follows) <= AGREES:
        return None
    allowed = f"{follows:.4g} µm, which follows from tooth thickness allowances and centre distance"
    remedy = "delete the key, or correct tooth_thickness_allowance_um of the gears"
    return InputProblem("dynamics.backlash_um", shown(given_um), allowed, remedy)
