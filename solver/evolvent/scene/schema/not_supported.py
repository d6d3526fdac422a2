"""What users may look for in a scene and Evolvent does not compute: patterns of key names, and what to answer."""

from __future__ import annotations

import re

NOT_SUPPORTED: tuple[tuple[str, str], ...] = (
    (r"chamfer|edge_?break|tip_?round", "tip chamfers and rounded tip edges are not supported, tip_relief_um is"),
    (r"root_?relief", "root relief is not supported as a key; a chart as pinion.flank_csv can have it"),
    (r"rpm|speed|omega|velocity|frequency|time", "there is no time and no speed: each position is quasi-static"),
    (r"power|kw", "there is no power without a speed: give the torque, load.torque_Nm"),
    (r"dynamic|damping|inertia|mass|density|vibration|noise|nvh", "dynamics is not supported: quasi-static"),
    (r"bearing|housing", "bearings and shafts are not modelled: bores are held rigidly, "
     "pair.misalignment_um takes what tilts them"),
    (r"shaft|key_?way|hub", "shafts are not modelled: the bore, bore_diameter_mm, is held rigidly"),
    (r"lubric|oil|viscosity|film|ehl|additive|grease", "lubrication is not supported, but by its friction coefficient, "
     "contact.friction"),
    (r"temperature|thermal|heat|flash|conductivity|expansion", "temperatures are not computed"),
    (r"internal|ring|annulus", "internal gears are not supported"),
    (r"planet|carrier|sun|idler|stage", "planetary sets and trains are not supported: one pair at a time"),
    (r"bevel|worm|hypoid|cross|cone", "only external cylindrical gears on parallel axes are supported"),
    (r"plastic|yield|hardening|creep", "plasticity is not supported: materials are linearly elastic"),
    (r"hardness|case_?depth|residual", "hardness and case depth have no part in it; wear takes K/H as "
     "wear.pinion_mm2_per_N"),
    (r"fatigue|life|pitting|safety|cycles_to|root_?stress|spalling|scuffing", "ratings and lives are not computed"),
    (r"rough|asperit|waviness|texture", "roughness is not supported: flanks are smooth"),
    (r"pitch_?error|index_?error|runout|eccentric", "all teeth are alike: pitch errors and runout are not supported"),
    (r"profile_?crowning|barrelling|helix_?(slope|relief|correction)|lead_?(slope|angle)|end_?relief|bias",
     "not supported as a key; a chart as pinion.flank_csv can have it"),
    (r"backlash", "backlash follows from pair.centre_distance_mm and the profile shifts"),
    (r"web|rim|spoke", "the body is a full ring from bore_diameter_mm to the root"),
)  # fmt: skip
"""Regular expression for the name of an unknown key, and what to answer."""


def not_supported(name: str) -> str:
    """The answer to an unknown key, empty where its name matches no pattern."""
    lower = name.lower()[:60]
    return next((words for pattern, words in NOT_SUPPORTED if re.search(rf"(^|_)({pattern})", lower)), "")
