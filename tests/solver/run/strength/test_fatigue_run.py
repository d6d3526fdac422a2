"""`evolvent fatigue` on Zhang's pair in plane strain: its tables, picture, refusals and ranks."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from evolvent.run.kinds.fatigue import Fatigue
from evolvent.run.kinds.run import Run
from evolvent.scene.scene import Scene, SceneError, load_scene
from evolvent.scene.schema.fatigue import NEEDED, FatigueSection
from evolvent.strength.fatigue.criterion import SHALLOW
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly

SETTINGS = (
    "pinion.face_width_mm=25", "mesh.level=quick", "sweep.positions=8", "output.animation=false",
    "contact.friction=[0.132,0.107]", "fatigue.yield_stress_MPa=1600",
    "fatigue.depths=[0,0.02,0.05,0.1,0.3,0.5,0.8,1.2]",
)


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/zhang2023.toml", [*SETTINGS, *settings])


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With error bars; a contact that is less than two elements wide is said."""
    folder = tmp_path_factory.mktemp("fatigue")
    tips, edges, few, apart = quietly(Fatigue.of(scene()), folder)
    assert tips.startswith("No tip relief") and "within the tip-edge zones has no figures" in edges
    assert "elements across the contact (median): below 2" in few and "sweep.positions" in apart
    return folder


def largest(out: Path, gear: str, criterion: str, place: str, friction: float) -> dict[str, str]:
    (row,) = [
        row
        for row in rows(out / "fatigue.csv")
        if (row["gear"], row["criterion"], row["place"], float(row["friction"])) == (gear, criterion, place, friction)
    ]
    return row


def test_folder(out: Path) -> None:
    """The scene with its defaults, tables and a picture."""
    assert load_scene(out / "scene.toml") == scene()
    assert (out / "pictures/fatigue.png").stat().st_size > 20_000


def test_what_a_line_contact_has(out: Path) -> None:
    """At each coefficient, of the largest contact pressure p0: range of orthogonal shear p0/2 at b/2; largest shear
    0.300 p0 or, with friction, up to 4 % more; at the surface tension 2μp0 and shear μp0."""
    for friction in (0.132, 0.107):
        p0 = float(largest(out, "pinion", "contact_pressure", "surface", friction)["value"])
        value = {
            (name, place): float(largest(out, "pinion", name, place, friction)["value"])
            for name, place in (
                ("orthogonal_shear_range", "below"), ("maximum_shear", "below"), ("tension", "surface"),
                ("orthogonal_shear_range", "surface"),
            )
        }
        assert value["orthogonal_shear_range", "below"] == pytest.approx(0.5 * p0, rel=1e-3)
        assert 0.295 * p0 < value["maximum_shear", "below"] < 0.3003 * 1.04 * p0
        assert value["tension", "surface"] == pytest.approx(2.0 * friction * p0, rel=1e-3)
        assert value["orthogonal_shear_range", "surface"] == pytest.approx(friction * p0, rel=1e-3)


def test_largest_pressure_is_that_of_a_run(out: Path, tmp_path: Path) -> None:
    """`evolvent run` of the same scene: the largest contact pressure is larger by what it interpolates to the limits
    of the tip-edge zones, 3 % at most, and its error bar is the same share of it."""
    quietly(Run.of(scene("output.pictures=false")), tmp_path)
    reports = json.loads((tmp_path / "summary.json").read_text())["frictions"]
    for report in reports:
        row = largest(out, "pinion", "contact_pressure", "surface", report["friction"])
        assert 0.97 * report["max_pressure_MPa"] <= float(row["value"]) <= 1.0001 * report["max_pressure_MPa"]
        bar = report["estimated_error"]["max_pressure_MPa"]
        assert float(row["value_error"]) == pytest.approx(bar, rel=1e-6)


def test_life_ratios_follow_the_changes(out: Path) -> None:
    """Each is (1 + change)^−m at the point that is compared, with contact pressure's own exponent of 13.22 too."""
    lives = rows(out / "fatigue_life.csv")
    assert {float(row["friction"]) for row in lives} == {0.107}
    for row in lives:
        if row["place"] == "surface" and row["criterion"] in ("orthogonal_shear_range", "tension"):
            assert row["life_ratio"] == "nan"
            continue
        whole = largest(out, row["gear"], row["criterion"], row["place"], 0.107)
        ratio = 1.0 + float(whole["change_percent"]) / 100.0
        assert float(row["life_ratio"]) == pytest.approx(ratio ** -float(row["exponent"]), rel=1e-6)
    assert 13.22 in {float(row["exponent"]) for row in lives if row["criterion"] == "contact_pressure"}


def test_less_friction_lowers_the_surface_and_hardly_what_lies_below(out: Path) -> None:
    """From 0.132 to 0.107: orthogonal shear at the surface falls by 19 % (0.107/0.132 and what pressure changes, 1 % at
    most), below it changes by 1 % at most."""
    changes = {
        place: float(largest(out, "wheel", "orthogonal_shear_range", place, 0.107)["change_percent"])
        for place in ("surface", "below")
    }
    assert changes["surface"] == pytest.approx(100.0 * (0.107 / 0.132 - 1.0), abs=1.0)
    assert abs(changes["below"]) < 1.0


def test_facts(out: Path) -> None:
    """Points of both coefficients, none on a tip edge; two elements across the contact: pressures as solved differ."""
    facts = json.loads((out / "fatigue.json").read_text())
    assert [fact["friction"] for fact in facts] == [0.132, 0.107]
    flank = rows(out / "fatigue_map.csv")
    for fact in facts:
        own = [row for row in flank if float(row["friction"]) == fact["friction"] and row["gear"] == "wheel"]
        assert fact["points"] == len({row["roll_distance_mm"] for row in own}) > 8
        assert 0.0 <= fact["left_out_percent"] < 50.0
        assert fact["fitted_shear_most_percent"] > 0.0
        pinion = [row for row in flank if (row["gear"], row["criterion"]) == ("pinion", "dang_van")]
        same = [row for row in pinion if float(row["friction"]) == fact["friction"]]
        flagged = sum(row["near_friction_reversal"] == "True" for row in same)
        assert flagged > 0
        assert fact["near_reversal_percent"] == pytest.approx(100.0 * flagged / len(same))


def test_one_coefficient_has_no_lives_to_compare(tmp_path: Path) -> None:
    """All tables but that of lives."""
    alone = scene("contact.friction=0.1", "output.error_bars=false", "output.pictures=false")
    assert len(quietly(Fatigue.of(alone), tmp_path)) == 4
    assert sorted(path.name for path in tmp_path.glob("fatigue*.csv")) == [
        "fatigue.csv", "fatigue_depth.csv", "fatigue_map.csv", "fatigue_section.csv"]


@pytest.mark.parametrize(
    "setting",
    ["fatigue.depths=[0.1,0.5]", "fatigue.exponents=[5,5]", "fatigue.yield_stress_MPa=-1"],
)
def test_sections_that_are_refused(setting: str) -> None:
    """Two depths; exponents twice; no yield stress."""
    with pytest.raises(SceneError, match=setting.split("=")[0]):
        scene(setting)


@pytest.mark.parametrize(
    ("depths", "remedy"),
    [("0.01,0.02,0.05,0.1,1", "add 0, at which"), ("0,0.2,0.5,0.8,1", "add 0.02, 0.05, 0.1, at which"),
     ("0,0.02,0.05,0.1,0.5", "go down to 1 or deeper"), ("0,0.02,0.1,0.05,1", "let them ascend")],
)
def test_depths_that_tables_lack_are_named(depths: str, remedy: str) -> None:
    """A list without the depths of fatigue.csv, too shallow, or not ascending: the remedy says what to write."""
    with pytest.raises(SceneError) as refused:
        scene(f"fatigue.depths=[{depths}]")
    assert remedy in str(refused.value)


def test_depths_of_the_section_are_those_of_the_tables() -> None:
    """What a scene must have is what tables read; the default has it."""
    assert (0.0, *SHALLOW.values()) == NEEDED and set(NEEDED) < set(FatigueSection().depths)


def test_friction_reverses_at_the_pitch_point(out: Path) -> None:
    """Zhang's pair, 20° of pressure angle: a point lies ρ(0)/r_b = 0.36 of its roll distance from the pitch line, and
    is flagged up to two half-widths of 0.15 mm, 0.8 mm of roll distance; contact pressure in no line of fatigue.csv."""
    flank = [row for row in rows(out / "fatigue_map.csv") if row["criterion"] == "dang_van"]
    for row in flank:
        ξ, half = abs(float(row["roll_distance_mm"])), float(row["half_width_mm"])
        if abs(ξ - 2.0 * half / 0.36) > 0.2:
            slides = float(row["traction_coefficient"]) > 0.99 * float(row["friction"])
            assert (row["near_friction_reversal"] == "True") == (ξ < 2.0 * half / 0.36 or not slides)
    assert {row["near_friction_reversal"] for row in flank} == {"True", "False"}
    pressures = (row for row in rows(out / "fatigue.csv") if row["criterion"] == "contact_pressure")
    assert {row["near_friction_reversal"] for row in pressures} == {"False"}
