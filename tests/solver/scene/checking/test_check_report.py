"""What `evolvent check` prints: charts, columns, signs, warnings, and no paper where none was asked for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from evolvent.scene.checking.check_report import overview
from evolvent.scene.scene import load_scene
from tests.support.gear_cases import ROOT, spur_scene

SCENES = ("yang2022", "he2022", "zhang2023")
STUDY = ("Yang", "Eq. 4", "K = ")


def text_of(name: str, *settings: str) -> str:
    return overview(load_scene(ROOT / f"demos/{name}.toml", settings))


def test_charts_are_said(tmp_path: Path) -> None:
    """Problem: a wheel whose chart lacks 7.5 µm at most, a pinion as designed. Exact: the file's name and 7.5; scenes
    without charts have no such rows."""
    path = tmp_path / "worn_after_a_million.csv"
    path.write_text("diameter_mm,depth_um\n120,2.0\n150,7.5\n170,1.0\n", encoding="utf-8")
    text = overview(spur_scene(f"wheel.flank_csv={path}"))
    assert re.search(r"chart of the flank +none worn_after_a_million\.csv$", text, re.MULTILINE)
    assert re.search(r"missing at most, beside C_a and C_b +µm +– +7\.5$", text, re.MULTILINE)
    assert "chart" not in overview(spur_scene())


@pytest.mark.parametrize("name", SCENES)
def test_columns_and_signs(name: str) -> None:
    """A skip's name ends before its sentence begins, and no zero has a sign, nor a backlash of rounded data: Yang's
    centre distance takes 0.04 µm, which is to be seen."""
    text = text_of(name)
    assert "deflected-flanks  A second search" in text
    assert not re.search(r"-0\.0*\s", text)
    backlash = re.search(r"normal backlash +j_bn +µm +(\S+)$", text, re.MULTILINE)
    assert backlash and backlash[1] == ("-0.04" if name == "yang2022" else "0.00")


def test_the_study_stands_where_it_is_asked_for() -> None:
    """Yang's Eq. 4 and K factors: with output.compare, and nowhere else."""
    compared = 'output.compare="yang2022"'
    assert all(word in text_of("yang2022") for word in STUDY)
    assert "Eq. 4 of Yang 2022" in text_of("he2022", compared)
    for name in ("he2022", "zhang2023"):
        assert not any(word in text_of(name) for word in STUDY)


@pytest.mark.parametrize("name", SCENES)
def test_a_symbol_is_one_thing(name: str) -> None:
    """No symbol stands for two quantities (b is the face width, b_H Hertz' half-width); a variant of the row above is
    indented."""
    rows = re.findall(r"^  (?! )(.{42})(\S+) {2,}", text_of(name), re.MULTILINE)
    symbols = {symbol: what.strip() for what, symbol in rows}
    assert len(rows) == len(symbols), sorted(symbol for _, symbol in rows)
    assert symbols["b"] == "face width" and symbols["b_H"] == "Hertz half-width at the pitch point"
    assert "width 2b_H " in text_of(name)


def test_warnings_come_with_the_estimate() -> None:
    """Fewer than two elements across the contact, and tetrahedra, are warned of; a standard mesh is not."""
    assert "about 1.7 elements wide; below 2" in text_of("yang2022", "mesh.level=quick")
    assert "about 0.5 elements wide; below 2" in text_of("he2022", "mesh.elements_per_contact_width=0.5")
    assert "Tetrahedra are cut from" in text_of("he2022", "mesh.shape=tetrahedron")
    assert "Warnings" not in text_of("yang2022", "mesh.level=standard")
