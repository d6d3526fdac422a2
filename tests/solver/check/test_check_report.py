"""What `evolvent check` prints: gear data, charts, columns, signs, warnings; a paper only where one is asked for.

The derived gear data are compared with the figures of the three papers (external).
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from evolvent.check.check_report import overview
from evolvent.scene.scene import load_scene, scene_from_text
from tests.support.checkout import ROOT
from tests.support.gear_cases import helical_scene, spur_scene
from tests.support.scene_texts import DEMOS, HE, YANG

SCENES = ("yang2022", "he2022", "zhang2023")


def text_of(name: str, *settings: str) -> str:
    return overview(load_scene(ROOT / f"demos/{name}.toml", settings))


def test_flank_charts_are_reported(tmp_path: Path) -> None:
    """Problem: a wheel whose chart lacks 7.5 µm at most, a pinion as designed. Exact: the file's name and 7.5; scenes
    without charts have no such rows."""
    path = tmp_path / "worn_after_a_million.csv"
    path.write_text("diameter_mm,depth_um\n120,2.0\n150,7.5\n170,1.0\n", encoding="utf-8")
    text = overview(spur_scene(f"wheel.flank_csv={path}"))
    assert re.search(r"chart of the flank +none worn_after_a_million\.csv$", text, re.MULTILINE)
    assert re.search(r"missing at most, beside modifications +µm +– +7\.5$", text, re.MULTILINE)
    assert "chart" not in overview(spur_scene())


def test_modifications_are_reported_where_there_are_any() -> None:
    """Tip relief and lead crowning always, others where either gear has them; twist of the wheel alone: 0 and −4 µm."""
    plain, text = overview(spur_scene()), overview(spur_scene("wheel.twist_um=-4", "pinion.root_relief_um=6.5"))
    assert re.search(r"^  tip relief +C_αa +µm +0\.0 +0\.0$", plain, re.MULTILINE)
    assert "root relief" not in plain and "twist" not in plain
    assert re.search(r"^  root relief +C_αf +µm +6\.5 +0\.0$", text, re.MULTILINE)
    assert re.search(r"^  twist +S_α +µm +0\.0 +-4\.0$", text, re.MULTILINE)
    assert "profile crowning" not in text


@pytest.mark.parametrize("name", SCENES)
def test_report_columns_and_signs(name: str) -> None:
    """A skip's name ends before its sentence begins, and no zero has a sign, nor a backlash of rounded data: Yang's
    centre distance takes 0.04 µm, which is to be seen."""
    text = text_of(name)
    assert "deflected-flanks  A second search" in text
    assert not re.search(r"-0\.0*\s", text)
    backlash = re.search(r"normal backlash +j_bn +µm +(\S+)$", text, re.MULTILINE)
    assert backlash and backlash[1] == ("-0.04" if name == "yang2022" else "0.00")


@pytest.mark.parametrize("name", SCENES)
def test_report_symbols_are_unique(name: str) -> None:
    """No symbol stands for two quantities (b is the face width, b_H Hertz' half-width); a variant of the row above is
    indented."""
    rows = re.findall(r"^  (?! )(.{42})(\S+) {2,}", text_of(name), re.MULTILINE)
    symbols = {symbol: what.strip() for what, symbol in rows}
    assert len(rows) == len(symbols), sorted(symbol for _, symbol in rows)
    assert symbols["b"] == "face width" and symbols["b_H"] == "half-width at pitch point, mean length"
    assert "width 2b_H " in text_of(name)


def test_coarse_mesh_and_tetrahedra_are_warned_of() -> None:
    """Fewer than two elements across the contact, and tetrahedra, are warned of; a standard mesh is not."""
    assert "about 1.7 elements wide; below 2" in text_of("yang2022", "mesh.level=quick")
    assert "about 0.5 elements wide; below 2" in text_of("he2022", "mesh.elements_per_contact_width=0.5")
    assert "Tetrahedra are cut from" in text_of("he2022", "mesh.shape=tetrahedron")
    assert "elements wide" not in text_of("yang2022", "mesh.level=standard")
    assert "Warnings" not in text_of("first_pair", "mesh.level=standard")


FIGURES = {
    "yang2022": [
        ("reference diameter", "40.818 144.063"),
        ("base radius", "19.1994 67.7626"),
        ("transverse pressure angle", "19.8241"),
        ("without backlash, from x1 + x2", "20.7598"),
        ("transverse base pitch", "7.0961"),
        ("transverse contact ratio", "1.7740"),
        ("overlap ratio", "1.2419"),
        ("total contact ratio", "3.0159"),
        ("normal tooth thickness at the tip", "0.6934 1.3455"),  # printed 0.693/1.346
        ("diameter at start of active profile", "38.540 140.607"),
        ("base helix angle", "27.5402"),
        ("working pitch diameter", "41.065 144.935"),
        ("dedendum of the basic rack", "1.60 1.60"),
        ("addendum of the basic rack", "1.30 1.35"),
        ("normal force on the flanks", "14685.3"),
        ("contact line length, shortest", "31.18"),
        ("contact line length, mean", "33.81"),
        ("contact line length, longest", "34.65"),
        ("p0 at the pitch point, mean length", "1579.3"),
        ("p0 at the pitch point, shortest length", "1644.5"),
        ("p0 at the start of engagement, mean length", "3008.1"),
        ("total angle of transmission of the pinion", "63.866"),  # printed 63.9
    ],
    "he2022": [
        ("reference diameter", "150.000 150.000"),
        ("base radius", "70.4769 70.4769"),
        ("working transverse pressure angle", "20.0000"),
        ("transverse base pitch", "8.8564"),
        ("transverse contact ratio", "1.7547"),
        ("normal tooth thickness at the tip", "2.3263 2.3263"),  # printed 2.326
        ("diameter at start of active profile", "145.420 145.420"),
        ("normal force on the flanks", "2412.1"),
        ("half-width at pitch point, mean length", "0.0986"),
        ("shortest length", "0.1306"),  # one tooth: 2 F/(π b p0) with the pressure below
        ("p0 at the pitch point, shortest length", "587.7"),
    ],
    "zhang2023": [
        ("reference diameter", "75.900 105.800"),
        ("base radius", "36.0926 50.3109"),
        ("transverse pressure angle", "18.0000"),
        ("working transverse pressure angle", "19.2136"),
        ("transverse base pitch", "6.8720"),
        ("transverse contact ratio", "2.1413"),
        ("normal tooth thickness at the tip", "1.0808 1.2904"),  # printed 1.081/1.290
        ("diameter at start of active profile", "73.098 102.452"),
        ("addendum of the basic rack", "1.25 1.32"),
        ("dedendum of the basic rack", "1.57 1.50"),
        ("tip alteration coefficient", "-0.0093"),
    ],
}


@pytest.mark.parametrize("name", FIGURES)
def test_report_has_the_figures_of_the_papers(name: str) -> None:
    """Every figure of the three gear pairs to its last printed digit (exact recomputations from the printed data)."""
    text = re.sub(" +", " ", overview(load_scene(DEMOS / f"{name}.toml")))
    for label, values in FIGURES[name]:
        line = next((line for line in text.splitlines() if line.strip().startswith(label)), "")
        assert line.endswith(" " + values), f"{label}: wanted {values}, found {line!r}"


def test_tips_at_a_larger_centre_distance() -> None:
    """He's pair 0.3 mm apart: its tips are not made longer for that, so k is 0 and the addendum that of the scene."""
    text = re.sub(" +", " ", text_of("he2022", "pair.centre_distance_mm=150.3"))
    assert " tip alteration coefficient k 0.0000\n" in text
    assert " addendum of the basic rack h_aP* m_n 1.00 1.00\n" in text


def test_torque_on_the_wheel_gives_the_same_load() -> None:
    """60/17 times the torque on the wheel is, without friction, the same load."""
    on_wheel = scene_from_text(YANG, [f"load.torque_Nm={250 * 60 / 17}", "load.on=wheel"])
    assert " 14685.3" in overview(on_wheel)


def test_wear_depth_is_estimated() -> None:
    """He's pair: a million mesh cycles under half the load take 7.25 µm off the start of the active profile; with the
    load over the mean number of pairs, the contact ratio, 2/ε_α times as much."""
    scene = scene_from_text(HE, ["wear.cycles=1e6", "wear.pinion_mm2_per_N=1.3832e-10"])
    row = re.search(r"depth at the ends of the path of contact +h +µm +(\S+) +(\S+)", overview(scene))
    assert row is not None
    wanted = 7.25 * 2.0 / scene.gear_pair().transverse_contact_ratio
    assert float(row[1]) == pytest.approx(wanted, rel=2e-3) and float(row[2]) == 0.0


def test_webs_and_where_bores_are_held_are_told() -> None:
    """Of a webbed wheel rim, thickness, both faces and hub; beside a pinion that is held in part, a bore that a web
    reaches is held between the web's faces."""
    webbed = "wheel.rim_thickness_mm=4", "wheel.web_thickness_mm=3", "wheel.web_offset_mm=0.5"
    text = overview(helical_scene(*webbed, "wheel.hub_diameter_mm=52"))
    rows = ("rim, on a web", 4), ("web thickness", 3), ("from", -1), ("to", 2), ("hub diameter", 52)
    for name, wheel in rows:
        assert re.search(rf"^ +{name}.* – +{wheel}\.000$", text, re.MULTILINE)
    held = overview(helical_scene(*webbed, "pinion.support_width_mm=4"))
    assert re.search(r"bore held from +z +mm +-2\.000 +-1\.000\n +to +mm +2\.000 +2\.000", held)
    assert "on a web" not in overview(helical_scene())


def test_driving_wheel_is_reported() -> None:
    """The gear that drives, the sense of rotation and the flanks that bear; nothing of it where the pinion drives. The
    engagement starts where it ended."""
    plain, reverse = (text_of("yang2022", *settings) for settings in ((), ("load.driving=wheel",)))
    start, end = (r"^  p0 at the start of engagement.* (\S+)$", r"^  p0 at the end of engagement.* (\S+)$")
    (first, last), other = ([re.findall(place, text, re.M) for place in (start, end)] for text in (plain, reverse))
    assert first != last and other == [last, first]
    text = overview(spur_scene("load.driving=wheel"))
    assert re.search(r"^  driving gear +wheel, the pinion turns clockwise seen from z > 0$", text, re.MULTILINE)
    assert re.search(r"^  flanks that bear, on both gears +left ones seen from z > 0", text, re.MULTILINE)
    assert "driving gear" not in overview(spur_scene())
