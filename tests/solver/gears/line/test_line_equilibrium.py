"""Loads per length in equilibrium: against scalar equations, and against the balance of every station."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from evolvent.contact.hertz import line_half_width
from evolvent.gears.line.line_equilibrium import LineSystem, line_equilibrium

ONE = LineSystem(
    np.array([[2e-5]]), np.array([1.0]), np.array([0.01]), np.array([5.0]), np.array([math.log(0.5)]),
    np.array([0.9]), 115e3,
)


def beam(stations: int) -> LineSystem:
    """Stations on an elastic foundation that couples neighbours, with a parabolic gap."""
    x = np.linspace(-1.0, 1.0, stations)
    B = 2e-5 * np.exp(-np.abs(x[:, None] - x) / 0.3) / stations
    same = np.ones(stations)
    return LineSystem(B, same / stations, 0.02 * x**2, 5.0 * same, math.log(0.5) * same, 0.9 * same / stations, 115e3)


@pytest.mark.parametrize("force", [1.0, 50.0, 400.0])
def test_one_station_is_a_scalar_equation(force: float) -> None:
    """Exact: q = F/H; δ = (B q + φ(q) + g)/H with Hertz' half-width b = √(4qρ/πE*)."""
    found = line_equilibrium(ONE, force)
    q = force / 0.9
    b = math.sqrt(4.0 * q * 5.0 / (math.pi * 115e3))
    φ = 2.0 / (math.pi * 115e3) * q * (0.25 + math.log(0.5 / b))
    assert found.load[0] == pytest.approx(q, rel=1e-9)
    assert found.approach == pytest.approx((2e-5 * q + φ + 0.01) / 0.9, rel=1e-9)


def test_every_station_is_in_balance() -> None:
    """Exact: where a station bears B q + ℓφ(q) + ℓg = Hδ; elsewhere the left side is larger; Hᵀq = F. Under a light
    load the ends of the beam do not bear, under a heavy one all does."""
    system, c = beam(21), 2.0 / (math.pi * 115e3)
    for force, all_bear in ((5.0, False), (600.0, True)):
        found = line_equilibrium(system, force)
        q = found.load
        φ = c * q * (0.25 + system.log_width - np.log(line_half_width(np.maximum(q, 1e-12), system.radius, 115e3)))
        left = system.B @ q + system.length * (φ + system.gap) - system.H * found.approach
        assert np.abs(left[q > 0.0]).max() < 1e-9 * float(np.abs(system.H * found.approach).max())
        assert (left[q == 0.0] > 0.0).all()
        assert float(system.H @ q) == pytest.approx(force, rel=1e-12)
        assert (q > 0.0).all() == all_bear


def test_stiffness_is_the_derivative() -> None:
    """dF/dδ against loads 1e-4 above and below: 1e-6."""
    system, force = beam(21), 100.0
    above, below = (line_equilibrium(system, force * (1.0 + step)) for step in (1e-4, -1e-4))
    difference = 2e-4 * force / (above.approach - below.approach)
    assert line_equilibrium(system, force).stiffness == pytest.approx(difference, rel=1e-6)


def test_the_width_that_carries_the_load_cancels() -> None:
    """Problem: a compliance that holds the logarithm of w, as a body's does, B_ii = c ℓ ln(R/w). Exact: δ does not
    depend on w while it is wider than the contact."""
    c = 2.0 / (math.pi * 115e3)

    def carried(w: float) -> LineSystem:
        return replace(ONE, B=np.array([[c * math.log(20.0 / w)]]), log_width=np.array([math.log(w)]))

    wide, narrow = (line_equilibrium(carried(w), 200.0).approach for w in (1.0, 0.4))
    assert wide == pytest.approx(narrow, rel=1e-12)


def test_wide_contact_stays_monotone() -> None:
    """Problem: a contact wider than w, where φ would fall with the load. Exact: beyond 0.75 w the half-width is taken
    as that, so that φ(q) = (2/πE*) q (¼ + ln(1/0.75))."""
    force = 0.9 * brentq(lambda q: float(line_half_width(q, 5.0, 115e3)) - 1.0, 1.0, 1e6)
    q, c = force / 0.9, 2.0 / (math.pi * 115e3)
    expected = (2e-5 * q + c * q * (0.25 - math.log(0.75)) + 0.01) / 0.9
    assert line_equilibrium(ONE, force).approach == pytest.approx(expected, rel=1e-9)
