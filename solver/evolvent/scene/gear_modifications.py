"""The flank modifications of a scene's gears, with the defaults that are derived from the pair."""

from __future__ import annotations

from evolvent.scene.schema.errors import InputProblem, shown
from evolvent.scene.schema.flank import AMOUNT, LEAST, LEAST_MODULES, FlankKeys
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.modifications import AMOUNTS, SIGNED, Modifications

END_RELIEF_LENGTH = 0.1
"""Default length of an end relief over the face width, at either end."""


def modifications_of(keys: FlankKeys, gear: GearParameters, active_start: float) -> Modifications:
    """The modifications of a gear.

    gear: as yet without them. active_start: diameter d_Nf at which its active profile begins [mm].
    """
    module, control = gear.normal_module, keys.profile_control_diameter_mm or max(active_start, gear.root_form_diameter)
    return Modifications(
        tip_relief_um=keys.tip_relief_um,
        tip_relief_start_diameter=keys.tip_relief_start_diameter_mm or gear.tip_diameter - module,
        tip_relief_parabolic=keys.tip_relief_form == "parabolic",
        lead_crowning_um=keys.lead_crowning_um,
        profile_crowning_um=keys.profile_crowning_um,
        profile_slope_um=keys.profile_slope_um,
        helix_slope_um=keys.helix_slope_um,
        end_relief_um=keys.end_relief_um,
        end_relief_length=keys.end_relief_length_mm or END_RELIEF_LENGTH * gear.face_width,
        end_relief_parabolic=keys.end_relief_form == "parabolic",
        root_relief_um=keys.root_relief_um,
        root_relief_end_diameter=keys.root_relief_end_diameter_mm or control + 0.5 * module,
        root_relief_parabolic=keys.root_relief_form == "parabolic",
        twist_um=keys.twist_um,
        profile_control_diameter=control,
    )


def amount_in_millimetres(gear: str, keys: FlankKeys, module: float) -> InputProblem | None:
    """The problem with a relief or crowning that is likely to be in mm; None where there is none.

    gear: name of the section. module: normal module [mm].
    """
    least = min(LEAST, 1e3 * LEAST_MODULES * module)
    for name in (each for each in AMOUNTS if each not in SIGNED):
        value = getattr(keys, name)
        if 0.0 < value < least:
            remedy = f"is {value:g} mm meant? Then write {1e3 * value:g}; else give 0"
            return InputProblem(f"{gear}.{name}", shown(value), AMOUNT, remedy)
    return None
