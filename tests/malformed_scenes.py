"""Scenes that must be refused, with what the message must say; test_scene.py and test_cli.py go through them."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
DEMOS = ROOT / "demos"
YANG = (DEMOS / "yang2022.toml").read_text(encoding="utf-8")
HE = (DEMOS / "he2022.toml").read_text(encoding="utf-8")


def without(text: str, start: str) -> str:
    """The scene without the first line that starts so."""
    return re.sub(rf"^{re.escape(start)}.*\n", "", text, count=1, flags=re.MULTILINE)


WEAR = ["wear.cycles=1e6", "wear.pinion_mm2_per_N=1e-10"]
SHALLOW = HE.replace("dedendum_coefficient = 1.25", "dedendum_coefficient = 0.95")

# a scene and its overrides; the key, what was found and a part of the remedy that the message must have
MALFORMED: dict[str, tuple[str, list[str], str, str, str]] = {
    # missing
    "empty file": ("", [], "pair", "nothing", "add a section [pair]"),
    "no torque": (without(YANG, "torque_Nm"), [], "load.torque_Nm", "nothing", "give the torque"),
    "no teeth": (without(YANG, "teeth"), [], "pinion.teeth", "nothing", "external gears"),
    "no module": (without(YANG, "normal_module_mm"), [], "pair.normal_module_mm", "nothing", "normal (not the trans"),
    "no face width": (without(HE, "face_width_mm"), [], "pinion.face_width_mm", "nothing", "give a number"),
    "no load section": (YANG.replace("[load]", "[pair.load]"), [], "load", "nothing", "add a section [load]"),
    # wear
    "no cycles": (HE, ["wear.pinion_mm2_per_N=1e-10"], "wear.cycles", "nothing", "give a number"),
    "nothing wears": (HE, ["wear.cycles=1e6"], "wear.pinion_mm2_per_N", "0 on both gears", "delete the section [wear]"),
    "K/H in MPa·m": (HE, [*WEAR, "wear.wheel_mm2_per_N=1e-4"], "wear.wheel_mm2_per_N", "0.0001", "1e6 mm²/N"),
    "K/H in m²/N": (HE, [*WEAR, "wear.wheel_mm2_per_N=1e-17"], "wear.wheel_mm2_per_N", "1e-17", "mind the unit"),
    "negative K/H": (HE, [*WEAR, "wear.wheel_mm2_per_N=-1e-10"], "wear.wheel_mm2_per_N", "-1e-10", "mind the unit"),
    "K/H not a number": (HE, [*WEAR, "wear.wheel_mm2_per_N=nan"], "wear.wheel_mm2_per_N", "nan", "mind the unit"),
    "cycles a text": (HE, [*WEAR, 'wear.cycles="many"'], "wear.cycles", '"many"', "give a number"),
    "reports unsorted": (HE, [*WEAR, "wear.report_at_cycles=[2e5, 1e5]"], "wear.report_at_cycles", "[200000", "sort"),
    "report twice": (HE, [*WEAR, "wear.report_at_cycles=[2e5, 2e5]"], "wear.report_at_cycles", "[200000", "sort"),
    "report too late": (HE, [*WEAR, "wear.report_at_cycles=1e6"], "wear.report_at_cycles", "[1000000", "the last"),
    "tolerance in percent": (HE, [*WEAR, "wear.tolerance=5.0"], "wear.tolerance", "5", "give a number"),
    "first block too long": (HE, [*WEAR, "wear.first_block_cycles=2e6"], "wear.first_block_cycles", "2000000", "short"),
    "blocks of another kind": (HE, [*WEAR, "wear.blocks=midpoint"], "wear.blocks", "midpoint", "implicit"),
    "wear at several μ": (YANG, WEAR, "contact.friction", "[0", "give one coefficient"),
    "wear of all pitches": (HE, [*WEAR, "skip.off=one-pitch"], "skip.off", "one-pitch", "leave one-pitch out"),
    "wear of deflected flanks": (
        HE, [*WEAR, "skip.off=deflected-flanks"], "skip.off", "deflected-flanks", "leave deflected-flanks out",
    ),
    "wear a number": (HE, ["wear=1e6"], "wear", "1000000", "[wear]"),
    "worn away": (HE, [*WEAR, "wear.cycles=1e12"], "wear.cycles", "1e+12", "fewer cycles"),
    # unknown
    "misspelled key": (
        YANG,
        ["pinion.proffile_shift=0.3"],
        "pinion.proffile_shift",
        "0.3",
        "mean pinion.profile_shift?",
    ),
    "misspelled section": (YANG, ["pinon.teeth=17"], "pinon", "an unknown section", "did you mean pinion?"),
    "key of another section": (YANG, ["load.friction=0.1"], "load.friction", "0.1", "did you mean contact.friction?"),
    "key without its unit": (YANG, ["load.torque=250"], "load.torque", "250", "did you mean load.torque_Nm?"),
    "unknown to all": (YANG, ["mesh.xyzzy=1"], "mesh.xyzzy", "1", "delete it"),
    # wrong type
    "text for a number": (YANG, ['load.torque_Nm="250 Nm"'], "load.torque_Nm", '"250 Nm"', "give the torque"),
    "truth value for a number": (YANG, ["load.torque_Nm=true"], "load.torque_Nm", "true", "give the torque"),
    "truth value for teeth": (YANG, ["pinion.teeth=true"], "pinion.teeth", "true", "external gears only"),
    "fraction of a tooth": (YANG, ["pinion.teeth=17.5"], "pinion.teeth", "17.5", "external gears only"),
    "number for a truth value": (YANG, ["output.fields=1"], "output.fields", "1", "give true or false"),
    "list for a number": (YANG, ["pinion.teeth=[17]"], "pinion.teeth", "[17]", "external gears only"),
    "number for a section": (YANG, ["mesh=3"], "mesh", "3", "write [mesh]"),
    "section for a number": (
        YANG,
        ["load.torque_Nm.value=3"],
        "load.torque_Nm.value",
        "below load.torque_Nm",
        "docs/scene.md",
    ),
    "text in a list": (YANG, ['contact.friction=[0.1, "a"]'], "contact.friction[1]", '"a"', "0 is frictionless"),
    "date for a number": (YANG, ["load.torque_Nm=2022-01-01"], "load.torque_Nm", "2022-01-01", "give the torque"),
    # out of range
    "zero torque": (YANG, ["load.torque_Nm=0"], "load.torque_Nm", "0", "give the torque without a sign"),
    "negative torque": (YANG, ["load.torque_Nm=-250"], "load.torque_Nm", "-250", "without a sign, the pinion drives"),
    "torque NaN": (YANG, ["load.torque_Nm=nan"], "load.torque_Nm", "nan", "give the torque"),
    "torque infinite": (YANG, ["load.torque_Nm=inf"], "load.torque_Nm", "inf", "give the torque"),
    "friction NaN": (YANG, ["contact.friction=nan"], "contact.friction[0]", "nan", "0 is frictionless"),
    "module infinite": (YANG, ["pair.normal_module_mm=inf"], "pair.normal_module_mm", "inf", "give the normal"),
    "negative friction": (YANG, ["contact.friction=[0.1,-0.1]"], "contact.friction[1]", "-0.1", "0 is frictionless"),
    "friction above 1": (YANG, ["contact.friction=1.5"], "contact.friction[0]", "1.5", "dry steel up to 0.3"),
    "no friction in the list": (YANG, ["contact.friction=[]"], "contact.friction", "an empty list", "at least one"),
    "friction twice": (YANG, ["contact.friction=[0.1,0.2,0.1]"], "contact.friction", "0.1 more than once", "repeated"),
    "too many teeth": (YANG, ["wheel.teeth=100000"], "wheel.teeth", "100000", "external gears only"),
    "ring gear": (YANG, ["wheel.teeth=-60"], "wheel.teeth", "-60", "external gears only"),
    "module 0": (YANG, ["pair.normal_module_mm=0"], "pair.normal_module_mm", "0", "give the normal"),
    "helix with a sign": (YANG, ["pair.helix_angle_deg=-29"], "pair.helix_angle_deg", "-29", "with pinion.hand"),
    "helix in radians' place": (YANG, ["pair.helix_angle_deg=89"], "pair.helix_angle_deg", "89", "pinion.hand"),
    "pressure angle": (YANG, ["pair.normal_pressure_angle_deg=45"], "pair.normal_pressure_angle_deg", "45", "from 10"),
    "face width": (YANG, ["pinion.face_width_mm=-16.9"], "pinion.face_width_mm", "-16.9", "give a number from 0.1"),
    "modulus in MPa": (YANG, ["material.E_GPa=210000"], "material.E_GPa", "210000", "mind GPa, not MPa"),
    "wheel's modulus": (YANG, ["material.wheel.E_GPa=-1"], "material.wheel.E_GPa", "-1", "steel is 210"),
    "incompressible": (YANG, ["material.nu=0.5"], "material.nu", "0.5", "steel is 0.3"),
    "one position": (YANG, ["sweep.positions=1"], "sweep.positions", "1", "20 is usual"),
    "unknown level": (YANG, ["mesh.level=ultra"], "mesh.level", '"ultra"', "standard for results"),
    "third order": (YANG, ["mesh.order=3"], "mesh.order", "3", "give 1 or 2"),
    "prisms": (YANG, ["mesh.shape=prism"], "mesh.shape", '"prism"', 'give "hexahedron" or'),
    "no elements": (YANG, ["mesh.elements_per_contact_width=0"], "mesh.elements_per_contact_width", "0", "level's own"),
    "torque on the shaft": (YANG, ["load.on=shaft"], "load.on", '"shaft"', 'give "pinion" or "wheel"'),
    # in conflict
    "two tips": (YANG, ["pinion.addendum_coefficient=1"], "pinion.tip_diameter_mm", "47.8 and also", "delete tip_dia"),
    "two roots": (HE, ["wheel.root_diameter_mm=142"], "wheel.root_diameter_mm", "142 and also", "delete root_dia"),
    "same hands": (YANG, ["wheel.hand=right"], "wheel.hand", '"right"', "follows from the pinion's"),
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
    "load beyond small strain": (YANG, ["load.torque_Nm=1e6"], "load.torque_Nm", "1000000 (Hertz", "lower the torque"),
    # no TOML, no override
    "no TOML": (YANG + "\n= 3\n", [], "scene file", "no TOML", "mend that line"),
    "key twice": (YANG + "\npositions = 30\n", [], "scene file", "no TOML", "every key only once"),
    "override without value": (YANG, ["load.torque_Nm"], "--set", "load.torque_Nm", "--set load.torque_Nm=300"),
    "override with an empty value": (
        YANG,
        ["load.torque_Nm="],
        "load.torque_Nm",
        "nothing after the =",
        "'load.torque_Nm=1.5'",
    ),
    "override that is no TOML": (
        YANG,
        ["contact.friction=[0.1"],
        "contact.friction",
        '"[0.1"',
        "in quotes for the shell",
    ),
    "override with a second key": (YANG, ["load.torque_Nm=3\nx=4"], "load.torque_Nm", '"3\\nx=4"', "--set"),
}
