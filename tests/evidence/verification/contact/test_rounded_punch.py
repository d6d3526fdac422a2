"""The closed form of the rounded punch, the reference solution of a verification problem."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.verification.contact.rounded_punch import RoundedPunch
from evolvent.contact import hertz

PUNCH = RoundedPunch(flat=1.0, rounding=50.0, half_width=1.25, modulus=6e4)


def test_load_of_the_rounded_punch_is_its_pressures_integral() -> None:
    """The pressure's integral is the load that belongs to the half-width."""
    φ = (np.arange(200000) + 0.5) / 200000 * np.pi
    share = PUNCH.half_width * np.sin(φ) * np.pi / len(φ)
    assert share @ PUNCH.pressure(PUNCH.half_width * np.cos(φ)) == pytest.approx(PUNCH.load, rel=1e-6)


@pytest.mark.parametrize("x", [0.5, 0.9, 1.1, 1.2])
def test_pressure_of_the_rounded_punch_closes_its_gap(x: float) -> None:
    """The half-planes' slope under it, (2/πE*) of the principal value of ∫p(s)/(x − s) ds, is that of the gap: 0 under
    the flat, (x − a)/R beyond. Regular where p = f√(b² − s²) has f(x) taken off, of which the integral is f π x."""
    b, φ = PUNCH.half_width, (np.arange(200000) + 0.5) / 200000 * np.pi
    s, root = b * np.cos(φ), b * np.sin(φ)
    here = float(PUNCH.pressure(np.array([x]))[0]) / np.sqrt(b**2 - x**2)
    regular = np.sum((PUNCH.pressure(s) / root - here) / (x - s) * root**2) * np.pi / len(φ)
    slope = 2.0 / (np.pi * PUNCH.modulus) * (regular + here * np.pi * x)
    assert slope == pytest.approx(max(x - PUNCH.flat, 0.0) / PUNCH.rounding, abs=1e-9)


def test_rounded_punch_without_flat_is_hertz() -> None:
    """a → 0: Hertz' load and peak pressure."""
    rounded = RoundedPunch(1e-6, 50.0, 1.25, 6e4)
    assert hertz.line_half_width(rounded.load, 50.0, 6e4) == pytest.approx(1.25, rel=1e-5)
    found = float(rounded.pressure(np.array([0.1]))[0])
    assert found == pytest.approx(hertz.line_peak_pressure(rounded.load, 50.0, 6e4) * np.sqrt(1 - 0.08**2), rel=1e-4)
