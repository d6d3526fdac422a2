"""A speed of a pinion with 50 teeth in its four units."""

from __future__ import annotations

import math

import numpy as np
import pytest

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed, speeds_to_periods

TEETH = 50


def test_units_of_a_speed() -> None:
    """Exact: 1500 r/min are 25 turns and 1250 teeth a second, 50π rad/s and 0.8 ms a tooth."""
    speed = MeshSpeed(1500.0, TEETH)
    assert (speed.mesh_frequency, speed.mesh_period) == (1250.0, 0.8e-3)
    assert speed.rad_s == pytest.approx(50.0 * math.pi, rel=1e-15)


@pytest.mark.parametrize("made", [
    MeshSpeed.of_period(0.8e-3, TEETH), MeshSpeed.of_frequency(1250.0, TEETH),
    MeshSpeed.of_natural((2500.0 * math.pi) ** 2 * 3e-3, 3e-3, TEETH),
])
def test_a_speed_from_its_mesh(made: MeshSpeed) -> None:
    """From the period, the frequency, and the natural frequency √(k/m)/2π of 1250 Hz: 1500 r/min."""
    assert made.rpm == pytest.approx(1500.0, rel=1e-15)
    assert made.teeth == TEETH


def test_periods_of_several_speeds() -> None:
    """Exact: twice the speed has half the period; and back."""
    periods = speeds_to_periods(np.array([750.0, 1500.0, 3000.0]), TEETH)
    assert periods.tolist() == [1.6e-3, 0.8e-3, 0.4e-3]
    assert speeds_to_periods(periods, TEETH) == pytest.approx([750.0, 1500.0, 3000.0], rel=1e-15)


def test_speed_of_an_infinite_frequency() -> None:
    """Infinite, as for rigid bodies, which have no vibration of their own."""
    assert MeshSpeed.of_frequency(math.inf, TEETH).rpm == math.inf
