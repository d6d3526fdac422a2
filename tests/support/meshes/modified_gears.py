"""Gears with all modifications that a flank can have."""

from __future__ import annotations

from dataclasses import replace

from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.modifications import Modifications


def fully_modified(gear: GearParameters, parabolic: bool = False) -> GearParameters:
    """The gear with 1 to 12 µm of every modification, slopes and twist negative; parabolic: its reliefs."""
    control = gear.root_form_diameter + 0.3
    return replace(gear, modifications=Modifications(
        tip_relief_um=12.0, tip_relief_start_diameter=gear.tip_diameter - 2.0, tip_relief_parabolic=parabolic,
        lead_crowning_um=3.0, profile_crowning_um=4.0, profile_slope_um=-5.0, helix_slope_um=-6.0,
        end_relief_um=7.0, end_relief_length=0.15 * gear.face_width, end_relief_parabolic=parabolic,
        root_relief_um=8.0, root_relief_end_diameter=control + 1.5, root_relief_parabolic=parabolic,
        twist_um=-9.0, profile_control_diameter=control,
    ))
