"""Scenes whose tooth forms or gear bodies cannot be."""

from __future__ import annotations

from tests.support.scene_texts import HE, YANG, without

WRONG_FORMS: dict[str, tuple[str, list[str], str, str, str]] = {
    "thicker teeth": (
        YANG, ["pinion.tooth_thickness_allowance_um=50"], "pinion.tooth_thickness_allowance_um", "50",
        "give it negative",
    ),
    "allowance in mm·10⁻⁴": (
        YANG, ["wheel.tooth_thickness_allowance_um=-700"], "wheel.tooth_thickness_allowance_um", "-700", "in µm",
    ),
    "backlash that is not the teeth's": (
        HE, ["dynamics.backlash_um=50", "pinion.tooth_thickness_allowance_um=-80"], "dynamics.backlash_um", "50",
        "delete the key",
    ),
    "bore and rim": (
        YANG, ["pinion.bore_diameter_mm=20", "pinion.rim_thickness_mm=4"], "pinion.bore_diameter_mm", "20 and also",
        "delete bore_diameter_mm or rim",
    ),
    "rim of a solid gear": (
        without(YANG, "bore_diameter_mm"), ["pinion.rim_thickness_mm=18"], "pinion.rim_thickness_mm", "18",
        "for a thick body",
    ),
    "allowance in mm": (
        YANG, ["pinion.tooth_thickness_allowance_um=-0.08"], "pinion.tooth_thickness_allowance_um", "-0.08",
        "give it in µm: -80 where",
    ),
    "rim beyond the bore's least": (
        without(YANG, "bore_diameter_mm"), ["pinion.rim_thickness_mm=17.8"], "pinion.rim_thickness_mm", "17.8",
        "for a thick body",
    ),
    "rim thinner than a module": (
        without(YANG, "bore_diameter_mm"), ["pinion.rim_thickness_mm=2"], "pinion.rim_thickness_mm",
        "2", "make the rim thicker",
    ),
    "support beside the face": (
        YANG, ["wheel.support_width_mm=8", "wheel.support_offset_mm=6"], "wheel.support_offset_mm", "6",
        "seen from mid-face",
    ),
    "support wider than the face": (
        YANG, ["wheel.support_width_mm=20"], "wheel.support_width_mm", "20", "leave it out",
    ),
    "line support": (YANG, ["wheel.support_width_mm=0.1"], "wheel.support_width_mm", "0.1", "leave it out"),
    "offset of the whole face": (YANG, ["wheel.support_offset_mm=2"], "wheel.support_offset_mm", "2", "give wheel.su"),
    "holes in the web": (YANG, ["wheel.web_holes=6"], "wheel.web_holes", "6", "delete it"),
    "web without a rim": (YANG, ["wheel.web_thickness_mm=8"], "wheel.web_thickness_mm", "8", "give wheel.rim_"),
    "hub without a web": (YANG, ["wheel.hub_diameter_mm=90"], "wheel.hub_diameter_mm", "90", "give wheel.web"),
    "offset without a web": (YANG, ["wheel.web_offset_mm=-2"], "wheel.web_offset_mm", "-2", "give wheel.web"),
    "web wider than the face": (
        YANG, ["wheel.web_thickness_mm=18", "wheel.rim_thickness_mm=6"], "wheel.web_thickness_mm", "18", "leave it out",
    ),
    "web beside the face": (
        YANG, ["wheel.web_thickness_mm=8", "wheel.rim_thickness_mm=6", "wheel.web_offset_mm=5"], "wheel.web_offset_mm",
        "5", "seen from mid-face",
    ),
    "rim that leaves no web": (
        YANG, ["wheel.web_thickness_mm=8", "wheel.rim_thickness_mm=33"], "wheel.rim_thickness_mm", "33",
        "make the rim thinner",
    ),
    "hub in the bore": (
        YANG, ["wheel.web_thickness_mm=8", "wheel.rim_thickness_mm=6", "wheel.hub_diameter_mm=70"],
        "wheel.hub_diameter_mm", "70", "reaches the bore",
    ),
    "bore up to the rim": (
        YANG, ["wheel.web_thickness_mm=8", "wheel.rim_thickness_mm=6", "wheel.bore_diameter_mm=135"],
        "wheel.bore_diameter_mm", "135", "make the bore smaller",
    ),
    "support of a web": (
        YANG, ["wheel.web_thickness_mm=8", "wheel.rim_thickness_mm=6", "wheel.support_width_mm=8"],
        "wheel.support_width_mm", "8", "diameter of the hub",
    ),
    "chamfer and rounding": (
        YANG, ["pinion.tip_chamfer_um=100", "pinion.tip_rounding_um=100"], "pinion.tip_chamfer_um", "100",
        "leave out one",
    ),
    "rounding as a burr": (YANG, ["pinion.tip_rounding_um=5"], "pinion.tip_rounding_um", "5", "in µm"),
    "rounding without a tip": (
        YANG, ["pinion.tip_rounding_um=600", "pinion.tip_diameter_mm=48.6"], "pinion.tip_rounding_um", "600",
        "make it smaller",
    ),
    "negative chamfer": (YANG, ["wheel.tip_chamfer_um=-100"], "wheel.tip_chamfer_um", "-100", "give 0"),
    "chamfer that loses contact": (
        HE, ["pinion.tip_chamfer_um=900", "wheel.tip_chamfer_um=900", "pair.centre_distance_mm=151.4"],
        "pair.centre_distance_mm", "151.4", "raise the tip diameters",
    ),
    "protuberance without allowance": (
        YANG, ["pinion.protuberance_um=400"], "pinion.protuberance_um", "400", "less the machining",
    ),
    "negative protuberance": (YANG, ["wheel.protuberance_um=-20"], "wheel.protuberance_um", "-20", "give a number"),
    "fillet under the mate's tip": (
        YANG, ["pinion.protuberance_um=150"], "wheel.tip_diameter_mm", "149.3", "lower the tip",
    ),
}
"""Case -> scene, overrides; key, what was found and a part of the remedy that the message must have."""
