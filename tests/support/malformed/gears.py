"""Scenes of gears that cannot exist or cannot mesh."""

from __future__ import annotations

from tests.support.scene_texts import FIRST, HE, YANG, without

SHALLOW = HE.replace("dedendum_coefficient = 1.25", "dedendum_coefficient = 0.95")

IMPOSSIBLE_GEARS: dict[str, tuple[str, list[str], str, str, str]] = {
    # geometrically impossible
    "undercut": (
        HE,
        ["pinion.teeth=8", "pinion.bore_diameter_mm=8", "pinion.tip_diameter_mm=30"],
        "pinion.profile_shift",
        "0",
        "raise the profile shift",
    ),
    "pointed tip": (YANG, ["pinion.tip_diameter_mm=54"], "pinion.tip_diameter_mm", "54", "lower the tip diameter"),
    "pointed by addendum": (
        HE.replace("tip_diameter_mm = 156.0", "addendum_coefficient = 3.0"),
        [],
        "pinion.addendum_coefficient",
        "3 (so tip diameter 168)",
        "lower the tip",
    ),
    "tip below root": (YANG, ["pinion.tip_diameter_mm=35"], "pinion.tip_diameter_mm", "35", "exchange or correct"),
    "tip below base": (
        YANG,
        ["wheel.tip_diameter_mm=120", "wheel.root_diameter_mm=110"],
        "wheel.tip_diameter_mm",
        "120",
        "raise it",
    ),
    "no contact": (HE, ["pair.centre_distance_mm=160"], "pair.centre_distance_mm", "160", "lower the centre distance"),
    "contact lost": (
        HE,
        ["pair.centre_distance_mm=153"],
        "pair.centre_distance_mm",
        "153 (so contact ratio",
        "centre distance",
    ),
    "centre distance small": (
        YANG,
        ["pair.centre_distance_mm=92"],
        "pair.centre_distance_mm",
        "92",
        "raise the centre",
    ),
    "centre distance too small for the relief": (
        FIRST, ["pair.centre_distance_mm=120"], "pair.centre_distance_mm", "120", "raise the centre distance",
    ),
    "bases overlap": (YANG, ["pair.centre_distance_mm=80"], "pair.centre_distance_mm", "80", "raise the centre"),
    "interference at the root": (YANG, ["wheel.tip_diameter_mm=150"], "wheel.tip_diameter_mm", "150", "lower the tip"),
    "tip in the root": (SHALLOW, [], "wheel.tip_diameter_mm", "156", "deepen the root"),
    "rack tip too round": (YANG, ["wheel.rack_tip_radius_mm=2"], "wheel.rack_tip_radius_mm", "2", "smaller tool tip"),
    "bore in the teeth": (
        YANG,
        ["pinion.bore_diameter_mm=36"],
        "pinion.bore_diameter_mm",
        "36",
        "make the bore smaller",
    ),
    "shifts too negative": (
        without(HE, "centre_distance_mm"),
        ["pinion.profile_shift=-2", "wheel.profile_shift=-2"],
        "wheel.profile_shift",
        "a sum of -4",
        "nearer to 0",
    ),
    "relief in the root": (
        YANG,
        ["wheel.tip_relief_um=20", "wheel.tip_relief_start_diameter_mm=130"],
        "wheel.tip_relief_start_diameter_mm",
        "130",
        "where on the involute",
    ),
    "root relief above the tip": (
        YANG,
        ["wheel.root_relief_um=5", "wheel.root_relief_end_diameter_mm=150"],
        "wheel.root_relief_end_diameter_mm",
        "150",
        "where on the involute the relief ends",
    ),
    "root relief below the active profile": (
        YANG,
        ["pinion.root_relief_um=5", "pinion.root_relief_end_diameter_mm=36"],
        "pinion.root_relief_end_diameter_mm",
        "36",
        "where on the involute the relief ends",
    ),
    "profile from the root circle on": (
        YANG,
        ["pinion.profile_slope_um=5", "pinion.profile_control_diameter_mm=36"],
        "pinion.profile_control_diameter_mm",
        "36",
        "where the evaluated profile begins",
    ),
    "end relief beyond mid-face": (
        YANG,
        ["wheel.end_relief_um=5", "wheel.end_relief_length_mm=9"],
        "wheel.end_relief_length_mm",
        "9",
        "either end of the face",
    ),
    "slope and relief of the whole tip": (
        YANG, ["pinion.tip_relief_um=400", "pinion.helix_slope_um=-450"], "pinion.helix_slope_um", "-450 (so",
        "lower them",
    ),
    "relief of the whole tip": (
        YANG, ["pinion.tip_relief_um=400", "pinion.lead_crowning_um=300"], "pinion.tip_relief_um", "400 (so",
        "lower them",
    ),
    "load beyond small strain": (YANG, ["load.torque_Nm=1e6"], "load.torque_Nm", "1000000 (teeth bend", "lower the"),
}
"""Case -> scene, overrides; key, what was found and a part of the remedy that the message must have."""
