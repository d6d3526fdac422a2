"""Limits of a gear: rules under which its rack can cut it."""

from __future__ import annotations

import math
from typing import Any

from evolvent_meshes.gears.errors import require, require_numbers
from evolvent_meshes.gears.gear_geometry import GearGeometry
from evolvent_meshes.gears.modification_limits import check_modification_types, check_modifications
from evolvent_meshes.gears.modifications.support import Support
from evolvent_meshes.gears.tip_edge import tip_edge
from evolvent_meshes.input_checks import is_index, shown

SMALLEST_BORE = 0.01
"""Smallest bore diameter over the root diameter: the gear is held at the bore, and cells at a point would collapse."""
FEWEST_TEETH = 5
"""Smallest number of teeth."""
SMALLEST_RIM = 1.0
"""Smallest thickness of the rim between bore and root, in normal modules."""
LEAST_EDGE, MOST_EDGE = 0.03, 0.3
"""Smallest and largest chamfer or rounding of a tip, in normal modules: beside smaller ones cells are too thin."""
LEAST_LAND = 0.05
"""Smallest width of the tip between them, in normal modules."""
STEEPEST_FLANK = math.radians(42.0)
"""Largest pressure angle at the tip form circle with a chamfer: at 45° both are one line."""
LEAST_SUPPORT = 0.05
"""Smallest width of a support over the face width: a narrower one is a line, on which nothing is stiff."""
MOST_ALLOWANCE = 0.3
"""Largest tooth thickness allowance, in normal modules."""


def check_gear(gear: GearGeometry) -> None:
    """Raises GeometryError if the gear cannot be cut by its rack."""
    check_teeth(gear.z)
    check_types(gear)
    check_numbers(gear)
    check_diameters(gear)
    check_support(gear.support, gear.face_width)
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
    """Numbers and modifications are such, and no texts. Raises GeometryError."""
    check_modification_types(gear.modifications)
    require_numbers(
        normal_module=gear.normal_module, normal_pressure_angle_deg=gear.normal_pressure_angle_deg,
        helix_angle_deg=gear.helix_angle_deg, profile_shift=gear.profile_shift, face_width=gear.face_width,
        tooth_thickness_allowance_um=gear.tooth_thickness_allowance_um,
        tip_diameter=gear.tip_diameter, root_diameter=gear.root_diameter, rack_tip_radius=gear.rack_tip_radius,
        tip_chamfer_um=gear.tip_chamfer_um, tip_rounding_um=gear.tip_rounding_um, bore_diameter=gear.bore_diameter,
    )  # fmt: skip


def check_numbers(gear: GearGeometry) -> None:
    """Each number alone: finite and in its range, so that derived quantities are defined. Raises GeometryError."""
    for key in ("normal_module", "face_width", "tip_diameter", "root_diameter", "bore_diameter"):
        value = getattr(gear, key)
        require(math.isfinite(value) and value > 0.0, key, value, "a finite length above 0 mm", "Give it in mm.")
    require(gear.hand in (-1, 1), "hand", gear.hand, "+1 (right) or -1 (left)", "Give a spur gear either.")
    check_angles(gear.normal_pressure_angle_deg, gear.helix_angle_deg)
    shift, radius = gear.profile_shift, gear.rack_tip_radius
    require(-3.0 <= shift <= 3.0, "profile_shift", shift, "-3 to 3", "Give the coefficient x, not x times the module.")
    allowance, most = gear.tooth_thickness_allowance_um, 1e3 * MOST_ALLOWANCE * gear.normal_module
    remedy = "It makes the tooth thinner: give it in µm and negative, for both flanks together."
    require(-most <= allowance <= 0.0, "tooth_thickness_allowance_um", allowance, f"{-most:.6g} to 0 µm", remedy)
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
    least = -gear.rack_form_roll_length * math.sin(gear.transverse_pressure_angle) / gear.normal_module
    require(
        gear.rack_form_roll_length > 0.0,
        "profile_shift",
        gear.profile_shift,
        f"at least {gear.profile_shift + least:.4f} with this rack (the fillet would undercut the involute)",
        "Raise the profile shift together with the root and tip diameters, take more teeth, a larger pressure "
        "angle or tool tip radius.",
    )
    form = gear.root_form_diameter
    require(
        form < gear.tip_diameter,
        "tip_diameter",
        gear.tip_diameter,
        f"above the form circle, {form:.6g} mm",
        "Raise it: the involute begins above the tip.",
    )


def check_support(support: Any, face_width: float) -> None:
    """Raises GeometryError unless the support lies within the face width [mm]."""
    require(isinstance(support, Support), "support", support, "Support", "Write Support(width=...).")
    require_numbers(support_offset=support.offset)
    if support.width is None:
        remedy = "Give support_width, too, or leave the offset out."
        require(support.offset == 0.0, "support_offset", support.offset, "0 where the whole face is held", remedy)
        return
    require_numbers(support_width=support.width)
    least = LEAST_SUPPORT * face_width
    require(
        least <= support.width <= face_width, "support_width", support.width,
        f"{least:.6g} to {face_width:.6g} mm, the face width",
        "Leave it out where the gear is held over its whole face.",
    )  # fmt: skip
    most = 0.5 * (face_width - support.width)
    require(
        math.isfinite(support.offset) and abs(support.offset) <= most + 1e-9 * face_width,
        "support_offset", support.offset, f"{-most:.6g} to {most:.6g} mm: the support lies within the face",
        "It is the middle of the support, seen from mid-face.",
    )  # fmt: skip


def check_tip_edge(gear: GearGeometry) -> None:
    """Chamfer or rounding of the tip: one of the two, off the fillet, a tip land between. Raises GeometryError."""
    chamfer, rounding, module = gear.tip_chamfer_um, gear.tip_rounding_um, 1e3 * gear.normal_module
    least, most = LEAST_EDGE * module, MOST_EDGE * module
    remedy = "It is a length in µm."
    for key, value in (("tip_chamfer_um", chamfer), ("tip_rounding_um", rounding)):
        require(value == 0.0 or least <= value <= most, key, value, f"0, or {least:.4g} to {most:.4g} µm", remedy)
    require(not (chamfer and rounding), "tip_chamfer_um", chamfer, "one of chamfer and rounding", "Leave out one.")
    if (edge := tip_edge(gear)) is None:
        return
    key, value = ("tip_chamfer_um", chamfer) if chamfer else ("tip_rounding_um", rounding)
    land, form = 2.0 * gear.tip_diameter * edge.end[1] / 2.0, gear.tip_form_diameter
    require(
        form > gear.root_form_diameter and land >= LEAST_LAND * gear.normal_module, key, value,
        f"an edge that leaves an involute and a tip land of {LEAST_LAND * gear.normal_module:.4g} mm (it leaves "
        f"{max(land, 0.0):.4g} mm)", "Make it smaller.",
    )  # fmt: skip
    steepest = math.acos(min(1.0, gear.base_diameter / form))
    require(
        not chamfer or steepest < STEEPEST_FLANK, key, value,
        f"none where the flank leans {math.degrees(steepest):.3g}° at the tip: a chamfer of 45° cuts nothing there",
        "Give a rounding instead.",
    )  # fmt: skip
