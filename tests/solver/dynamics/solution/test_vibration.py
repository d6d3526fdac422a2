"""Excitation and vibration of a pair from Python: the figures of `evolvent dynamics`, refusals, files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from evolvent.dynamics import (
    Accuracy,
    DriveSettings,
    GearExcitation,
    geometric_backlash,
    mesh_excitation,
    natural_speed,
    polar_moment,
    vibration,
    with_elastic_bodies,
)
from evolvent.dynamics.of_scene import drive_settings
from evolvent.dynamics.results.tables import excitation_rows
from evolvent.gears import STEEL, FlankChart, condense
from evolvent.gears.gear_model import GearModel
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.inertias import moments_of_inertia
from evolvent.scene.scene import load_scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.errors import InputError
from tests.support.checkout import ROOT
from tests.support.gear_cases import QUIET
from tests.support.recorded_tables import assert_same_rows, columns_of, tables_of
from tests.support.running.hub_and_rim import settings

SCENE = ROOT / "demos/he2022_dynamics.toml"
SETTINGS = (
    *QUIET, "mesh.level=quick", "mesh.order=1", "sweep.positions=6", "dynamics.torque_percents=[40,100]",
    "dynamics.speed_rpm=[1500,6500]", "dynamics.speeds=8", "dynamics.base_pitch_deviation_um=5",
    "dynamics.profile_deviation_um=4", "dynamics.damping_ratio=0.15",
)
TORQUE, SPEEDS = 170e3, np.linspace(1500.0, 6500.0, 8)
ONE = load_scene(SCENE, SETTINGS)
PROBLEM = gear_problem(ONE)
RIGID = DriveSettings((7.65, 7.65), 0.15, 0.05)


@pytest.fixture(scope="module")
def gears() -> GearModel:
    """He's pair, condensed for the torque of its scene."""
    return condense(PROBLEM)


@pytest.fixture(scope="module")
def excitation(gears: GearModel) -> GearExcitation:
    """Six positions under 40 % and all of the torque."""
    return mesh_excitation(gears, [0.4 * TORQUE, TORQUE], 6)


def test_figures_are_those_of_the_command(excitation: GearExcitation, tmp_path: Path) -> None:
    """Problem: He's pair on elastic bodies, six positions, two torques, eight speeds, once by `evolvent dynamics` and
    once by functions; damped so that no branch folds, where rounding says whether a point is stable. Exact: all rows of
    excitation.csv, response.csv and branch.csv, to 1e-9."""
    known = tables_of("dynamics", SCENE, tmp_path / "out", *SETTINGS)
    assert_same_rows(excitation_rows(excitation.mesh, cases=("40 %", "100 %")), known["excitation.csv"])
    section = ONE.dynamics
    assert section is not None
    settings = with_elastic_bodies(drive_settings(PROBLEM.pair, section), PROBLEM, section.density)
    found = vibration(excitation, TORQUE, SPEEDS, settings, Accuracy(5.0, 4.0))
    assert_same_rows(list(found.rows), known["response.csv"])
    assert_same_rows(list(found.branch), known["branch.csv"])
    assert not found.facts.folds_rpm and found.facts.bodies == "elastic"
    assert np.isfinite(found.curve("dynamic_factor_iso")).all()


def test_curves_of_an_excitation(excitation: GearExcitation) -> None:
    """Exact: shapes (positions, torques), the torques that were given, secant stiffness times deflection is the force,
    and no unloaded error on involute flanks without relief, to 1 nm."""
    assert excitation.transmission_error.shape == excitation.tangent_stiffness.shape == (6, 2)
    np.testing.assert_allclose(excitation.torques, [0.4 * TORQUE, TORQUE], rtol=1e-12)
    deflection = excitation.transmission_error - excitation.unloaded_error[:, None]
    force = excitation.torques / PROBLEM.pair.pinion.base_radius
    np.testing.assert_allclose(excitation.secant_stiffness * deflection, np.tile(force, (6, 1)), rtol=1e-12)
    assert np.abs(excitation.unloaded_error).max() < 1e-6


def test_speeds_and_columns(excitation: GearExcitation) -> None:
    """Curves are columns of the rows of one way; the natural speed is the one that the settings alone have."""
    found = vibration(excitation, TORQUE, SPEEDS, RIGID)
    np.testing.assert_allclose(found.speeds, SPEEDS, rtol=1e-12)
    assert found.curve("dynamic_factor", "down").tolist() == [row.dynamic_factor for row in found.rows[8:]]
    assert found.natural_speed == natural_speed(excitation, TORQUE, RIGID) == found.facts.natural_speed_rpm
    assert np.isnan(found.curve("dynamic_factor_iso")).all()
    with pytest.raises(InputError, match="column: wanted one of speed_rpm"):
        found.curve("amplitude")
    with pytest.raises(InputError, match='way: wanted running "up" or "down"'):
        found.curve("dynamic_factor", "across")


def test_results_save_and_draw_themselves(excitation: GearExcitation, tmp_path: Path) -> None:
    """Columns of a saved file are the curves, to nine digits; pictures are PNG images; other endings are refused."""
    table = columns_of(excitation.save(tmp_path / "excitation.csv"))
    np.testing.assert_allclose(
        table["transmission_error_um"].reshape(2, 6).T, 1e3 * excitation.transmission_error, rtol=1e-8
    )
    found = vibration(excitation, TORQUE, SPEEDS, RIGID)
    table = columns_of(found.save(str(tmp_path / "response.csv")))
    np.testing.assert_allclose(table["largest_force_N"][:8], found.curve("largest_force_N"), rtol=1e-8)
    for result, name in ((excitation, "excitation.png"), (found, "vibration.png")):
        with Image.open(result.plot(tmp_path / name)) as image:
            assert image.format == "PNG" and image.width > 1000
        with pytest.raises(InputError, match=r"path: wanted the name of a file that ends in \.png"):
            result.plot(tmp_path / "picture.pdf")
    for path in (None, "", "."):
        with pytest.raises(InputError, match=r'path: wanted the name of a file .*; write "name\.csv"'):
            found.save(path)  # type: ignore[arg-type]  # refused
    with pytest.raises(InputError, match="accuracy: wanted an Accuracy"):
        vibration(excitation, TORQUE, SPEEDS, RIGID, (5, 6))  # type: ignore[arg-type]  # refused
    with pytest.raises(InputError, match=r"ends in \.csv, found .*; write .*table\.csv"):
        found.save(tmp_path / "table.npz")


@pytest.mark.parametrize(("wrong", "words"), [
    ({"torques": [170e3, 85e3]}, "torques: wanted one or several, ascending"),
    ({"torques": []}, "torques: wanted one or several"),
    ({"torques": [0.0, 85e3]}, "torques: wanted numbers above 0, in N·mm"),
    ({"torques": 170e3}, "torques: wanted a sequence"),
    ({"positions": 2}, "positions: wanted a whole number from 3 on"),
    ({"flanks": (FlankChart(np.linspace(140.0, 156.0, 9), np.zeros(1), np.zeros((9, 1))), None)},
     "flanks: wanted the charts that the gears were condensed with, found pinion: one for a gear as designed"),
    ({"flanks": None}, "flanks: wanted two of FlankChart or None"),
    ({"flanks": (None,)}, "flanks: wanted two of FlankChart or None"),
])
def test_an_excitation_that_cannot_be_is_refused(gears: GearModel, wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy."""
    with pytest.raises(InputError, match=words):
        mesh_excitation(gears, **{"torques": [TORQUE], "positions": 6, **wrong})


@pytest.mark.parametrize(("wrong", "words"), [
    ({"torque": 1.01 * TORQUE}, "torque: wanted a number above 0 up to the heaviest of the excitation"),
    ({"torque": 0.0}, "found 0.0; for a heavier one give mesh_excitation a heavier torque"),
    ({"settings": replace(RIGID, inertias=(7.65, 7.65e-3))}, "inertias: wanted of the wheel at least .*kg·m²"),
    ({"settings": replace(RIGID, backlash=50.0)}, "backlash: wanted a number from 0 to the module, 3 mm"),
    ({"settings": replace(RIGID, series_stiffness=720.0)}, "series_stiffness: wanted at least .* N/mm"),
    ({"settings": 0.05}, "settings: wanted"),
    ({"excitation": 0.05}, "excitation: wanted"),
])
def test_a_vibration_that_cannot_be_is_refused(
    excitation: GearExcitation, wrong: dict[str, Any], words: str
) -> None:
    """InputError names argument, value and remedy."""
    right: dict[str, Any] = {"excitation": excitation, "torque": TORQUE, "speeds": SPEEDS, "settings": RIGID}
    with pytest.raises(InputError, match=words):
        vibration(**(right | wrong))
    with pytest.raises(InputError, match=words):
        natural_speed(*((right | wrong)[each] for each in ("excitation", "torque", "settings")))


@pytest.mark.parametrize("speeds", [[3000.0], [3000.0, 2000.0], [0.0, 2000.0]])
def test_speeds_that_cannot_be_are_refused(excitation: GearExcitation, speeds: list[float]) -> None:
    """InputError names argument, value and remedy."""
    words = "two or more, ascending" if min(speeds) else "numbers above 0, in r/min"
    with pytest.raises(InputError, match=f"speeds: wanted {words}"):
        vibration(excitation, TORQUE, speeds, RIGID)


@pytest.mark.parametrize(("wrong", "words"), [
    ({"inertias": (0.0, 7.65)}, "inertias: wanted two numbers above 0"), ({"inertias": 7.65}, "inertias: wanted two"),
    ({"inertias": (7.65,)}, "inertias: wanted two"), ({"inertias": None}, "inertias: wanted two"),
    ({"damping_ratio": 0.0}, "damping_ratio: wanted a number from 0.001 to 1"),
    ({"damping_ratio": 5.0}, "damping_ratio: wanted a number from 0.001 to 1"),
    ({"ground_damping_ratio": 5.0}, "ground_damping_ratio: wanted a number from 0 to 1"),
    ({"damping_in_separation": "yes"}, "damping_in_separation: wanted a bool"),
    ({"backlash": -0.1}, "backlash: wanted a number from 0 on, in mm"),
    ({"series_stiffness": 0.0}, "series_stiffness: wanted a number above 0"),
    ({"series_stiffness": None}, "series_stiffness: wanted a number above 0"),
    ({"mesh": "tangnt"}, "mesh: wanted 'force_surface' or 'tangent' or 'secant', found 'tangnt'"),
    ({"bodies": "elastic"}, "bodies: wanted None or the shapes.*with_elastic_bodies"),
])
def test_settings_that_cannot_be_are_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names field, value and remedy."""
    with pytest.raises(InputError, match=words):
        replace(RIGID, **wrong)


def test_inertia_taken_from_elastic_bodies_is_refused() -> None:
    """Half of the inertia that the bodies have, given once their shapes are known: the mass matrix would be indefinite.
    Right: refused; with a pair in place of a gear, likewise."""
    elastic = settings()
    with pytest.raises(InputError, match="inertias: wanted of the wheel at least that of its elastic body"):
        replace(elastic, inertias=(elastic.inertias[0], 0.5 * elastic.inertias[1]))
    for wrong in (lambda: polar_moment(PROBLEM.pair, STEEL.density),  # type: ignore[arg-type]  # refused
                  lambda: geometric_backlash(PROBLEM.pair.pinion)):  # type: ignore[arg-type]  # refused
        with pytest.raises(InputError, match=r"(gear|pair): wanted a Gear"):
            wrong()


@pytest.mark.parametrize("density", [7850.0, 7.85, 0.0])
def test_a_density_in_another_unit_is_refused(density: float) -> None:
    """Densities are in t/mm³, as those of a Material; steel from Python has the inertia of a scene's, to 1e-12."""
    for refused in (lambda: polar_moment(PROBLEM.pair.pinion, density),
                    lambda: with_elastic_bodies(RIGID, PROBLEM, density)):
        with pytest.raises(InputError, match=r"density: wanted .* in t/mm³.*7\.85e-9"):
            refused()
    exact = moments_of_inertia(PROBLEM.pair, DynamicsSection())[0]
    assert polar_moment(PROBLEM.pair.pinion, STEEL.density) == pytest.approx(exact, rel=1e-12)


def test_charted_gears_want_their_charts() -> None:
    """A hollow of 5 µm on the pinion's flank: refused without `flanks`; with them the unloaded error is the hollow's
    depth where the flanks touch, between 0 and 5 µm."""
    diameters = np.linspace(140.0, 156.0, 33)
    hollow = FlankChart(diameters, np.zeros(1), 5e-3 * np.sin(np.pi * (diameters - 140.0) / 16.0)[:, None])
    charted = condense(replace(PROBLEM, flanks=(hollow, None)))
    with pytest.raises(InputError, match=r"pinion: none for a gear that has one; write flanks=problem\.flanks"):
        mesh_excitation(charted, [TORQUE], 3)
    found = mesh_excitation(charted, [TORQUE], 3, flanks=(hollow, None))
    assert 1e-3 < found.unloaded_error.min() <= found.unloaded_error.max() < 5e-3
