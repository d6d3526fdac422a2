"""Backlash of a scene's vibration: that of its gears, or a given one that does not contradict them."""

from __future__ import annotations

import math

from evolvent.scene.schema.errors import NOTHING, InputProblem, shown
from evolvent_meshes.gears.pair import GearPair

AGREES = 1.0
"""Difference below which two backlashes agree [µm]: drawings have whole micrometres."""
GIVING = (
    "it in µm along the line of action, negative tooth_thickness_allowance_um of [pinion] and [wheel], or a larger "
    "pair.centre_distance_mm"
)
"""Keys of the scene from which a backlash follows."""


def backlash_conflict(pair: GearPair, given_um: float) -> InputProblem | None:
    """Message on a backlash along the line of action [µm] that contradicts the tooth thickness allowances of the gears;
    None where it agrees, or where the gears have no allowances."""
    if not any(gear.tooth_thickness_allowance_um for gear in pair.gears):
        return None
    follows = _of_gears(pair)
    if abs(given_um - follows) <= AGREES:
        return None
    allowed = f"{follows:.4g} µm, which follows from tooth thickness allowances and centre distance"
    remedy = "delete the key, or correct tooth_thickness_allowance_um of the gears"
    return InputProblem("dynamics.backlash_um", shown(given_um), allowed, remedy)


def unnamed_backlash(pair: GearPair, given_um: float | None) -> InputProblem | None:
    """Problem of a vibration without a given backlash; None where one is given or follows from the gears. A backlash
    from the rounding of a centre distance does not count."""
    if given_um is not None or _of_gears(pair) > AGREES:
        return None
    allowed = "the backlash of the pair: without any, back flanks catch the teeth at once, so that none part"
    return InputProblem("dynamics.backlash_um", NOTHING, allowed, f"give {GIVING}")


def _of_gears(pair: GearPair) -> float:
    """Backlash along the line of action that follows from tooth thicknesses and centre distance [µm]."""
    return 1e3 * pair.circumferential_backlash * math.cos(pair.working_pressure_angle)
