"""Limits of a gear's flank modifications."""

from __future__ import annotations

from typing import Any

import numpy as np

from evolvent_meshes.gears.errors import require, require_instance, require_numbers
from evolvent_meshes.gears.gear_geometry import GearGeometry
from evolvent_meshes.gears.modifications.modifications import AMOUNTS, FROM_CONTROL_DIAMETER, SIGNED, Modifications

LARGEST = 1000.0
"""Largest amount [µm]."""
PLACES = ("tip_relief_start_diameter", "root_relief_end_diameter", "profile_control_diameter", "end_relief_length")
"""Fields of `Modifications` that are lengths or None."""


def check_modification_types(given: Any) -> None:
    """Checks that modifications have numbers and no texts. Raises GeometryError."""
    require_instance(given, Modifications, "modifications", "Write Modifications(tip_relief_um=...).")
    require_numbers(**{name: getattr(given, name) for name in AMOUNTS})
    require_numbers(**{name: value for name in PLACES if (value := getattr(given, name)) is not None})


def check_modifications(gear: GearGeometry) -> None:
    """Checks that amounts are in their range, places on the flank, and material remains at the tip. Raises
    GeometryError."""
    for name in AMOUNTS:
        least, value = (-LARGEST if name in SIGNED else 0.0), getattr(gear.modifications, name)
        remedy = "It is the material taken off, in µm."
        require(least <= value <= LARGEST, name, value, f"{least:g} to {LARGEST:g} µm", remedy)
    _check_profile(gear)
    _check_ends(gear)
    _check_tip(gear)


def _check_profile(gear: GearGeometry) -> None:
    """Checks where modifications of the profile begin and end."""
    given, low, high = gear.modifications, gear.root_form_diameter, gear.tip_form_diameter
    if given.tip_relief_um:
        _check_between(
            "tip_relief_start_diameter", given.tip_relief_start_diameter, low, high,
            "Say where on the involute the relief starts.",
        )
    control = given.profile_control_diameter
    if control is not None and not given.amounts.keys().isdisjoint(FROM_CONTROL_DIAMETER):
        remedy = "It is where the evaluated profile begins."
        _check_between("profile_control_diameter", control, low * (1.0 - 1e-9), high, remedy)
    if given.root_relief_um:
        start, end = low if control is None else control, given.root_relief_end_diameter
        allowed = f"above {start:.6g} mm, where the evaluated profile begins, up to {high:.6g} mm"
        holds = end is not None and start < end <= high
        require(holds, "root_relief_end_diameter", end, allowed, "Say where on the involute the relief ends.")


def _check_between(key: str, found: float | None, low: float, high: float, remedy: str) -> None:
    holds = found is not None and low <= found < high
    require(holds, key, found, f"{low:.6g} to below {high:.6g} mm", remedy)


def _check_ends(gear: GearGeometry) -> None:
    """Checks the length of the end relief."""
    length, half = gear.modifications.end_relief_length, 0.5 * gear.face_width
    if gear.modifications.end_relief_um:
        remedy = "It is the length at either end of the face."
        holds = length is not None and 0.0 < length <= half
        require(holds, "end_relief_length", length, f"above 0 up to {half:.6g} mm, half of the face width", remedy)


def _check_tip(gear: GearGeometry) -> None:
    """Checks that material remains at the ends of the tooth's tip."""
    half = 0.5 * gear.face_width
    taken = 1e3 * float(gear.flank_depth.at(np.full(2, gear.flank_depth.tip), np.array([-half, half])).max())
    thickness = 1e3 * gear.normal_thickness(gear.tip_diameter)
    require(
        taken < thickness,
        gear.modifications.largest,
        taken,
        f"modifications below the tooth's thickness at its tip, {thickness:.4g} µm, together",
        "Lower them: at the ends of its tip nothing is left of the tooth.",
    )
