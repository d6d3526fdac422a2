"""Quantities that users may look for in a scene but that Evolvent does not compute: patterns of key names, and answers.
"""

from __future__ import annotations

import re

NOT_SUPPORTED: tuple[tuple[str, str], ...] = (
    (r"(end_?|face_?|side_?)chamfer|edge_?break", "chamfers of the teeth's ends are not supported; tip_chamfer_um and "
      "tip_rounding_um are those of the tips"),
    (r"power|kw", "there is no power without a speed: give the torque, load.torque_Nm"),
    (r"bearing|housing", "bearings and shafts are not modelled: bores are held rigidly, "
     "pair.misalignment_um takes what tilts them"),
    (r"shaft|key_?way|hub", "shafts are not modelled: the bore, bore_diameter_mm, is held rigidly over "
     "support_width_mm; hub_diameter_mm is where a web ends"),
    (r"lubric|oil|viscosity|film|ehl|additive|grease", "lubrication is not supported, but by its friction coefficient, "
     "contact.friction"),
    (r"temperature|thermal|heat|flash|conductivity|expansion", "temperatures are not computed"),
    (r"internal|ring|annulus", "internal gears are not supported"),
    (r"planet|carrier|sun|idler|stage", "planetary sets and trains are not supported: one pair at a time"),
    (r"bevel|worm|hypoid|cross|cone", "only external cylindrical gears on parallel axes are supported"),
    (r"plastic|yield|hardening|creep", "plasticity is not supported: materials are linearly elastic"),
    (r"hardness|case_?depth|residual", "hardness and case depth have no part in it; wear takes K/H as "
     "wear.pinion_mm2_per_N"),
    (r"fatigue|life|pitting|safety|cycles_to|root_?stress|spalling|scuffing", "ratings and lives are not computed; "
     "[fatigue] and [strength] have stresses"),
    (r"rough|asperit|waviness|texture", "roughness is not supported: flanks are smooth"),
    (r"pitch_?error|index_?error|runout|eccentric", "all teeth are alike: pitch errors and runout are not supported"),
    (r"(profile|helix|lead)_?form|topograph", "not supported as a key; a chart as pinion.flank_csv can have it"),
    (r"backlash", "backlash follows from pair.centre_distance_mm, the profile shifts and "
      "tooth_thickness_allowance_um"),
    (r"(pair|pinion|wheel)\.((gear|pair)_?)?(type|kind)|(gear|pair)_?(type|kind)", "spur and helical external pairs "
     "only, told apart by pair.helix_angle_deg"),
    (r"web|spoke|rib|hole", "a web is a full disc, web_thickness_mm, between rim_thickness_mm and hub_diameter_mm, "
     "without holes, ribs and spokes"),
)
"""Regular expression for the name of an unknown key, perhaps behind its section's, and the answer."""


OUTSIDE_DYNAMICS: tuple[tuple[str, str], ...] = (
    (r"rpm|speed|omega|velocity|frequency|time", "there is no time and no speed outside [dynamics] and [transient]: "
     "a run is quasi-static"),
    (r"dynamic|damping|inertia|mass|density|vibration|noise|nvh", "a run is quasi-static; that is for [dynamics]"),
)
"""Regular expression for the name of an unknown key outside the sections `IN_TIME`, and the answer."""
IN_TIME = ("dynamics", "transient")
"""Sections with speeds and inertia."""


def not_supported(name: str, section: str = "") -> str:
    """The answer to an unknown key of a section, empty where it matches no pattern."""
    own, whole = name.lower()[:60], f"{section}.{name}".lower()[:60]
    names = (own,) if section in IN_TIME else (own, whole)  # its keys are not what is sought in vain
    patterns = NOT_SUPPORTED if section in IN_TIME else (*NOT_SUPPORTED, *OUTSIDE_DYNAMICS)
    found = (words for pattern, words in patterns if any(_begins(pattern, each) for each in names))
    return next(found, "")


def _begins(pattern: str, name: str) -> bool:
    """Whether a name, or a part of it behind an underscore, begins with a pattern."""
    return re.search(rf"(^|_)({pattern})", name) is not None
