"""What a gear and a pair must satisfy, and the error that says which rule is broken and how to mend it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from meshes.errors import InputError

if TYPE_CHECKING:
    from meshes.gear import GearParameters
    from meshes.parameters import GearPair

ROUNDING = 1e-3
"""In normal modules: shifts, diameters and centre distances printed to three or four digits may miss by this much."""
SMALLEST_BORE = 0.01
"""Of the root diameter: a gear held at a point turns under any torque, and its cells there collapse."""
SMALLEST_RIM = 1.0
"""In normal modules: a thinner ring between bore and root is an error of input, not a gear body."""


class GeometryError(InputError):
    """A gear or a pair that can't exist: which key, what was found, what is allowed, what to do."""

    def __init__(self, key: str, found: object, allowed: str, remedy: str) -> None:
        super().__init__(f"{key}: found {found}, allowed {allowed}. {remedy}")
        self.key, self.found, self.allowed, self.remedy = key, str(found), allowed, remedy


def require(holds: bool, key: str, found: object, allowed: str, remedy: str) -> None:
    """Raise GeometryError unless a rule holds; figures are shown with six digits."""
    if not holds:
        raise GeometryError(key, f"{found:.6g}" if isinstance(found, float) else found, allowed, remedy)


def check_gear(gear: GearParameters) -> None:
    """Raise GeometryError if the gear can't be cut by its rack."""
    check_numbers(gear)
    check_diameters(gear)
    check_rack(gear)
    check_modifications(gear)


def check_numbers(gear: GearParameters) -> None:
    """Finite numbers in their ranges; what follows may then divide and take roots."""
    for key in ("normal_module", "face_width", "tip_diameter", "root_diameter", "bore_diameter"):
        value = getattr(gear, key)
        require(math.isfinite(value) and value > 0.0, key, value, "a finite length above 0 mm", "Give it in mm.")
    require(isinstance(gear.z, int) and gear.z >= 5, "z", gear.z, "a whole number from 5 on", "Count the teeth.")
    require(gear.hand in (-1, 1), "hand", gear.hand, "+1 (right) or -1 (left)", "Give a spur gear either.")
    angle, helix = gear.normal_pressure_angle_deg, gear.helix_angle_deg
    remedy = "Angles are in degrees; the hand of the helix is a key of its own."
    require(5.0 <= angle <= 45.0, "normal_pressure_angle_deg", angle, "5 to 45 degrees", remedy)
    require(0.0 <= helix <= 60.0, "helix_angle_deg", helix, "0 to 60 degrees", remedy)
    shift, radius = gear.profile_shift, gear.rack_tip_radius
    require(-3.0 <= shift <= 3.0, "profile_shift", shift, "-3 to 3", "Give the coefficient x, not x times the module.")
    require(0.0 <= radius < math.inf, "rack_tip_radius", radius, "a finite radius from 0 mm on", "Give it in mm.")


def check_diameters(gear: GearParameters) -> None:
    """bore < root < tip, a rim that carries the teeth, a tooth that isn't pointed."""
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


def check_rack(gear: GearParameters) -> None:
    """A rack tooth with a tip, that neither undercuts nor leaves the involute outside the tip circle."""
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


def check_modifications(gear: GearParameters) -> None:
    """Reliefs that take material off, and start on the involute."""
    given = gear.modifications
    for key in ("tip_relief_um", "lead_crowning_um"):
        value = getattr(given, key)
        require(0.0 <= value <= 1000.0, key, value, "0 to 1000 µm", "It is the material taken off, in µm.")
    taken, thickness = given.tip_relief_um + given.lead_crowning_um, 1e3 * gear.normal_thickness(gear.tip_diameter)
    require(
        taken < thickness,
        "tip_relief_um" if given.tip_relief_um >= given.lead_crowning_um else "lead_crowning_um",
        taken,
        f"relief and crowning below the tooth's thickness at its tip, {thickness:.4g} µm, together",
        "Lower them: at the ends of its tip nothing is left of the tooth.",
    )
    start = given.tip_relief_start_diameter
    if given.tip_relief_um > 0.0:
        low, high = gear.root_form_diameter, gear.tip_diameter
        require(
            start is not None and low <= start < high,
            "tip_relief_start_diameter",
            start,
            f"{low:.6g} to below {high:.6g} mm",
            "Say where on the involute the relief starts.",
        )


def check_pair(pair: GearPair) -> None:
    """Raise GeometryError if the two gears can't run together at this centre distance."""
    check_partners(pair)
    check_distance(pair)
    check_roots(pair)
    check_contact(pair)


def check_partners(pair: GearPair) -> None:
    """Same rack, opposite hands."""
    pinion, wheel = pair.gears
    for key in ("normal_module", "normal_pressure_angle_deg", "helix_angle_deg"):
        one, two = getattr(pinion, key), getattr(wheel, key)
        require(
            abs(one - two) <= 1e-9 * abs(one),
            key,
            two,
            f"{one:.6g}, as the other gear has",
            "Gears on parallel axes share module, pressure angle and helix angle.",
        )
    require(
        pinion.helix_angle == 0.0 or pinion.hand == -wheel.hand,
        "hand",
        wheel.hand,
        f"{-pinion.hand:+d}",
        "The hands of helical gears on parallel axes are opposite: turn one round.",
    )


def check_distance(pair: GearPair) -> None:
    """A line of action exists and the teeth fit into each other's spaces."""
    distance, module = pair.centre_distance, pair.pinion.normal_module
    bases = pair.pinion.base_radius + pair.wheel.base_radius
    require(
        math.isfinite(distance) and distance > bases,
        "centre_distance",
        distance,
        f"above the base radii's sum, {bases:.6g} mm",
        "Raise the centre distance.",
    )
    require(
        math.isfinite(pair.misalignment_um),
        "misalignment_um",
        pair.misalignment_um,
        "a finite length in µm",
        "Give 0 for aligned axes.",
    )
    require(
        pair.circumferential_backlash >= -ROUNDING * module,
        "centre_distance",
        distance,
        f"one with a backlash from 0 mm on (it is {pair.circumferential_backlash:.4g} mm: the flanks jam)",
        "Raise the centre distance or lower the profile shifts.",
    )


def check_roots(pair: GearPair) -> None:
    """No tip reaches the mate's root circle or runs on its fillet."""
    curvature_1, _ = pair.curvature_radii(pair.path_of_contact[0])
    _, curvature_2 = pair.curvature_radii(pair.path_of_contact[1])
    check_root("pinion", pair.pinion, "wheel", pair.wheel, pair.tip_clearances[1], float(curvature_1))
    check_root("wheel", pair.wheel, "pinion", pair.pinion, pair.tip_clearances[0], float(curvature_2))


def check_root(
    name: str, gear: GearParameters, mate_name: str, mate: GearParameters, clearance: float, roll_length: float
) -> None:
    """One gear's root: the clearance under its mate's tip, and the roll length down to which that tip touches it."""
    key, tip, form = f"{mate_name}.tip_diameter", mate.tip_diameter, gear.rack_form_roll_length
    require(
        clearance > 0.0,
        key,
        tip,
        f"below {tip + 2.0 * clearance:.6g} mm (it runs into the root of the {name})",
        "Lower the tip diameter, raise the centre distance or deepen the root.",
    )
    largest = 2.0 * math.hypot(mate.base_radius, mate.roll_length(tip) + roll_length - form)
    require(
        roll_length >= form,
        key,
        tip,
        f"up to {largest:.6g} mm (it runs on the fillet of the {name}, below its form circle of "
        f"{gear.root_form_diameter:.6g} mm)",
        f"Lower the tip diameter, or take a smaller tool tip radius or root diameter for the {name}.",
    )


def check_contact(pair: GearPair) -> None:
    """One tooth pair takes over before the last one leaves."""
    start, end = pair.path_of_contact
    require(
        end > start,
        "centre_distance",
        pair.centre_distance,
        "one at which the tip circles meet on the line of action",
        "Lower the centre distance or raise the tip diameters.",
    )
    require(
        pair.total_contact_ratio >= 1.0,
        "contact ratio",
        pair.total_contact_ratio,
        "from 1 on",
        "The contact would be lost between teeth: raise the tip diameters, lower the centre distance, or widen "
        "helical gears.",
    )
