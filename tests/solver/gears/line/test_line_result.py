"""Figures of positions in line contact: forces of tooth pairs, load over the face, peak pressure."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from evolvent.contact.hertz import line_half_width
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_result import LineResult
from tests.solver.gears.line.test_line_gears import RELIEVED, helical_model
from tests.support.gear_cases import model_of, spur_scene

ANGLES = 2.0 * np.pi / 20.0 * np.arange(3) / 3


@cache
def helical_gears() -> LineGears:
    return LineGears.of(helical_model())


@cache
def helical() -> list[LineResult]:
    return [LineResult.of(helical_gears().position(float(angle)), 1500.0) for angle in ANGLES]


@cache
def spur() -> list[LineResult]:
    gears = LineGears.of(model_of(spur_scene(*RELIEVED, "mesh.level=line")))
    return [LineResult.of(gears.position(float(angle)), 120.0) for angle in 2.0 * np.pi / 50.0 * np.arange(8) / 8]


@pytest.mark.parametrize("pitch", [helical, spur])
def test_forces_of_the_teeth_sum_to_the_load(pitch) -> None:  # type: ignore[no-untyped-def]
    """Exact: the normal forces of all tooth pairs are the force along the line of action over cos β_b."""
    force = 1500.0 if pitch is helical else 120.0
    for result in pitch():
        total = sum(result.force(tooth) for tooth in result.teeth)
        assert total * result.cosine == pytest.approx(force, rel=1e-9)


def test_force_below_a_height_ends_at_the_whole() -> None:
    """Exact: below the face nothing, below its upper end the force of the tooth pair, and between the stations the
    integral of the load per length, here by 20,001 points."""
    result: LineResult = helical()[1]
    half = 0.5 * helical_gears().pair.face_width
    for tooth in result.teeth:
        ends = result.force_below(tooth, np.array([-half - 1.0, half + 1.0]))
        assert ends == pytest.approx([0.0, result.force(tooth)], rel=1e-9, abs=1e-9)
        z = np.linspace(-half, 0.3, 20001)
        stations = result.position.stations
        own = stations.tooth == tooth
        load = np.interp(z, stations.z[own], result.equilibrium.load[own], left=0.0, right=0.0)
        integral = float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(z))) / result.cosine
        assert result.force_below(tooth, np.array([0.3]))[0] == pytest.approx(integral, rel=1e-4, abs=1e-3)


def test_peak_pressure_is_that_of_the_half_width() -> None:
    """Exact: p_0 = 2q/(πb) with Hertz' half-width b of the line load."""
    result = spur()[2]
    q, system = result.equilibrium.load, result.position.system
    bears = q > 0.0
    b = line_half_width(q[bears], system.radius[bears], system.modulus)
    assert result.peak_pressure[bears] == pytest.approx(2.0 * q[bears] / (np.pi * b))
    pair = spur_scene(*RELIEVED).gear_pair()
    assert result.largest_pressure(pair) == pytest.approx(result.peak_pressure.max())


def test_pressure_over_a_kink_does_not_count() -> None:
    """Problem: linear reliefs, of which contacts at some positions cover the start. Exact: there p_0 is that of the
    other tooth pair alone, or none; with parabolic reliefs all count."""
    scene = spur_scene("mesh.level=line", "pinion.tip_relief_um=20", "wheel.tip_relief_um=20")
    gears, pair = LineGears.of(model_of(scene)), scene.gear_pair()
    angles = 2.0 * np.pi / 50.0 * np.arange(24) / 24
    results = [LineResult.of(gears.position(float(angle)), 120.0) for angle in angles]
    covered = [result.largest_pressure(pair) < result.peak_pressure.max() - 1e-9 for result in results]
    assert 0 < sum(covered) < len(covered)


def test_loads_of_layers_over_the_mean() -> None:
    """Exact: forces between the ends of layers over their share of the face; one layer in the plane. Layers end at the
    ends of the common face, also where one gear is wider, and none is a strip of it."""
    assert spur()[0].layer_load(None).tolist() == [1.0]
    layers = helical_gears().layers
    assert layers is not None and (np.diff(layers) > 0.0).all()
    half = 0.5 * helical_gears().pair.face_width
    assert layers[[0, -1]].tolist() == [-half, half]
    for result in helical():
        force = sum(np.diff(result.force_below(tooth, layers)) for tooth in result.teeth)
        assert np.sum(force) == pytest.approx(1500.0 / result.cosine, rel=1e-9)
        load = np.asarray(force) / np.diff(layers) / (np.sum(force) / (2.0 * half))
        assert result.layer_load(layers) == pytest.approx(load)
    wider = replace(helical_gears().gears[0], heights=helical_gears().gears[0].heights * 1.01)
    ends = replace(helical_gears(), gears=(wider, helical_gears().gears[1])).layers
    assert ends is not None and ends == pytest.approx(layers)
