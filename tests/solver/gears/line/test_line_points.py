"""Contact points of a line contact: force and width of Hertz' half-ellipses, loads of layers, friction."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.contact.hertz import line_half_width
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_points import line_points
from evolvent.gears.line.line_result import LineResult
from evolvent.gears.pressure.contact_slices import fitted_peak
from evolvent_meshes.arrays import Floats
from tests.solver.gears.line.test_line_friction import helical, spur

ANGLE, FRICTION = 0.04, 0.1


def heights(gears: LineGears) -> Floats:
    return gears.gears[0].heights[::2]


def test_points_in_the_plane_are_hertz_half_ellipses() -> None:
    """Exact: the force of each tooth pair; the half-ellipse with the pressures' force and second moment has p_0 =
    2q/(πb) and the half-width b = √(4qρ/πE*)."""
    gears = spur()
    found = LineResult.of(gears.position(ANGLE), 120.0, FRICTION)
    points, system = line_points(gears.pair, found, None, gears.driving), found.position.system
    for k, tooth in enumerate(found.teeth):
        q, at = found.force(tooth), points.tooth == tooth
        if q == 0.0:
            assert not at.any()
            continue
        assert points.normal_force(tooth) == pytest.approx(q, rel=1e-12)
        half = float(line_half_width(q, system.radius[k], system.modulus))
        peak, fitted = fitted_peak(points.across[at], points.pressure[at], points.weights[at], q)
        assert (peak, fitted) == pytest.approx((2.0 * q / (np.pi * half), half), rel=1e-12)
    assert (points.opposite == -points.across).all()


def test_layers_bear_what_the_line_does() -> None:
    """Exact, a helical pair: points of a layer of the pinion's mesh sum to the force between its ends; the whole to
    that of the tooth pair."""
    gears = helical()
    found = LineResult.of(gears.position(ANGLE), 1500.0)
    points, ends = line_points(gears.pair, found, heights(gears), gears.driving), heights(gears)
    assert points.traction.shape[1] == 1
    for tooth in found.teeth:
        at = points.tooth == tooth
        force, _ = np.histogram(points.z[at], ends, weights=(points.weights * points.pressure)[at])
        expected = np.diff(found.force_below(tooth, ends))
        assert force == pytest.approx(expected, rel=1e-9, abs=1e-9 * found.force(tooth))


def test_friction_of_the_points_loses_the_power() -> None:
    """Exact: Σ w τ·v is the power of friction; in space within 5e-4, as each part of a coarse layer bears in
    its middle. τ is at most μ p, and less only where the line passes the pitch point, where the points stick."""
    for gears, ends, force, near in ((spur(), None, 120.0, 1e-12), (helical(), heights(helical()), 1500.0, 5e-4)):
        found = LineResult.of(gears.position(ANGLE), force, FRICTION)
        points = line_points(gears.pair, found, ends, gears.driving)
        power = float(np.sum(points.weights * points.traction[:, 1] * points.rate[:, 1]))
        assert power == pytest.approx(found.friction_power, rel=near)
        bound = FRICTION * points.pressure
        assert np.abs(points.traction[~points.sticks, 1]) == pytest.approx(bound[~points.sticks])
        assert (np.abs(points.traction[points.sticks, 1]) < bound[points.sticks]).all()
