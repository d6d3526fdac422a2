"""The blow of a rigid mass on Hertz' relation of force and approach."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import trapezoid

from evidence.verification.transient.dropped_ball import APPROACH, MASS, MODULUS, RADIUS, SPEED, RigidBlow, volume


def test_half_spaces_are_hertz() -> None:
    """Contact for 2.9433 δ/v, the largest force 4/3 E*√R δ^(3/2), and the impulse 2mv."""
    blow = RigidBlow(MASS)
    time, force = blow.rise
    assert blow.largest == pytest.approx(4.0 / 3.0 * MODULUS * np.sqrt(RADIUS) * APPROACH**1.5, rel=1e-9)
    assert blow.duration == pytest.approx(2.9433 * APPROACH / SPEED, rel=5e-5)
    assert 2.0 * trapezoid(force, time) == pytest.approx(2.0 * MASS * SPEED, rel=1e-5)


def test_a_shortfall_makes_the_blow_shorter_and_harder() -> None:
    """The impulse stays 2mv."""
    hertz, short = RigidBlow(MASS), RigidBlow(MASS, 0.05 * APPROACH / RigidBlow(MASS).largest)
    time, force = short.rise
    assert short.duration < hertz.duration and short.largest > hertz.largest
    assert 2.0 * trapezoid(force, time) == pytest.approx(2.0 * MASS * SPEED, rel=1e-5)


def test_volume_of_the_quarter() -> None:
    """Of the cylinder r < 40 above the sphere z = R − √(R² − r²), by quadrature."""
    r = np.linspace(0.0, 40.0, 40001)
    height = 40.0 - (RADIUS - np.sqrt(RADIUS**2 - r**2))
    assert volume() == pytest.approx(0.5 * np.pi * trapezoid(height * r, r), rel=1e-8)
