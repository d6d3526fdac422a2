"""Heights that curves may reach between their points, of curves that are known everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.results.error_bars.peak_bounds import INNER, peak_bounds
from evolvent_meshes.arrays import Floats


@pytest.mark.parametrize("kink", [3.3, 3.6])
def test_a_kink_between_points_is_found(kink: float) -> None:
    """y = 10 - |x - kink|: place and height of the kink exactly, 1e-12, in one of the two intervals; in the other one
    nothing that is higher than the largest point."""
    x = np.arange(8.0)
    y = 10.0 - np.abs(x - kink)
    first, second = sorted(peak_bounds(x, y), key=lambda each: -each.height)
    assert (first.angle, first.height) == pytest.approx((kink, 10.0), rel=1e-12)
    assert first.width == 1.0
    assert second.height <= y.max() + 1e-12


def test_concave_curves_are_bounded() -> None:
    """Parabolas with a largest value of 1 between points that are 0.1 apart: no value is above the bound, which is
    above the parabola by no more than the curvature times the square of the interval."""
    for vertex in np.linspace(0.42, 0.58, 17):
        x = np.linspace(0.0, 1.0, 11)
        y = 1.0 - (x - vertex) ** 2
        bound = max(y.max(), *(each.height for each in peak_bounds(x, y)))
        assert 1.0 - 1e-12 <= bound <= 1.0 + 2.0 * 0.1**2


def test_places_keep_away_from_the_points() -> None:
    """A kink at a hundredth of an interval from a point: the place is `INNER` of the interval from it, the height that
    of the kink."""
    x = np.arange(8.0)
    best = max(peak_bounds(x, 10.0 - np.abs(x - 3.01)), key=lambda each: each.height)
    assert best.angle == pytest.approx(3.0 + INNER, rel=1e-12)
    assert best.height == pytest.approx(10.0, rel=1e-12)


def test_a_step_before_falling_values() -> None:
    """0, 0, then 10, 9, 8: where in the first interval the step is cannot be said; the line through the falling values
    is 11 at its far end. Behind it nothing is higher."""
    before, behind = peak_bounds(np.arange(6.0), np.array([0.0, 0.0, 0.0, 10.0, 9.0, 8.0]))
    assert (before.angle, before.height) == pytest.approx((2.5, 11.0), rel=1e-12)
    assert behind.height <= 10.0


SLOPE = 0.06
"""Of a lightly loaded tooth's root stress before the next pair takes over 40 % of the load, per degree, over its
largest value."""


def sheds_load(x: Floats, jump: float, width: float) -> Floats:
    """Rises by SLOPE, slightly convex, up to `jump`, where it falls to 0.6 exponentially, to 1/e within `width`. The
    largest value is 1."""
    rising = 1.0 + SLOPE * (x - jump) + 2e-3 * (x - jump) ** 2
    return np.where(x <= jump, rising, 0.6 + 0.4 * np.exp(-np.maximum(x - jump, 0.0) / width))


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("width", [0.005, 0.02])
def test_bounds_beside_a_jump_hold_and_are_narrow(width: float, mirrored: bool) -> None:
    """Problem: under 1 % of the load He's pair has a jump where the next pair takes over; a bar of 9 % came from the
    steep line, where the curve is known to 1 %. Exact: the largest value, 1. Points 0.36 apart, the jump at 40 places
    between them: the bound holds it wherever the jump is, and is higher by no more than what the curve rises over two
    intervals."""
    for place in np.linspace(0.0, 0.36, 40, endpoint=False):
        x = 0.36 * np.arange(-8.0, 9.0)
        y = sheds_load(x, place, width)
        y = y[::-1] if mirrored else y
        height = max(y.max(), *(each.height for each in peak_bounds(x, y)))
        assert 1.0 - 1e-3 <= height <= 1.0 + 2.0 * 0.36 * SLOPE


def test_a_kink_at_a_point_before_a_jump() -> None:
    """The points of He's pinion under 1.7 N·m beside its outer point of single contact [°, MPa]: the largest one is the
    kink itself, and the bound above it by what the gentle line rises over the interval of 0.08°, 0.6 %; 9 % before."""
    x = np.array([0.54, 0.72, 0.7608, 0.8016, 0.8832, 1.08, 1.44])
    y = np.array([0.9070, 0.9184, 0.9210, 0.92363, 0.5944, 0.5787, 0.5802])
    height = max(each.height for each in peak_bounds(x, y))
    assert height == pytest.approx(0.92363 + 0.0816 * (0.92363 - 0.9210) / 0.0408, rel=1e-9)


def test_ends_have_no_bounds() -> None:
    """Where the largest point is the first or the last, or there are fewer than four, nothing is said."""
    x = np.arange(5.0)
    assert list(peak_bounds(x, x)) == [] == list(peak_bounds(x, -x))
    assert list(peak_bounds(x[:3], np.array([0.0, 1.0, 0.0]))) == []
