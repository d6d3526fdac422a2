"""Figures of a pitch in line contact: forces of tooth pairs, load over the face, peak pressure."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from evolvent.contact.hertz import line_half_width
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_pitch import LinePitch
from evolvent.gears.line.line_result import LineResult
from tests.solver.gears.line.test_line_gears import RELIEVED, helical_model
from tests.support.gear_cases import model_of, spur_scene

ANGLES = 2.0 * np.pi / 20.0 * np.arange(3) / 3


@cache
def helical() -> LinePitch:
    gears = LineGears.of(helical_model())
    return LinePitch.of(gears, [gears.position(float(angle)) for angle in ANGLES], 1500.0)


@cache
def spur() -> LinePitch:
    gears = LineGears.of(model_of(spur_scene(*RELIEVED, "mesh.level=line")))
    return LinePitch.of(gears, [gears.position(float(angle)) for angle in 2.0 * np.pi / 50.0 * np.arange(8) / 8], 120.0)


@pytest.mark.parametrize("pitch", [helical, spur])
def test_forces_of_the_teeth_sum_to_the_load(pitch) -> None:  # type: ignore[no-untyped-def]
    """Exact: the normal forces of all tooth pairs are the force along the line of action over cos β_b."""
    force = 1500.0 if pitch is helical else 120.0
    for result in pitch().results:
        total = sum(result.force(tooth) for tooth in result.teeth)
        assert total * result.cosine == pytest.approx(force, rel=1e-9)


def test_force_below_a_height_ends_at_the_whole() -> None:
    """Exact: below the face nothing, below its upper end the force of the tooth pair, and between the stations the
    integral of the load per length, here by 20,001 points."""
    result: LineResult = helical().results[1]
    half = 0.5 * helical().gears.pair.face_width
    for tooth in result.teeth:
        ends = result.force_below(tooth, np.array([-half - 1.0, half + 1.0]))
        assert ends == pytest.approx([0.0, result.force(tooth)], rel=1e-9, abs=1e-9)
        z = np.linspace(-half, 0.3, 20001)
        load = result.load_at(tooth, z)
        integral = float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(z))) / result.cosine
        assert result.force_below(tooth, np.array([0.3]))[0] == pytest.approx(integral, rel=1e-4, abs=1e-3)


def test_peak_pressure_is_that_of_the_half_width() -> None:
    """Exact: p_0 = 2q/(πb) with Hertz' half-width b of the line load."""
    result = spur().results[2]
    q, system = result.equilibrium.load, result.position.system
    bears = q > 0.0
    b = line_half_width(q[bears], system.radius[bears], system.modulus)
    assert result.peak_pressure[bears] == pytest.approx(2.0 * q[bears] / (np.pi * b))
    assert spur().peak_pressure == pytest.approx(max(each.peak_pressure.max() for each in spur().results))


def test_face_load_factor() -> None:
    """In the plane 1. In space at least 1; a pair without lead modifications has a mean of all layers of 1, so that the
    factor is the largest of layers whose force sums to the load."""
    assert spur().face_load_factor == 1.0
    layers = helical().gears.layers
    assert layers is not None and (np.diff(layers) > 0.0).all()
    half = 0.5 * helical().gears.pair.face_width
    assert layers[[0, -1]].tolist() == [-half, half]
    force = sum(np.diff(r.force_below(tooth, layers)) for r in helical().results for tooth in r.teeth)
    assert np.sum(force) == pytest.approx(3 * 1500.0 / helical().results[0].cosine, rel=1e-9)
    load = np.asarray(force) / np.diff(layers)
    assert helical().face_load_factor == pytest.approx(load.max() / (np.sum(force) / (2.0 * half)))
    assert helical().face_load_factor > 1.0
