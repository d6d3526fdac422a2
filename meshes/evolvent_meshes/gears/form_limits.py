"""Limits of a gear's form and body: allowances, protuberance, tip edges, how it is held, its web."""

from __future__ import annotations

import math

from evolvent_meshes.gears.errors import require, require_instance, require_numbers
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear_geometry import GearGeometry

LEAST_WIDTH = 0.05
"""Smallest width of a support over the face width: a narrower one is a line, on which nothing is stiff."""
LEAST_WEB = 0.05
"""Smallest thickness of a web over the face width: cells of a thinner one are too flat."""
SMALLEST_RIM = 1.0
"""Smallest thickness of the rim between bore or web and root, in normal modules."""
LEAST_RADIAL = 0.5
"""Smallest radial length of a web and of a hub, in normal modules."""
MOST_PROTUBERANCE = 0.1
"""Largest s_pr, in normal modules."""
LEAST_EDGE, MOST_EDGE = 0.03, 0.3
"""Smallest and largest chamfer or rounding of a tip, in normal modules: beside smaller ones cells are too thin."""
LEAST_LAND = 0.05
"""Smallest width of the tip between them, in normal modules."""
STEEPEST_FLANK = math.radians(42.0)
"""Largest pressure angle at the tip form circle with a chamfer: at 45° both are one line."""
MOST_ALLOWANCE = 0.3
"""Largest tooth thickness allowance, in normal modules."""


def check_form_lengths(gear: GearGeometry) -> None:
    """Protuberance and tooth thickness allowance, each alone. Raises GeometryError."""
    excess, highest = gear.protuberance_um, 1e3 * MOST_PROTUBERANCE * gear.normal_module
    remedy = "It is s_pr = pr − q in µm, the protuberance less the machining allowance."
    require(0.0 <= excess <= highest, "protuberance_um", excess, f"0 to {highest:.6g} µm", remedy)
    allowance, most = gear.tooth_thickness_allowance_um, 1e3 * MOST_ALLOWANCE * gear.normal_module
    remedy = "It makes the tooth thinner: give it in µm and negative, for both flanks together."
    require(-most <= allowance <= 0.0, "tooth_thickness_allowance_um", allowance, f"{-most:.6g} to 0 µm", remedy)


def check_crossing(gear: GearGeometry) -> None:
    """The fillet of an undercut gear or of one cut with protuberance meets its involute. Raises GeometryError."""
    key, value = "protuberance_um", gear.protuberance_um
    if not value:
        key, value = "profile_shift", gear.profile_shift
    require(
        not math.isnan(gear.rack_form_roll_length), key, value, "a fillet that ends on the involute",
        "Lower the protuberance, or raise the profile shift.",
    )


def check_tip_edge(gear: GearGeometry) -> None:
    """Chamfer or rounding of the tip: one of the two, off the fillet, a tip land between. Raises GeometryError."""
    chamfer, rounding, module = gear.tip_chamfer_um, gear.tip_rounding_um, 1e3 * gear.normal_module
    least, most = LEAST_EDGE * module, MOST_EDGE * module
    remedy = "It is a length in µm."
    for key, value in (("tip_chamfer_um", chamfer), ("tip_rounding_um", rounding)):
        require(value == 0.0 or least <= value <= most, key, value, f"0, or {least:.4g} to {most:.4g} µm", remedy)
    require(not (chamfer and rounding), "tip_chamfer_um", chamfer, "one of chamfer and rounding", "Leave out one.")
    if (edge := gear.tip_edge) is None:
        return
    key, value = ("tip_chamfer_um", chamfer) if chamfer else ("tip_rounding_um", rounding)
    land, form = 2.0 * gear.tip_diameter * edge.end[1] / 2.0, gear.tip_form_diameter
    require(
        form > gear.root_form_diameter and land >= LEAST_LAND * gear.normal_module, key, value,
        f"an edge that leaves an involute and a tip land of {LEAST_LAND * gear.normal_module:.4g} mm (it leaves "
        f"{max(land, 0.0):.4g} mm)", "Make it smaller.",
    )
    steepest = math.acos(min(1.0, gear.base_diameter / form))
    require(
        not chamfer or steepest < STEEPEST_FLANK, key, value,
        f"none where the flank leans {math.degrees(steepest):.3g}° at the tip: a chamfer of 45° cuts nothing there",
        "Give a rounding instead.",
    )


def check_support(gear: GearGeometry) -> None:
    """The support lies within the face. Raises GeometryError."""
    support, face_width = gear.support, gear.face_width
    require_numbers(support_offset=support.offset)
    if support.width is None:
        remedy = "Give support_width, too, or leave the offset out."
        require(support.offset == 0.0, "support_offset", support.offset, "0 where the whole face is held", remedy)
        return
    require_numbers(support_width=support.width)
    least = LEAST_WIDTH * face_width
    require(
        least <= support.width <= face_width, "support_width", support.width,
        f"{least:.6g} to {face_width:.6g} mm, the face width",
        "Leave it out where the gear is held over its whole face.",
    )
    most = 0.5 * (face_width - support.width)
    require(
        math.isfinite(support.offset) and abs(support.offset) <= most + 1e-9 * face_width,
        "support_offset", support.offset, f"{-most:.6g} to {most:.6g} mm: the support lies within the face",
        "It is the middle of the support, seen from mid-face.",
    )


def check_web(gear: GearGeometry) -> None:
    """Rim, web and hub follow each other down to the bore, the web within the face. Raises GeometryError."""
    web, face_width = gear.web, gear.face_width
    if web is None:
        return
    require_instance(web, Web, "web", "Write Web(thickness=..., rim_thickness=...).")
    require_numbers(web_thickness=web.thickness, rim_thickness=web.rim_thickness, web_offset=web.offset)
    require(
        LEAST_WEB * face_width <= web.thickness <= face_width, "web_thickness", web.thickness,
        f"{LEAST_WEB * face_width:.6g} to {face_width:.6g} mm, the face width",
        "It is the web's thickness along the axis; leave it out for a full ring.",
    )
    most = 0.5 * (face_width - web.thickness)
    require(
        abs(web.offset) <= most + 1e-9 * face_width, "web_offset", web.offset,
        f"{-most:.6g} to {most:.6g} mm: the web lies within the face",
        "It is the middle of the web, seen from mid-face.",
    )
    _check_radii(gear, web)


def _check_radii(gear: GearGeometry, web: Web) -> None:
    """Rim and hub leave room for the web. Raises GeometryError."""
    module, bore, inner = gear.normal_module, gear.bore_diameter, gear.bore_diameter
    if web.hub_diameter is not None:
        require_numbers(hub_diameter=web.hub_diameter)
        inner, least = web.hub_diameter, bore + 2.0 * LEAST_RADIAL * module
        largest = gear.root_diameter - 2.0 * (SMALLEST_RIM + LEAST_RADIAL) * module
        require(
            least <= inner <= largest, "hub_diameter", inner,
            f"{least:.6g} to {largest:.6g} mm, between the bore, {bore:.6g} mm, and the rim",
            "Leave it out where the web reaches the bore.",
        )
    least, most = SMALLEST_RIM * module, 0.5 * (gear.root_diameter - inner) - LEAST_RADIAL * module
    within = "bore" if web.hub_diameter is None else "hub"
    require(
        least <= web.rim_thickness <= most, "rim_thickness", web.rim_thickness,
        f"{least:.6g} to {most:.6g} mm: outside the {within}, {inner:.6g} mm across, it leaves room for a web",
        f"Make the rim thinner or the {within} smaller, or leave out the web.",
    )
    if web.hub_diameter is None:
        require(
            gear.support.width is None, "support_width", gear.support.width,
            "none where the web reaches the bore: there it is held over its thickness",
            "Leave it out, or give the diameter of the hub that sits on the shaft.",
        )
