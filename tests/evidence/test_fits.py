"""Fits to pressures, and L2 errors."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.fits import half_ellipse, order_of, relative_l2


def test_half_ellipse_is_found_from_its_own_points() -> None:
    """p = 300 √(1 − (x/2)²) on |x| < 2 and, beyond 70 % of that, anything else: p0 = 300, half-width 2."""
    x = np.linspace(-2.0, 2.0, 101)
    pressure = np.where(np.abs(x) < 1.4, 300.0 * np.sqrt(1.0 - (x / 2.0) ** 2), 7.0)
    fit = half_ellipse(x, pressure, 2.0)
    assert (fit.peak, fit.half_width) == pytest.approx((300.0, 2.0))


def test_relative_l2_weighs_points_and_sums_components() -> None:
    """Vectors (3, 4) and (0, 0) of weights 1 and 2, each off by (0, 1): √((1 + 2)/25)."""
    exact = np.array([[3.0, 4.0], [0.0, 0.0]])
    computed = exact + np.array([0.0, 1.0])
    assert relative_l2(np.array([1.0, 2.0]), computed, exact) == pytest.approx(np.sqrt(3.0 / 25.0))


def test_order_is_the_slope_of_a_power() -> None:
    """Errors 3/n²: order 2."""
    counts = (10, 20, 80)
    assert order_of(counts, 3.0 / np.array(counts) ** 2) == pytest.approx(2.0)
