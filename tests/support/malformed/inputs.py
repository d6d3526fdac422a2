"""Files and options that must be refused, with what the message must say; test_malformed.py goes through them."""

from __future__ import annotations

import codecs

import numpy as np

from evolvent.run.kinds.all import KINDS
from tests.support.scene_texts import HE

MANY_PARTS = b".".join([b"a"] * 9000)

# a scene file's bytes; what was found and a part of the remedy
SCENE_FILES: dict[str, tuple[bytes, str, str]] = {
    "UTF-16": (HE.encode("utf-16"), "text in UTF-16", "save the file as UTF-8"),
    "UTF-16, big end first": (codecs.BOM_UTF16_BE + HE.encode("utf-16-be"), "text in UTF-16", "save the file as UTF-8"),
    "UTF-16 without a mark": (HE.encode("utf-16-le"), "NUL character in line 1", "save the file as UTF-8"),
    "UTF-32": (HE.encode("utf-32"), "UTF-16", "save the file as UTF-8"),
    "Latin-1": ((HE + "# Zähne\n").encode("latin-1"), "the first 0xe4 in line", "Latin-1 or Windows-1252"),
    "Windows-1252": ((HE + "# 20 €\n").encode("cp1252"), "the first 0x80 in line", "Latin-1 or Windows-1252"),
    "EBCDIC": (HE.encode("cp500"), "no UTF-8 text", "save the file as UTF-8"),
    "cut character": (HE.encode() + b"# \xc3", "the first 0xc3 in line", "save the file as UTF-8"),
    "NUL at the end": (HE.encode() + b"\0", "a NUL character in line", "save the file as UTF-8"),
    "program": (b"\x7fELF\x02\x01\x01\0\0\0", "a NUL character in line 1", "save the file as UTF-8"),
    "picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "the first 0x89 in line 1", "save the file as UTF-8"),
    "compressed": (b"\x1f\x8b\x08\0", "the first 0x8b in line 1", "save the file as UTF-8"),
    "empty": (b"", "nothing", "add a section"),
    "a mark alone": (codecs.BOM_UTF8, "nothing", "add a section"),
    "blank lines": (b"\n" * 1000, "nothing", "add a section"),
    "two marks": (codecs.BOM_UTF8 + codecs.BOM_UTF8 + HE.encode(), "no TOML", "mend that line"),
    "two megabytes": (b"# " + b"a" * 2_000_000, "more than 1 MB", "is this the right file?"),
    "old Mac's line ends": (HE.replace("\n", "\r").encode(), "no TOML", "mend that line"),
    "bell": (HE.encode() + b'x = "\a"\n', "no TOML", "mend that line"),
    "YAML": (b"pair:\n  normal_module_mm: 3\n", "no TOML", "mend that line"),
    "XML": (b"<pair normal_module_mm='3'/>\n", "no TOML", "mend that line"),
    "INI's remarks": (HE.encode() + b"; remark\n", "no TOML", "mend that line"),
    "merge marks": (b"<<<<<<< HEAD\n" + HE.encode(), "no TOML", "mend that line"),
    "key of thousands of parts": (MANY_PARTS + b" = 1\n" + HE.encode(), "a key of 9,000 parts", "the keys"),
    "section of thousands of parts": (HE.encode() + b"[" + MANY_PARTS + b"]\n", "a key of 9,000 parts", "the keys"),
    "key of thousands of parts within": (
        HE.encode() + b"x = {b = 1, " + MANY_PARTS + b" = 1}\n", "a key of 9,000 parts", "the keys",
    ),
    "gmsh": (b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "no TOML", "mend that line"),
}

HEADER = "diameter_mm,depth_um\n"
DIAMETERS = np.linspace(144.0, 157.0, 14)
CHART = HEADER + "".join(f"{d},1.0\n" for d in DIAMETERS)
OVER_FACE = "diameter_mm,z_mm,depth_um\n" + "".join(f"{d},{z},1.0\n" for d in DIAMETERS for z in (-10, 10))

# bytes of a chart of He's pinion; what was found and a part of what is allowed or of the remedy
CHARTS: dict[str, tuple[bytes, str, str]] = {
    "UTF-16": (CHART.encode("utf-16"), "text in UTF-16", "save the file as UTF-8"),
    "Latin-1": (("# gemessen in Köln\n" + CHART).encode("latin-1"), "0xf6 in line 1", "Latin-1 or Windows-1252"),
    "NUL": (CHART.encode() + b"\0", "a NUL character", "save the file as UTF-8"),
    "empty": (b"", "0 lines", "name quantity and unit"),
    "header alone": (HEADER.encode(), "1 lines", "name quantity and unit"),
    "remarks alone": (b"# a\n# b\n# c\n", "0 lines", "name quantity and unit"),
    "no header": (CHART.removeprefix(HEADER).encode(), "144.0, 1.0", "one column named diameter_mm"),
    "semicolons": (CHART.replace(",", ";").encode(), "diameter_mm;depth_um", "separated by commas"),
    "tabs": (CHART.replace(",", "\t").encode(), "diameter_mm\tdepth_um", "separated by commas"),
    "decimal commas": (CHART.replace(".", ",").encode(), "4 cells", "decimals with a point"),
    "no unit": (CHART.replace("_um", "").encode(), "diameter_mm, depth", "depth_um or depth_mm"),
    "micrometres spelled out": (CHART.replace("_um", "_µm").encode(), "depth_µm", "depth_um or depth_mm"),
    "capitals": (CHART.upper().encode(), "DIAMETER_MM", "one column named diameter_mm"),
    "depth twice": (
        CHART.replace("_um\n", "_um,depth_mm\n").replace("1.0\n", "1.0,1.0\n").encode(), "depth_mm", "one column",
    ),
    "word": (CHART.replace("1.0", "deep", 1).encode(), "'deep'", "leave out lines without one"),
    "empty cell": (CHART.replace(",1.0", ",", 1).encode(), "''", "leave out lines without one"),
    "infinity": (CHART.replace("1.0", "inf", 1).encode(), "'inf'", "a number of at most"),
    "not a number": (CHART.replace("1.0", "nan", 1).encode(), "'nan'", "a number of at most"),
    "overflow": (CHART.replace("1.0", "1e400", 1).encode(), "'1e400'", "a number of at most"),
    "thousands": (CHART.replace("1.0", "1_0", 1).encode(), "'1_0'", "leave out lines without one"),
    "hexadecimal": (CHART.replace("1.0", "0x10", 1).encode(), "'0x10'", "leave out lines without one"),
    "cell of a megabyte": (CHART.replace("1.0", "1" * 1_000_000, 1).encode(), "no CSV", "save the table as CSV"),
    "quote without end": ((CHART + '"').encode(), "no CSV", "save the table as CSV"),
    "long line": ((CHART + "150.5,1.0,3\n").encode(), "3 cells", "2 cells"),
    "one diameter": ((HEADER + "150,1.0\n").encode(), "1 diameters", "two diameters at least"),
    "same diameter twice": ((CHART + "144.0,1.0\n").encode(), "2 lines for diameter 144", "leave out repeated"),
    "gap in the grid": ((OVER_FACE + "151.5,10,1.0\n").encode(), "0 lines for diameter 151.5", "fill gaps"),
    "of another gear": (CHART.replace("14", "24").encode(), "150 to 249 mm", "diameters over the whole active"),
    "negative diameters": ((CHART + "-150,1.0\n").encode(), "-150 to 157 mm", "mind the unit"),
    "diameter of the universe": ((CHART + "1e14,1.0\n").encode(), "144 to 1e+14 mm", "mind the unit"),
    "diameter beyond it": ((CHART + "1e300,1.0\n").encode(), "'1e300'", "a number of at most 1e+15"),
    "depth of the universe": (CHART.replace("1.0", "1e14", 1).encode(), "1e+14 µm", "is the column's unit right?"),
    "height of the universe": ((OVER_FACE.replace(",10,", ",1e14,")).encode(), "-10 to 1e+14 mm", "z is 0 at mid-face"),
    "wrong side of the face": (OVER_FACE.replace("-10", "9").encode(), "9 to 10 mm", "z is 0 at mid-face"),
}

RECORD_HEADER = "sliding_distance_m,depth_um\n"
RECORD = RECORD_HEADER + "".join(f"{1000 * k},{2.4 * k}\n" for k in range(1, 9))

# bytes of a pin-on-disc record; what was found and a part of what is allowed or of the remedy
RECORDS: dict[str, tuple[bytes, str, str]] = {
    "UTF-16": (RECORD.encode("utf-16"), "text in UTF-16", "save the file as UTF-8"),
    "Latin-1": ((RECORD + "# Öl\n").encode("latin-1"), "0xd6 in line 10", "Latin-1 or Windows-1252"),
    "empty": (b"", "0 lines", "name quantity and unit"),
    "header alone": (RECORD_HEADER.encode(), "1 lines", "name quantity and unit"),
    "one line": ((RECORD_HEADER + "1000,1\n").encode(), "1", "at least 5 lines"),
    "time for distance": (RECORD.replace("sliding_distance_m", "time_s").encode(), "time_s", "sliding_distance_mm or"),
    "falling distance": ("\n".join([RECORD_HEADER.strip(), *RECORD.splitlines()[:0:-1]]).encode(), "8000 m", "sort"),
    "same distance": ((RECORD_HEADER + "1000,1\n" * 8).encode(), "1000 m and then 1000 m", "sort the lines"),
    "no wear": ((RECORD_HEADER + "".join(f"{k},1\n" for k in range(8))).encode(), "0", "is the record's depth rising"),
    "depth called mm": ((RECORD_HEADER.replace("_um", "_mm") + "".join(f"{k},{k}\n" for k in range(9))).encode(),
                        "5.65e-05", "is the record's depth rising"),
    "distances overflow": (RECORD.replace("8000,", "1e305,").encode(), "'1e305'", "a number of at most 1e+12"),
    "distances underflow": (
        (RECORD_HEADER + "".join(f"{k}e-300,{k}\n" for k in range(1, 9))).encode(), "", "a K/H between 0 and",
    ),
    "infinite depth": (RECORD.replace("2.4", "inf", 1).encode(), "'inf'", "a number of at most"),
    "word": (RECORD.replace("2.4", "much", 1).encode(), "'much'", "leave out lines without one"),
}

TEST = ["--force-N", "500", "--pin-diameter-mm", "6"]
SCENE = "{scene}"
COMMANDS = ", ".join([*(kind.name for kind in KINDS if kind.command == kind.name), "study, check, mesh"])

# arguments of the command line; key, what was found and a part of what is allowed or of the remedy
OPTIONS: dict[str, tuple[list[str], str, str, str]] = {
    "unknown command": (["walk"], "command", '"walk"', COMMANDS),
    "misspelled command": (["chekc", SCENE], "command", '"chekc"', "did you mean check?"),
    "command in capitals": (["RUN", SCENE], "command", '"RUN"', COMMANDS),
    "scene for a command": ([SCENE], "command", "scene.toml", COMMANDS),
    "option for a command": (["--levle"], "--levle", "an unknown option", "--help"),
    # run
    "run: no scene": (["run"], "SCENE.toml", "nothing", "the scene file"),
    "run: no folder": (["run", SCENE], "--out", "nothing", "write --out out/mine"),
    "run: folder without a name": (["run", SCENE, "--out"], "--out", "nothing", "a value behind the option"),
    "run: empty folder": (["run", SCENE, "--out", ""], "--out", "an empty text", "where tables, fields and pict"),
    "run: empty folder after =": (["run", SCENE, "--out="], "--out", "an empty text", "where tables, fields and pict"),
    "run: empty scene": (["run", "", "--out", "{folder}/out"], "SCENE.toml", "an empty text", "the scene file"),
    "run: two scenes": (["run", SCENE, SCENE, "--out", "{folder}/out"], "arguments", "scene.toml", "leave it out"),
    "run: option of other commands": (
        ["run", SCENE, "--out", "OUT", "--percent", "50"], "--percent", "an unknown option",
        "take a command that has it: evolvent loads, losses, excitation",
    ),
    "run: unknown option": (["run", SCENE, "--levl", "quick"], "--levl", "an unknown option", "did you mean --level?"),
    "run: short option": (["run", SCENE, "-o", "out"], "-o", "an unknown option", "--out"),
    "run: flag with a value": (["run", SCENE, "--resume=yes"], "--resume", "a value", "leave the value out"),
    "run: force with a value": (["run", SCENE, "--force=3"], "--force", "a value", "leave the value out"),
    "run: empty level": (["run", SCENE, "--out", "{folder}/out", "--level", ""], "mesh.level", '""', "quick is for"),
    "run: unknown level": (["run", SCENE, "--out", "{folder}/out", "--level", "ultra"], "mesh.level", "ultra", "quick"),
    "run: level with quotes": (
        ["run", SCENE, "--out", "{folder}/out", "--level", 'fine"'], "mesh.level", '"fine\\""', 'write "fine"',
    ),
    "run: level without a name": (["run", SCENE, "--level"], "--level", "nothing", "a value behind the option"),
    "run: set without a value": (["run", SCENE, "--set"], "--set", "nothing", "a value behind the option"),
    "run: set nothing": (["run", SCENE, "--out", "{folder}/out", "--set", ""], "--set", '""', "write for example"),
    "run: no skip of that name": (
        ["run", SCENE, "--out", "{folder}/out", "--exact", "pictres"],
        "exact.parts[0]", '"pictres"', 'write "pictures"',
    ),
    "run: empty skip": (
        ["run", SCENE, "--out", "{folder}/out", "--exact", ""], "exact.parts[0]", '""', "give names of",
    ),
    "run: no such scene": (
        ["run", "{folder}/no.toml", "--out", "{folder}/out"], "scene file", "No such file", "check the path",
    ),
    "run: scene is a folder": (["run", "{folder}", "--out", "{folder}/out"], "scene file", "Is a directory", "check"),
    "run: scene below a file": (
        ["run", "{scene}/x", "--out", "{folder}/out"], "scene file", "Not a directory", "check the path",
    ),
    "run: endless scene": (["run", "/dev/zero", "--out", "{folder}/out"], "scene file", "a device", "to a file"),
    "run: no scene at all": (
        ["run", "/dev/null", "--out", "{folder}/out"], "scene file", "a device", "to a file",
    ),
    "run: scene with a long name": (
        ["run", "a" * 5000, "--out", "{folder}/out"], "scene file", "name too long", "check the path",
    ),
    "run: scene with a NUL": (["run", "a\0b", "--out", "{folder}/out"], "scene file", "NUL character", "check the"),
    "run: scene of broken bytes": (
        ["run", "\udcff.toml", "--out", "{folder}/out"], "scene file", "No such file", "check the path",
    ),
    "run: scene is a table": (["run", "{record}", "--out", "{folder}/out"], "scene file", "no TOML", "mend that line"),
    "run: resume and overwrite": (
        ["run", SCENE, "--out", "{folder}/out", "--resume", "--overwrite"], "--overwrite", "--resume and --overwrite",
        "one of them",
    ),
    "run: no PETSc options": (["run", SCENE, "--petsc-options"], "--petsc-options", "nothing", "a value behind"),
    # check
    "check: no scene": (["check"], "SCENE.toml", "nothing", "the scene file"),
    "check: empty scene": (["check", ""], "SCENE.toml", "an empty text", "the scene file"),
    "check: no such scene": (["check", "{folder}/no.toml"], "scene file", "No such file", "check the path"),
    "check: two scenes": (["check", SCENE, "b.toml"], "arguments", '"b.toml"', "leave it out"),
    "check: no picture": (["check", SCENE, "--out", "x"], "--out", "x", "a name that ends in .png"),
    "check: empty level": (["check", SCENE, "--level="], "mesh.level", '""', "quick is for orientation"),
    "check: level twice": (["check", SCENE, "--level", "quick", "--level", "3"], "mesh.level", '"3"', "quick is for"),
    "check: level by key": (["check", SCENE, "--set", "level=quick"], "level", '"quick"', "did you mean mesh.level?"),
    "check: order true": (["check", SCENE, "--set", "mesh.order=true"], "mesh.order", "true", "give 1 or 2"),
    "check: torque of rounding": (["check", SCENE, "--set", "load.torque_Nm=1e-300"], "load.torque_Nm", "1e-300", ""),
    "check: key of broken bytes": (["check", SCENE, "--set", "\udcff=1"], "--set", "\\udcff", "write for example"),
    "check: key of control characters": (["check", SCENE, "--set", "load.\x1b=1"], "--set", "\\x1b", "write for"),
    "check: empty picture": (["check", SCENE, "--out", ""], "--out", "an empty text", "write --out teeth.png"),
    "loads: a name too long": (["loads", SCENE, "--out", "n" * 5000], "--out", "name too long", "name another one"),
    "check: broken bytes": (["check", SCENE, "--set", 'title="\udcff"'], "title", "", "give a text"),
    # mesh
    "mesh: no file": (["mesh", SCENE], "--out", "nothing", "write --out pair.msh"),
    "mesh: empty file": (["mesh", SCENE, "--out", ""], "--out", "an empty text", "the gmsh file to write"),
    "mesh: other format": (["mesh", SCENE, "--out", "{folder}/a.stl"], "--out", "a.stl", "ends in .msh"),
    "mesh: no ending": (["mesh", SCENE, "--out", "{folder}/a"], "--out", "/a", "ends in .msh"),
    "mesh: resume": (["mesh", SCENE, "--out", "{folder}/a.msh", "--resume"], "--resume", "unknown", "--out"),
    "mesh: no such scene": (["mesh", "no.toml", "--out", "{folder}/a.msh"], "scene file", "No such file", "check the"),
    "mesh: unknown level": (
        ["mesh", SCENE, "--out", "{folder}/a.msh", "--level", "0"], "mesh.level", '"0"', "quick is for orientation",
    ),
    "mesh: too large": (
        ["mesh", SCENE, "--out", "{folder}/a.msh", "--set", "load.torque_Nm=1e-4", "--set",
         "wheel.face_width_mm=19"],
        "mesh.level", "degrees of freedom", "no mesh fits: the contact is too narrow",
    ),
    "mesh: a folder": (["mesh", SCENE, "--out", "{folder}"], "--out", "{folder}", ".msh"),
    "mesh: over a file": (["mesh", SCENE, "--out", SCENE], "--out", "scene.toml", "ends in .msh"),
    # plot
    "plot: nothing": (["plot"], "DIR", "nothing", "where a command has put its results"),
    "plot: empty": (["plot", ""], "DIR", "an empty text", "where a command has put its results"),
    "plot: no such folder": (["plot", "{folder}/no"], "{folder}/no", "no such directory", "of a finished command"),
    "plot: a name too long": (["plot", "n" * 5000], "n" * 5000, "no such directory", "of a finished command"),
    "plot: a file": (["plot", SCENE], SCENE, "no such directory", "the --out of a finished command"),
    "plot: another folder": (["plot", "{folder}"], "{folder}", "no results in it", "of a finished command"),
    "plot: two folders": (["plot", "{folder}", "b"], "arguments", '"b"', "leave it out"),
    "plot: unknown option": (["plot", "{folder}", "--dpi", "300"], "--dpi", "an unknown option", "plot --help"),
    # info
    "info: an argument": (["info", "all"], "arguments", '"all"', "leave it out"),
    "info: unknown option": (["info", "--json"], "--json", "an unknown option", "evolvent info --help"),
    # wear-coefficient
    "record: nothing": (["wear-coefficient"], "RECORD.csv...", "nothing", "columns sliding_distance_m"),
    "record: empty": (["wear-coefficient", "", *TEST], "RECORD.csv...", "an empty text", "columns sliding_distance_m"),
    "record: no such file": (["wear-coefficient", "no.csv", *TEST], "no.csv", "No such file", "check the path"),
    "record: a folder": (["wear-coefficient", "{folder}", *TEST], "{folder}", "Is a directory", "check the path"),
    "record: endless": (["wear-coefficient", "/dev/zero", *TEST], "/dev/zero", "a device", "to a file"),
    "record: too large": (["wear-coefficient", "{large}", *TEST], "{large}", "more than 20 MB", "right file?"),
    "record: a scene": (["wear-coefficient", SCENE, *TEST], SCENE, "title", "one column named sliding_distance"),
    "record: second one missing": (["wear-coefficient", "{record}", "no.csv", *TEST], "no.csv", "No such file", ""),
    "record: no force": (["wear-coefficient", "{record}", *TEST[2:]], "--force-N", "nothing", "normal force on"),
    "record: no diameter": (["wear-coefficient", "{record}", *TEST[:2]], "--pin-diameter-mm", "nothing", "of the pin"),
    "record: force a word": (
        ["wear-coefficient", "{record}", *TEST, "--force-N", "much"], "--force-N", '"much", no number', "normal force",
    ),
    "record: force with its unit": (
        ["wear-coefficient", "{record}", *TEST, "--force-N", "500N"], "--force-N", '"500N", no number', "normal force",
    ),
    "record: decimal comma": (
        ["wear-coefficient", "{record}", *TEST, "--pin-diameter-mm", "6,5"], "--pin-diameter-mm", '"6,5"', "diameter",
    ),
    **{
        f"record: force {value}": (
            ["wear-coefficient", "{record}", *TEST, f"--force-N={value}"], "force on the pin (--force-N)", found,
            "a number from 1e-06 to 1e+09 N",
        )
        for value, found in (("0", "0"), ("-500", "-500"), ("nan", "nan"), ("inf", "inf"), ("1e300", "1e+300"))
    },
    **{
        f"record: pin {value}": (
            ["wear-coefficient", "{record}", *TEST, f"--pin-diameter-mm={value}"],
            "diameter of the pin (--pin-diameter-mm)", found, "a number from 0.001 to 10000 mm",
        )
        for value, found in (("0", "0"), ("-6", "-6"), ("nan", "nan"), ("1e200", "1e+200"), ("1e-300", "1e-300"))
    },
    **{
        f"record: running in {value}": (
            ["wear-coefficient", "{record}", *TEST, f"--run-in-m={value}"], "running in (--run-in-m)", found,
            "a sliding distance from 0 m on",
        )
        for value, found in (("-5", "-5 m"), ("nan", "nan m"), ("-inf", "-inf m"))
    },
    "record: running in too long": (
        ["wear-coefficient", "{record}", *TEST, "--run-in-m=1e300"], "{record}", "0", "at least 5 lines",
    ),
    "record: running in without end": (
        ["wear-coefficient", "{record}", *TEST, "--run-in-m=inf"], "{record}", "0", "at least 5 lines",
    ),
    "record: running in empty": (
        ["wear-coefficient", "{record}", *TEST, "--run-in-m="], "--run-in-m", '"", no number', "sliding distance that",
    ),
}
