"""Mesh harmonics of sums of cosines."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.excitation.harmonics import mesh_harmonics


def test_amplitudes_and_phases_of_cosines() -> None:
    """5 + 2 cos(θ + 0.3) + 0.7 cos(3θ − 1.1) at 16 phases: exact to rounding, nothing in between."""
    θ = 2.0 * np.pi * np.arange(16) / 16
    amplitudes, phases = mesh_harmonics(5.0 + 2.0 * np.cos(θ + 0.3) + 0.7 * np.cos(3.0 * θ - 1.1))
    assert amplitudes == pytest.approx([2.0, 0.0, 0.7, 0.0, 0.0], abs=1e-14)
    assert (phases[0], phases[2]) == pytest.approx((0.3, -1.1), abs=1e-13)


def test_too_few_positions_are_refused() -> None:
    """Five harmonics want eleven positions."""
    with pytest.raises(ValueError, match="wanted at least 11 positions of the pitch, found 10"):
        mesh_harmonics(np.zeros(10))
