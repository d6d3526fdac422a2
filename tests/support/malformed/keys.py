"""Scenes with keys that are missing, unknown, not supported or of another type."""

from __future__ import annotations

from tests.support.scene_texts import HE, YANG, without

WRONG_KEYS: dict[str, tuple[str, list[str], str, str, str]] = {
    # missing
    "empty file": ("", [], "pair", "nothing", "add a section [pair]"),
    "no torque": (without(YANG, "torque_Nm"), [], "load.torque_Nm", "nothing", "give the torque"),
    "no teeth": (without(YANG, "teeth"), [], "pinion.teeth", "nothing", "external gears"),
    "no module": (without(YANG, "normal_module_mm"), [], "pair.normal_module_mm", "nothing", "normal (not the trans"),
    "no face width": (without(HE, "face_width_mm"), [], "pinion.face_width_mm", "nothing", "give a number"),
    "no load section": (YANG.replace("[load]", "[pair.load]"), [], "load", "nothing", "add a section [load]"),
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
    "key with another unit": (
        YANG, ["load.torque_Nmm=250e3"], "load.torque_Nmm", "250000", "mean load.torque_Nm? Then divide by 1000; else",
    ),
    "misspelled section in the place of one": (YANG.replace("[load]", "[laod]"), [], "laod", "torque_Nm", "mean load?"),
    "unknown to all": (YANG, ["mesh.xyzzy=1"], "mesh.xyzzy", "1", "delete it"),
    # wrong type
    "text for a number": (YANG, ['load.torque_Nm="250 Nm"'], "load.torque_Nm", '"250 Nm"', "write the number alone"),
    "truth value for a number": (YANG, ["load.torque_Nm=true"], "load.torque_Nm", "true", "write a number"),
    "teeth with a point": (YANG, ["pinion.teeth=20.0"], "pinion.teeth", "20.0", "write 20"),
    "teeth in words": (YANG, ["pinion.teeth=twenty"], "pinion.teeth", '"twenty"', "write the whole number alone"),
    "teeth in quotes": (YANG, ['pinion.teeth="20"'], "pinion.teeth", '"20"', "write 20"),
    "teeth too few and with a point": (YANG, ["pinion.teeth=3.0"], "pinion.teeth", "3.0", "write a whole number"),
    "truth value for teeth": (YANG, ["pinion.teeth=true"], "pinion.teeth", "true", "write a whole number"),
    "fraction of a tooth": (YANG, ["pinion.teeth=17.5"], "pinion.teeth", "17.5", "write a whole number"),
    "number for a truth value": (YANG, ["output.fields=1"], "output.fields", "1", "give true or false"),
    "list for a number": (YANG, ["pinion.teeth=[17]"], "pinion.teeth", "[17]", "write 17"),
    "number for a section": (YANG, ["mesh=3"], "mesh", "3", "write [mesh]"),
    "section for a number": (
        YANG,
        ["load.torque_Nm.value=3"],
        "load.torque_Nm.value",
        "below load.torque_Nm",
        "docs/scene.md",
    ),
    "text in a list": (YANG, ['contact.friction=[0.1, "a"]'], "contact.friction[1]", '"a"', "write the number alone"),
    "date for a number": (YANG, ["load.torque_Nm=2022-01-01"], "load.torque_Nm", "2022-01-01", "write a number"),
    # of another type, though Python takes it
    "order true": (YANG, ["mesh.order=true"], "mesh.order", "true", "give 1 or 2"),
    "order 2.0": (YANG, ["mesh.order=2.0"], "mesh.order", "2.0", "write 2"),
    "order a text": (YANG, ['mesh.order="2"'], "mesh.order", '"2"', "write 2"),
    "order false": (YANG, ["mesh.order=false"], "mesh.order", "false", "give 1 or 2"),
    "friction true": (YANG, ["contact.friction=true"], "contact.friction[0]", "true", "write a number"),
    "friction a section": (YANG, ["contact.friction={a=1}"], "contact.friction[0]", "a section with keys a", "write"),
    "positions false": (YANG, ["sweep.positions=false"], "sweep.positions", "false", "write a whole number"),
    "title a number": (YANG, ["title=3"], "title", "3", "give a text"),
    "title too long": (YANG, [f'title="{"a" * 5000}"'], "title", '"aaaa', "give a text of up to 200"),
    "title of half a character": (YANG, ['title="\udcff"'], "title", "", "give a text"),
    "level a number": (YANG, ["mesh.level=3"], "mesh.level", "3", "standard for results"),
    "level empty": (YANG, ['mesh.level=""'], "mesh.level", '""', "standard for results"),
    "hand a number": (YANG, ["pinion.hand=1"], "pinion.hand", "1", "delete the key"),
    "hand in capitals": (YANG, ["pinion.hand=Right"], "pinion.hand", '"Right"', 'write "right"'),
    "yes for a truth value": (YANG, ["output.pictures=yes"], "output.pictures", '"yes"', "give true or false"),
    "unknown skip": (YANG, ["skip.off=everything"], "skip.off[0]", '"everything"', "give names of this list"),
    "skip a number": (YANG, ["skip.off=[3]"], "skip.off[0]", "3", "give names of this list"),
    "table for a list": (YANG.replace("[pinion]", "[[pinion]]"), [], "pinion", "[a section", "write [pinion]"),
    "time for a number": (YANG, ["load.torque_Nm=07:32:00"], "load.torque_Nm", "07:32:00", "write a number"),
    "chart without a name": (YANG, ['pinion.flank_csv=""'], "pinion.flank_csv", '""', "delete the key"),
    "chart with a NUL": (YANG, ['pinion.flank_csv="a\\u0000.csv"'], "pinion.flank_csv", "NUL", "check the path"),
    "chart that is not there": (YANG, ["pinion.flank_csv=no/such.csv"], "pinion.flank_csv", "No such file", "check"),
    "chart that is a folder": (YANG, ['pinion.flank_csv="/"'], "pinion.flank_csv", "Is a directory", "check the path"),
    "chart with a long name": (
        YANG, [f'pinion.flank_csv="{"a" * 900}"'], "pinion.flank_csv", "name too long", "check the path",
    ),
    "chart with an endless name": (YANG, [f'pinion.flank_csv="{"a" * 5000}"'], "pinion.flank_csv", '"aaa', "delete"),
    "chart without end": (YANG, ['pinion.flank_csv="/dev/zero"'], "pinion.flank_csv", "a device", "to a file"),
    # not supported
    "end chamfer": (YANG, ["pinion.end_chamfer_mm=0.2"], "pinion.end_chamfer_mm", "0.2", "delete it"),
    "speed": (YANG, ["pinion.rpm=3000"], "pinion.rpm", "3000", "delete it"),
    "speed of the load": (YANG, ["load.speed_rpm=3000"], "load.speed_rpm", "3000", "delete it"),
    "shaft": (YANG + "[shaft]\nd = 3\n", [], "shaft", "an unknown section", "delete it"),
    "bearings": (YANG + "[bearing_1]\nx = 3\n", [], "bearing_1", "an unknown section", "delete it"),
    "oil": (YANG + "[lubricant]\noil = 'VG 100'\n", [], "lubricant", "an unknown section", "delete it"),
    "oil temperature": (YANG, ["contact.oil_temperature_C=80"], "contact.oil_temperature_C", "80", "delete it"),
    "yield stress": (YANG, ["material.yield_stress_MPa=800"], "material.yield_stress_MPa", "800", "delete it"),
    "bevel gears": (YANG, ["pair.type=bevel"], "pair.type", '"bevel"', "delete it"),
    "internal gear": (YANG, ["wheel.internal=true"], "wheel.internal", "true", "delete it"),
    "density": (YANG, ["material.density=7850"], "material.density", "7850", "delete it"),
    "roughness": (YANG, ["contact.roughness_um=0.8"], "contact.roughness_um", "0.8", "delete it"),
    "pitch error": (YANG, ["pinion.pitch_error_um=5"], "pinion.pitch_error_um", "5", "delete it"),
}
"""Case -> scene, overrides; key, what was found and a part of the remedy that the message must have."""

UNSUPPORTED: dict[str, str] = {
    "end chamfer": "chamfers of the teeth's ends are not supported",
    "speed": "there is no time and no speed",
    "speed of the load": "did you mean dynamics.speed_rpm",
    "shaft": "shafts are not modelled",
    "bearings": "bearings and shafts are not modelled",
    "oil": "lubrication is not supported",
    "oil temperature": "lubrication is not supported",
    "yield stress": "plasticity is not supported",
    "bevel gears": "spur and helical external pairs only",
    "internal gear": "internal gears are not supported",
    "density": "a run is quasi-static",
    "roughness": "roughness is not supported",
    "pitch error": "all teeth are alike",
}
"""Case -> what the message says of what is not supported."""
