"""Limits of a gear: rules under which its rack can cut it."""

from __future__ import annotations

import math
from typing import Any

from evolvent_meshes.gears.errors import require, require_instance, require_numbers
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form_limits import (
    SMALLEST_RIM,
    check_crossing,
    check_form_lengths,
    check_support,
    check_tip_edge,
    check_web,
)
from evolvent_meshes.gears.gear_geometry import GearGeometry
from evolvent_meshes.gears.modification_limits import check_modification_types, check_modifications
from evolvent_meshes.input_checks import is_index, shown

SMALLEST_BORE = 0.01
"""Smallest bore diameter over the root diameter: the gear is held at the bore, and cells at a point would collapse."""
FEWEST_TEETH = 5
"""Smallest number of teeth."""
MOST_UNDERCUT = 0.3
"""Normal modules by which a rack may be too deep not to undercut."""


def check_gear(gear: GearGeometry) -> None:
    """Raises GeometryError if the gear cannot be cut by its rack."""
    check_teeth(gear.z)
    check_types(gear)
    check_numbers(gear)
    check_form_lengths(gear)
    check_diameters(gear)
    check_support(gear)
    check_web(gear)
    check_rack(gear)
    check_tip_edge(gear)
    check_modifications(gear)


def check_teeth(z: Any) -> None:
    """Raises GeometryError unless a number of teeth is whole and large enough."""
    allowed, remedy = f"a whole number from {FEWEST_TEETH} on", "Count the teeth; internal gears are not supported."
    require(is_index(z) and z >= FEWEST_TEETH, "z", shown(z), allowed, remedy)


def check_angles(pressure: float, helix: float) -> None:
    """Raises GeometryError unless pressure and helix angle [°] are those of gears."""
    remedy = "Angles are in degrees; the hand of the helix is a key of its own."
    require(5.0 <= pressure <= 45.0, "normal_pressure_angle_deg", pressure, "5 to 45 degrees", remedy)
    require(0.0 <= helix <= 60.0, "helix_angle_deg", helix, "0 to 60 degrees", remedy)


def check_types(gear: GearGeometry) -> None:
    """Numbers, modifications and support are such, and no texts. Raises GeometryError."""
    check_modification_types(gear.modifications)
    require_instance(gear.support, Support, "support", "Write Support(width=...).")
    require_numbers(
        normal_module=gear.normal_module, normal_pressure_angle_deg=gear.normal_pressure_angle_deg,
        helix_angle_deg=gear.helix_angle_deg, profile_shift=gear.profile_shift, face_width=gear.face_width,
        tooth_thickness_allowance_um=gear.tooth_thickness_allowance_um,
        tip_diameter=gear.tip_diameter, root_diameter=gear.root_diameter, rack_tip_radius=gear.rack_tip_radius,
        tip_chamfer_um=gear.tip_chamfer_um, tip_rounding_um=gear.tip_rounding_um,
        protuberance_um=gear.protuberance_um, bore_diameter=gear.bore_diameter,
    )


def check_numbers(gear: GearGeometry) -> None:
    """Each number alone: finite and in its range, so that derived quantities are defined. Raises GeometryError."""
    for key in ("normal_module", "face_width", "tip_diameter", "root_diameter", "bore_diameter"):
        value = getattr(gear, key)
        require(math.isfinite(value) and value > 0.0, key, value, "a finite length above 0 mm", "Give it in mm.")
    require(gear.hand in (-1, 1), "hand", gear.hand, "+1 (right) or -1 (left)", "Give a spur gear either.")
    check_angles(gear.normal_pressure_angle_deg, gear.helix_angle_deg)
    shift, radius = gear.profile_shift, gear.rack_tip_radius
    require(-3.0 <= shift <= 3.0, "profile_shift", shift, "-3 to 3", "Give the coefficient x, not x times the module.")
    require(0.0 <= radius < math.inf, "rack_tip_radius", radius, "a finite radius from 0 mm on", "Give it in mm.")


def check_diameters(gear: GearGeometry) -> None:
    """Diameters: bore < root < tip, a rim below the teeth, a tooth that is not pointed. Raises GeometryError."""
    tip, root, bore = gear.tip_diameter, gear.root_diameter, gear.bore_diameter
    require(root < tip, "tip_diameter", tip, f"above root_diameter = {root:.6g} mm", "Exchange or correct the two.")
    require(
        tip > gear.base_diameter,
        "tip_diameter",
        tip,
        f"above the base circle, {gear.base_diameter:.6g} mm",
        "Raise it: below the base circle there is no involute.",
    )
    if gear.support.is_rim:
        _check_rim(gear)
    largest = root - 2.0 * SMALLEST_RIM * gear.normal_module
    require(
        largest > 0.0,
        "root_diameter",
        root,
        f"above {2.0 * SMALLEST_RIM * gear.normal_module:.6g} mm (a rim of one module under the root)",
        "Raise it: there is no room for a bore.",
    )
    require(
        bore <= largest,
        "bore_diameter",
        bore,
        f"up to {largest:.6g} mm (a rim of one module under the root)",
        "Make the bore smaller.",
    )
    require(
        bore >= SMALLEST_BORE * root,
        "bore_diameter",
        bore,
        f"from {SMALLEST_BORE * root:.6g} mm on (a hundredth of the root diameter)",
        "Make the bore larger: there the gear is held.",
    )
    require(
        gear.transverse_thickness(tip) > 0.0,
        "tip_diameter",
        tip,
        f"a tooth that is thicker than 0 at its tip (it is {gear.transverse_thickness(tip):.4g} mm: pointed)",
        "Lower the tip diameter or the profile shift.",
    )


def _check_rim(gear: GearGeometry) -> None:
    """A rim that is held at its inside: a module at least, and a bore within. Raises GeometryError."""
    rim, least, root = gear.rim_thickness, SMALLEST_RIM * gear.normal_module, gear.root_diameter
    allowed = f"at least {least:.6g} mm, one module"
    require(rim >= least * (1.0 - 1e-9), "rim_thickness", rim, allowed, "Make the rim thicker.")
    most = 0.5 * (1.0 - SMALLEST_BORE) * root
    allowed = f"up to {most:.6g} mm: within is a bore of a hundredth of the root diameter, {root:.6g} mm"
    require(rim <= most, "rim_thickness", rim, allowed, "Give bore_diameter_mm for a thick body.")


def check_rack(gear: GearGeometry) -> None:
    """The rack: a tip that is not pointed, no undercut, an involute below the tip circle. Raises GeometryError."""
    space = gear.rack_tip_half_land
    slope = (1.0 - math.sin(gear.normal_pressure_angle)) / math.cos(gear.normal_pressure_angle)
    largest = gear.rack_tip_radius + space / slope
    require(
        largest >= 0.0,
        "root_diameter",
        gear.root_diameter,
        "a rack tooth that isn't pointed",
        "Raise the root diameter or lower the profile shift.",
    )
    require(
        space >= 0.0,
        "rack_tip_radius",
        gear.rack_tip_radius,
        f"up to the full round, {largest:.6g} mm",
        "Use a smaller tool tip radius.",
    )
    depth = (gear.reference_diameter - gear.root_diameter) / 2.0
    require(
        gear.rack_tip_radius <= depth,
        "rack_tip_radius",
        gear.rack_tip_radius,
        f"up to the depth of the rack below the reference circle, {depth:.6g} mm",
        "Use a smaller tool tip radius or root diameter.",
    )
    least = -gear.rack_flank_roll_length * math.sin(gear.transverse_pressure_angle) / gear.normal_module
    require(
        least <= MOST_UNDERCUT,
        "profile_shift",
        gear.profile_shift,
        f"at least {gear.profile_shift + least - MOST_UNDERCUT:.4f} with this rack (the fillet would undercut the "
        "involute deeply)",
        "Raise the profile shift together with the root and tip diameters, take more teeth, a larger pressure "
        "angle or tool tip radius.",
    )
    if gear.protuberance_um or gear.is_undercut:
        check_crossing(gear)
    form = gear.root_form_diameter
    require(
        form < gear.tip_diameter,
        "tip_diameter",
        gear.tip_diameter,
        f"above the form circle, {form:.6g} mm",
        "Raise it: the involute begins above the tip.",
    )


