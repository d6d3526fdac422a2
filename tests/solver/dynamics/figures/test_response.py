"""What the picture of the vibration shows of its error, of a linear mesh."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.figures.response import BODIES, DOUBTED, ISO, response_figure
from evolvent.dynamics.oscillator.mesh_speed import speeds_to_periods
from evolvent.dynamics.oscillator.speed_sweep import sweep_speeds
from evolvent.dynamics.pair_model import DriveSettings, drive
from evolvent.dynamics.results.response import branch_rows, largest_force, response_rows, responses, summary
from evolvent.dynamics.results.response_errors import Vibration, VibrationErrors, vibration_errors
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent.results.drawing.style import PINION, WHEEL
from evolvent.scene.gear_problem import gear_problem
from tests.support.gear_cases import spur_scene

LOAD, SPEEDS = 1000.0, np.linspace(3000.0, 6000.0, 5)
DEVIATING = Accuracy(5.0, 5.0)
SETTINGS = DriveSettings((7.65, 7.65), 0.1, 0.05, mesh="tangent")
BARS = np.array([1e-4, 2e-4, 3e-4, 2e-4, 1e-4])
"""Of the amplitude [mm]."""


def drawn(known: bool, accuracy: Accuracy = DEVIATING, near: float = np.inf, **changed: Any) -> Figure:
    """Running through five speeds, with an error or without, on gears of an accuracy. near: speed from which on rows
    are near the bodies' vibration. changed: keys of dynamics.json."""
    pair, forces = gear_problem(spur_scene()).pair, np.array([LOAD, 2.0 * LOAD])
    error, stiffness = 2e-4 * np.cos(2.0 * np.pi * np.arange(8) / 8), np.full((8, 2), 3e5)
    angles = 2.0 * np.pi / 50.0 * np.arange(8) / 8
    mesh = MeshExcitation(error, LoadedMesh(angles, forces, 1.0, error[:, None] + forces / stiffness, stiffness))
    vibrating = drive(pair, mesh, LOAD, SETTINGS)
    swept = sweep_speeds(vibrating.model, speeds_to_periods(SPEEDS, 50))
    found = responses(vibrating, swept)
    errors: VibrationErrors = vibration_errors(Vibration(vibrating, found, {"up": (), "down": ()}), [], np.nan)
    if known:
        both = {"up": BARS, "down": 9.0 * BARS}
        errors = replace(errors, amplitude=both, dynamic_factor={way: 1e3 * bars for way, bars in both.items()})
    iso = method_b(pair, vibrating.model.mass, LOAD, accuracy, (2.1e5, 2.1e5))
    facts = summary(vibrating, SETTINGS, swept, largest_force(found), 2.0 * LOAD, iso, errors)
    every = response_rows(vibrating, swept, found, iso, errors)
    rows = [replace(row, near_body_vibration=row.speed_rpm >= near) for row in every]
    return response_figure(replace(facts, **changed), rows, list(branch_rows(vibrating, swept)))


def bands(axes: Axes) -> list[PolyCollection]:
    return [each for each in axes.collections if isinstance(each, PolyCollection)]


def test_the_run_up_has_a_band_of_its_error() -> None:
    """As wide as twice the error at each speed, in µm and in the factor; the foot says what it is."""
    figure = drawn(known=True)
    for axes, scale in zip(figure.axes, (1e3, 1e3)):
        (band,) = bands(axes)
        corners = np.concatenate([path.vertices for path in band.get_paths()])
        for speed, bar in zip(SPEEDS, BARS):
            heights = corners[np.isclose(corners[:, 0], speed), 1]
            assert np.ptp(heights) == pytest.approx(2.0 * scale * bar, rel=1e-9)
    assert any("Its error: " in text.get_text() for text in figure.texts)


def test_an_unknown_error_has_none() -> None:
    """Nor a word at the foot or in the legend."""
    figure = drawn(known=False)
    assert bands(figure.axes[0]) == bands(figure.axes[1]) == []
    assert not any("Its error: " in text.get_text() for text in figure.texts)
    legend = figure.axes[0].get_legend()
    assert legend is not None and "its error" not in [text.get_text() for text in legend.get_texts()]


def test_no_curve_of_perfect_gears() -> None:
    """K_v of ISO 6336-1 is drawn for gears with deviations alone; else the foot names what it wants. Once,
    that of perfect gears was drawn under the standard's name."""
    for accuracy, curve in ((DEVIATING, True), (Accuracy(), False)):
        figure = drawn(False, accuracy)
        factor, foot = figure.axes[1], " ".join(text.get_text() for text in figure.texts)
        assert (ISO in [str(line.get_label()) for line in factor.lines]) == curve
        assert (factor.get_legend() is not None) == curve
        assert ("f_fα" in foot) != curve


def words(figure: Figure) -> str:
    return " ".join(text.get_text() for text in figure.texts)


def spans(axes: Axes) -> list[tuple[float, float]]:
    """Speeds between which a panel is shaded in the colour of the bodies."""
    found = []
    for each in axes.patches:
        if each.get_facecolor()[:3] == to_rgb(BODIES):
            x = each.get_patch_transform().transform_path(each.get_path()).vertices[:, 0]
            found.append((float(x.min()), float(x.max())))
    return found


def test_speeds_near_the_bodies_vibration_are_shaded() -> None:
    """Exact: the third mesh harmonic of 50 teeth has 10 kHz at 4000 r/min, so that all panels are shaded from 3600 to
    4800, and from 5400, 0.9 times the speed of the second, to the last speed. Nothing where bodies are rigid."""
    figure = drawn(False, bodies="elastic", body_frequency_Hz=1e4)
    for axes in figure.axes:
        assert sorted(spans(axes)) == [pytest.approx((3600.0, 4800.0)), pytest.approx((5400.0, 6000.0))]
    assert "the bodies' own vibration" in words(figure)
    rigid = drawn(False)
    assert not any(map(spans, rigid.axes)) and "own vibration" not in words(rigid)


def test_curves_near_the_bodies_vibration_are_faint() -> None:
    """From 5000 r/min on, of 3000 to 6000: curves of both ways end before, and go on faint. All full without."""
    for axes in drawn(False, near=5000.0).axes:
        for colour in (PINION, WHEEL):
            full, faint = (line for line in axes.lines if line.get_color() == colour)
            trusted = np.isfinite(np.asarray(full.get_ydata(), dtype=float))
            assert (np.asarray(full.get_xdata())[trusted] < 5000.0).all() and trusted.any()
            assert np.isfinite(np.asarray(faint.get_ydata(), dtype=float)).all() and faint.get_alpha() == DOUBTED
    assert not any(line.get_alpha() == DOUBTED for axes in drawn(False).axes for line in axes.lines)


def test_forces_beyond_the_force_surface_are_marked() -> None:
    """A line at the largest factor over the share by which it is beyond the heaviest torque; none at a share below 1.
    """
    figure = drawn(False, heaviest_torque_share=1.25)
    largest = max(float(np.max(np.asarray(line.get_ydata()))) for line in figure.axes[1].lines
                  if str(line.get_label()).startswith("running"))
    heights = [line.get_ydata() for line in figure.axes[1].lines if line.get_linestyle() == "-."]
    assert np.array(heights) == pytest.approx(largest / 1.25 * np.ones((1, 2)))
    assert "the mesh force goes on straight" in words(figure)
    within = drawn(False, heaviest_torque_share=0.9)
    assert "goes on straight" not in words(within)
    assert all(line.get_linestyle() != "-." for line in within.axes[1].lines)


def test_words_are_those_of_the_drawn_speeds() -> None:
    """Folds beyond the drawn speeds are not named, many are counted; the natural speed is said with the mass and the
    stiffness that it follows from: √(k/m) 60/(2π z)."""
    assert "turn back at 3500, 4000 r/min." in words(drawn(False, folds_rpm=(2000.0, 3500.0, 4000.0, 9000.0)))
    assert "No steady state turns back at these speeds." in words(drawn(False, folds_rpm=(2000.0, 9000.0)))
    assert "turn back at 20 of these speeds" in words(drawn(False, folds_rpm=tuple(np.linspace(3100.0, 5900.0, 20))))
    sentence = r"Natural speed (\d+) r/min, of ([\d.]+) kg on a mean tangent stiffness in motion of ([\d.]+) N/µm"
    said = re.search(sentence, words(drawn(False)))
    assert said is not None
    natural, mass, stiffness = map(float, said.groups())
    assert natural == pytest.approx(np.sqrt(1e6 * stiffness / mass) * 60.0 / (2.0 * np.pi * 50.0), rel=1e-3)
