"""Contact fatigue from Python: closed forms below a line contact, figures of `evolvent fatigue`, refusals, files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from evolvent.fatigue import (
    FatigueSettings,
    PitchFatigue,
    contact_fatigue,
    dang_van,
    largest_shear,
    orthogonal_shear_range,
    passing_stress,
    pitch_fatigue,
    von_mises,
)
from evolvent.gears import condense, solve_pitches
from evolvent.gears.gear_model import GearModel
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene
from evolvent.scene.schema.fatigue import FatigueSection
from evolvent.strength.fatigue.flank_fatigue import passage
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from tests.support.checkout import ROOT
from tests.support.gear_cases import QUIET
from tests.support.recorded_tables import assert_same_rows, columns_of, tables_of

SCENE = ROOT / "demos/he2022.toml"
DEPTHS = (0.0, 0.02, 0.05, 0.1, 0.3, 0.786, 1.2)
SETTINGS = (
    *QUIET, "mesh.level=quick", "mesh.order=1", "sweep.positions=6", "contact.friction=[0.1,0.05]",
    "fatigue.yield_stress_MPa=1600", f"fatigue.depths={list(DEPTHS)}",
)
OWN = FatigueSettings(DEPTHS, yield_stress=1600.0)
PEAK, HALF = 1000.0, 0.2


@pytest.fixture(scope="module")
def gears() -> GearModel:
    """He's pair, first-order cells."""
    return condense(gear_problem(load_scene(SCENE, SETTINGS)))


@pytest.fixture(scope="module")
def flanks(gears: GearModel) -> PitchFatigue:
    """Six positions at two friction coefficients."""
    return pitch_fatigue(gears, solve_pitches(gears, [0.1, 0.05], positions=6), OWN)


def test_line_contact_without_friction() -> None:
    """Hertz' line contact. Exact (Johnson 1985, 4.2): the range of orthogonal shear is p0/2 half a half-width deep, the
    largest shear 0.300 p0 at 0.786 half-widths, to its three digits; no tension; depths in mm."""
    below = contact_fatigue(PEAK, HALF, settings=FatigueSettings((0.0, 0.5, 0.786)))
    np.testing.assert_allclose(below.depths, HALF * np.array([0.0, 0.5, 0.786]), rtol=1e-12)
    assert below.values["orthogonal_shear_range"][1] == pytest.approx(0.5 * PEAK, rel=1e-4)
    assert below.values["maximum_shear"][2] == pytest.approx(0.300 * PEAK, rel=2e-3)
    assert below.values["contact_pressure"][0] == PEAK and below.values["tension"].max() < 1e-9 * PEAK
    assert "fatemi_socie" not in below.values


def test_tension_behind_a_sliding_contact() -> None:
    """Exact: 2μp0 at the trailing edge of the surface (Johnson 1985, 7.1)."""
    below = contact_fatigue(PEAK, HALF, friction=0.1, settings=FatigueSettings((0.0,)))
    assert below.values["tension"][0] == pytest.approx(0.2 * PEAK, rel=1e-5)


def test_criteria_of_a_history_are_those_below_the_contact() -> None:
    """The history at the instants of a passage has the criteria that `contact_fatigue` has at its depth, to 1e-12."""
    settings = FatigueSettings((0.3,))
    history = passing_stress(HALF * passage(), 0.3 * HALF, PEAK, HALF, friction=0.1)
    below = contact_fatigue(PEAK, HALF, 0.1, settings=settings).values
    exact = {
        "von_mises": von_mises(history).max(), "maximum_shear": largest_shear(history).max(),
        "orthogonal_shear_range": orthogonal_shear_range(history),
        "dang_van": dang_van(history, settings.tension_factor, settings.compression_factor),
    }
    for name, value in exact.items():
        assert below[name][0] == pytest.approx(value, rel=1e-9), name


def test_figures_are_those_of_the_command(flanks: PitchFatigue, tmp_path: Path) -> None:
    """Problem: He's pair, six positions, two friction coefficients, once by `evolvent fatigue` and once by functions.
    Exact: all rows of fatigue.csv, fatigue_map.csv and fatigue.json, to 1e-9."""
    known = tables_of("fatigue", SCENE, tmp_path / "out", *SETTINGS)
    assert_same_rows(flanks.largest, known["fatigue.csv"])
    assert_same_rows(flanks.over_flank, known["fatigue_map.csv"])
    assert_same_rows(list(flanks.facts), known["fatigue.json"])


def test_settings_are_by_default_those_of_a_scene() -> None:
    """Each field is the default of a key of [fatigue]."""
    section, own = FatigueSection(), FatigueSettings()
    assert (own.depths, own.yield_stress) == (section.depths, section.yield_stress_MPa)
    assert (own.tension_factor, own.compression_factor, own.normal_factor) == (
        section.tension_factor, section.compression_factor, section.normal_factor,
    )


def test_flank_fatigue_is_saved_and_drawn(flanks: PitchFatigue, tmp_path: Path) -> None:
    """The saved column is the one of the rows; the picture is a PNG image."""
    path = flanks.save(tmp_path / "flanks.csv")
    table = columns_of(path)
    np.testing.assert_allclose(table["at_surface"], [row.at_surface for row in flanks.over_flank], rtol=1e-8)
    with Image.open(flanks.plot(tmp_path / "flanks.png")) as image:
        assert image.format == "PNG" and image.width > 1000


@pytest.mark.parametrize(("wrong", "words"), [
    ({"peak_pressure": 0.0}, "peak_pressure: wanted a number above 0, in MPa"),
    ({"half_width": -0.1}, "half_width: wanted a number above 0, in mm"),
    ({"friction": 1.5}, "friction: wanted a number from 0 to 1"),
])
def test_a_contact_that_cannot_be_is_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy, for criteria and for stress."""
    right: dict[str, Any] = {"peak_pressure": PEAK, "half_width": HALF, "friction": 0.1} | wrong
    with pytest.raises(InputError, match=words):
        contact_fatigue(**right)
    with pytest.raises(InputError, match=words):
        passing_stress([0.0], 0.1, **right)


@pytest.mark.parametrize(("wrong", "words"), [
    ({"depths": (0.1, 0.0)}, "depths: wanted ascending numbers"), ({"depths": ()}, "depths: wanted ascending numbers"),
    ({"depths": (-0.1,)}, "depths: wanted numbers from 0 on"), ({"yield_stress": 0.0}, "yield_stress: wanted a number"),
    ({"tension_factor": -1.0}, "tension_factor: wanted a number from 0 on"),
])
def test_settings_that_cannot_be_are_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy."""
    with pytest.raises(InputError, match=words):
        FatigueSettings(**wrong)


def test_pitches_that_cannot_be_are_refused(gears: GearModel) -> None:
    """InputError for no pitch, for a friction coefficient in place of one, for a depth above the surface."""
    for wrong, words in (([], "pitches: wanted"), ([0.1], "pitches: wanted a tuple of PitchSolution")):
        with pytest.raises(InputError, match=words):
            pitch_fatigue(gears, wrong)  # type: ignore[arg-type]  # refused
    with pytest.raises(InputError, match="settings: wanted a FatigueSettings"):
        pitch_fatigue(gears, [], None)  # type: ignore[arg-type]  # refused
    for places in (None, 0.0, ["x"], [np.nan], [[0.1], [0.1, 0.2]]):
        with pytest.raises(InputError, match="places: wanted finite numbers, in mm"):
            passing_stress(places, 0.1, PEAK, HALF)  # type: ignore[arg-type]  # refused
    with pytest.raises(InputError, match=r"poissons_ratio: wanted a number from 0 to 0\.5"):
        passing_stress([0.0], 0.1, PEAK, HALF, poissons_ratio=0.7)
    with pytest.raises(InputError, match="depth: wanted a number from 0 on"):
        passing_stress([0.0], -0.1, PEAK, HALF)


def test_pitches_of_other_gears_are_refused(gears: GearModel) -> None:
    """Gears under another torque, that the wheel drives, another pair: none has these pitches. Right: refused with both
    torques, with the gear that drives."""
    pitches = solve_pitches(gears, [0.1], positions=2)
    heavier = replace(gears, load=replace(gears.load, torque=2.0 * gears.load.torque))
    with pytest.raises(InputError, match="found a pitch under 170 N·m on the pinion beside gears under 340 N·m on the"):
        pitch_fatigue(heavier, pitches)
    driven = replace(gears, load=replace(gears.load, driving=Member.WHEEL))
    with pytest.raises(InputError, match="found a pitch that the pinion drives"):
        pitch_fatigue(driven, pitches)
    with pytest.raises(InputError, match="found a pitch of another gear pair"):
        pitch_fatigue(replace(gears, pair=replace(gears.pair, centre_distance=150.05)), pitches)


@pytest.mark.parametrize(("wrong", "words"), [
    ({"settings": None}, "settings: wanted a FatigueSettings"), ({"material": OWN}, "material: wanted a Material"),
])
def test_settings_in_another_place_are_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy."""
    with pytest.raises(InputError, match=words):
        contact_fatigue(PEAK, HALF, **wrong)
