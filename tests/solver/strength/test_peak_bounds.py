"""Heights that curves may reach between their points, of curves that are known everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.strength.peak_bounds import INNER, beside_largest


@pytest.mark.parametrize("kink", [3.3, 3.6])
def test_a_kink_between_points_is_found(kink: float) -> None:
    """y = 10 - |x - kink|: place and height of the kink exactly, 1e-12, in one of the two intervals; in the other one
    nothing that is higher than the largest point."""
    x = np.arange(8.0)
    y = 10.0 - np.abs(x - kink)
    first, second = sorted(beside_largest(x, y), key=lambda each: -each.height)
    assert (first.place, first.height) == pytest.approx((kink, 10.0), rel=1e-12)
    assert first.width == 1.0
    assert second.height <= y.max() + 1e-12


def test_concave_curves_are_bounded() -> None:
    """Parabolas with a largest value of 1 between points that are 0.1 apart: no value is above the bound, which is
    above the parabola by no more than the curvature times the square of the interval."""
    for vertex in np.linspace(0.42, 0.58, 17):
        x = np.linspace(0.0, 1.0, 11)
        y = 1.0 - (x - vertex) ** 2
        bound = max(y.max(), *(each.height for each in beside_largest(x, y)))
        assert 1.0 - 1e-12 <= bound <= 1.0 + 2.0 * 0.1**2


def test_places_keep_away_from_the_points() -> None:
    """A kink at a hundredth of an interval from a point: the place is `INNER` of the interval from it, the height that
    of the kink."""
    x = np.arange(8.0)
    best = max(beside_largest(x, 10.0 - np.abs(x - 3.01)), key=lambda each: each.height)
    assert best.place == pytest.approx(3.0 + INNER, rel=1e-12)
    assert best.height == pytest.approx(10.0, rel=1e-12)


def test_a_step_before_falling_values() -> None:
    """0, 0, then 10, 9, 8: where in the first interval the step is cannot be said; the line through the falling values
    is 10.5 in its middle."""
    before, behind = beside_largest(np.arange(6.0), np.array([0.0, 0.0, 0.0, 10.0, 9.0, 8.0]))
    assert (before.place, before.height) == pytest.approx((2.5, 10.5), rel=1e-12)
    assert behind.height <= 10.0


def test_ends_have_no_bounds() -> None:
    """Where the largest point is the first or the last, or there are fewer than four, nothing is said."""
    x = np.arange(5.0)
    assert list(beside_largest(x, x)) == [] == list(beside_largest(x, -x))
    assert list(beside_largest(x[:3], np.array([0.0, 1.0, 0.0]))) == []
