"""Limits of a gear pair: rules under which two gears can run together."""

from __future__ import annotations

import math

from evolvent_meshes.gears.errors import require, require_instance, require_numbers
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair_geometry import PairGeometry

ROUNDING = 1e-3
"""Tolerance in normal modules, for shifts, diameters and centre distances given with three or four digits."""


def check_pair(pair: PairGeometry) -> None:
    """Raises GeometryError if the two gears cannot run together at this centre distance."""
    check_types(pair)
    check_partners(pair)
    check_distance(pair)
    check_roots(pair)
    check_contact(pair)


def check_types(pair: PairGeometry) -> None:
    """Two gears and numbers. Raises GeometryError."""
    for key, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        require_instance(gear, GearParameters, key, "Write GearParameters.from_rack(z=...) or GearParameters(z=...).")
    require_numbers(centre_distance=pair.centre_distance, misalignment_um=pair.misalignment_um)


def check_partners(pair: PairGeometry) -> None:
    """Checks that both gears have the same rack, and helical ones opposite hands. Raises GeometryError."""
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
        f"Helical gears on parallel axes need opposite hands: give one gear hand = {-pinion.hand:+d}.",
    )


def check_distance(pair: PairGeometry) -> None:
    """The centre distance: a line of action exists, and the backlash is not negative. Raises GeometryError."""
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


def check_roots(pair: PairGeometry) -> None:
    """The roots: no tip reaches the root circle or the fillet of its mate. Raises GeometryError."""
    curvature_1, _ = pair.curvature_radii(pair.path_of_contact[0])
    _, curvature_2 = pair.curvature_radii(pair.path_of_contact[1])
    check_root("pinion", pair.pinion, "wheel", pair.wheel, pair.tip_clearances[1], float(curvature_1))
    check_root("wheel", pair.wheel, "pinion", pair.pinion, pair.tip_clearances[0], float(curvature_2))


def check_root(
    name: str, gear: GearParameters, mate_name: str, mate: GearParameters, clearance: float, roll_length: float
) -> None:
    """The root of one gear, called `name`, against the tip of its mate. Raises GeometryError.

    clearance: between the root circle and the mate's tip [mm].
    roll_length: smallest roll length at which the mate's tip touches the flank [mm].
    """
    key, tip, form = f"{mate_name}.tip_diameter", mate.tip_diameter, gear.rack_form_roll_length
    require(
        clearance > 0.0,
        key,
        tip,
        f"below {tip + 2.0 * clearance:.6g} mm (it runs into the root of the {name})",
        "Lower the tip diameter, raise the centre distance or deepen the root.",
    )
    edge = mate.tip_form_diameter
    largest = tip - edge + 2.0 * math.hypot(mate.base_radius, mate.roll_length(edge) + roll_length - form)
    require(
        roll_length >= form,
        key,
        tip,
        f"up to {largest:.6g} mm (it runs on the fillet of the {name}, below its form circle of "
        f"{gear.root_form_diameter:.6g} mm)",
        f"Lower the tip diameter, or take a smaller tool tip radius, protuberance or root diameter for the {name}.",
    )


def check_contact(pair: PairGeometry) -> None:
    """The contact: a path of contact exists, and the total contact ratio is at least 1. Raises GeometryError."""
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
