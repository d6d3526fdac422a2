"""Scenes that are not TOML, not a value, or nested without end."""

from __future__ import annotations

from tests.support.scene_texts import YANG

NOT_PARSED: dict[str, tuple[str, list[str], str, str, str]] = {
    # no TOML, no override
    "no TOML": (YANG + "\n= 3\n", [], "scene file", "no TOML", "mend that line"),
    "key twice": (YANG + "\nyield_stress_MPa = 30.0\n", [], "scene file", "no TOML", "every key only once"),
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
    # nested, repeated, endless
    "brackets in brackets": (YANG + "x = " + "[" * 5000, [], "scene file", "nested too deep", "mend that line"),
    "tables in tables": (YANG + "x = " + "{a=" * 5000, [], "scene file", "nested too deep", "mend that line"),
    "lists in lists": (YANG, ["contact.friction=" + "[" * 100 + "]" * 100], "contact", "more than 8 deep", "the keys"),
    "dotted without end": (YANG, ["a" + ".a" * 5000 + "=1"], "--set", "a.a.a", "write for example"),
    "headings in headings": (YANG + "[a" + ".a" * 500 + "]\nb = 1\n", [], "a", "more than 8 deep", "the keys"),
    "override in brackets": (YANG, ["load.torque_Nm=" + "[" * 5000], "load.torque_Nm", '"[[[', "write for example"),
    "section twice": (YANG + "[pair]\n", [], "scene file", "no TOML", "every key only once"),
    "bare text": (YANG.replace("[pair]", "[pair]\nlevel = quick"), [], "scene file", "no TOML", '"quotes"'),
    "decimal comma": (
        YANG.replace("250", "250,0"), [], "scene file", "torque_Nm = 250,0", "a decimal point, not",
    ),
    "number with its unit behind": (
        YANG.replace("250", "250 Nm"), [], "scene file", "torque_Nm = 250 Nm", "no unit after a number",
    ),
    "escape sequence": (YANG.replace("250", "250\x1b[31m"), [], "scene file", "= 250?[31m", "mend that line"),
    "line of a megabyte": (YANG + "x = 1" + "a" * 900_000, [], "scene file", "aaa...", "no unit"),
    "no end of a text": (YANG + 'x = "a', [], "scene file", "no TOML", "mend that line"),
    "JSON": ('{"pair": {"normal_module_mm": 3}}', [], "scene file", "no TOML", "mend that line"),
    "unknown names of a megabyte": ("a" * 900_000 + " = 1\n" + YANG, [], "a" * 57 + "...", "unknown key", "delete it"),
    "ten thousand unknown keys": (
        YANG + "".join(f"k{i} = 1\n" for i in range(10_000)), [], "scene file", "9980 more errors", "mend these first",
    ),
    "key with a line break": (YANG, ['"a\\nb"=1'], '"\\"a\\\\nb\\""', "an unknown key", "delete it"),
    "Greek key": (YANG + '"τ" = 1\n', [], 'fatigue."τ"', "unknown key", "delete it"),
    "empty key": (YANG, ["=3"], "--set", '"=3"', "--set load.torque_Nm=300"),
    "nothing to set": (YANG, [""], "--set", '""', "--set load.torque_Nm=300"),
    "two dots": (YANG, ["pinion..teeth=17"], "--set", "pinion..teeth", "--set load.torque_Nm=300"),
    "colon for equals": (YANG, ["pinion.teeth:17"], "--set", "pinion.teeth:17", "--set load.torque_Nm=300"),
    "number without a zero": (YANG, ["load.torque_Nm=.5"], "load.torque_Nm", '".5"', "write 0.5"),
    "number with its unit": (YANG, ["load.torque_Nm=250Nm"], "load.torque_Nm", '"250Nm"', "no unit after a number"),
    "thousand with a comma": (YANG, ["load.torque_Nm=1,000"], "load.torque_Nm", '"1,000"', "not a comma"),
}
"""Case -> scene, overrides; key, what was found and a part of the remedy that the message must have."""
