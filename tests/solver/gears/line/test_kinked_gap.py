"""Contact across a line where the gap is no parabola.

Exact: Hertz' contact for a parabola. Oracle for a parabola with a kink: half-planes in contact by 1,000 cells of equal
pressure, whose bearing cells are searched (Johnson, Contact Mechanics, 1985, 5.9).
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import toeplitz

from evolvent.gears.line.kinked_gap import SampledGap, equal_hertz
from evolvent_meshes.arrays import Floats

C, RADIUS, LOAD = 2.0 / (np.pi * 115e3), 8.0, 100.0
HALF = float(np.sqrt(2.0 * C * LOAD * RADIUS))


def gap_of(x: Floats, kink: float, place: float) -> Floats:
    return np.asarray(0.001 + x**2 / (2.0 * RADIUS) + kink * np.maximum(x - place, 0.0))


def approach(kink: float, place: float, load: float, middle: float = 0.02) -> tuple[float, float, float]:
    """δ, m and b of the Hertz contact that stands for the kinked one."""
    samples = SampledGap.of(lambda x: gap_of(x, kink, place), np.array([middle]), np.array([HALF]))
    gap, m, b = equal_hertz(samples, np.array([HALF]), np.array([load]), C)
    return float(gap[0] + C * load * (0.5 - np.log(0.5 * b[0]))), float(m[0]), float(b[0])


def by_cells(kink: float, place: float, load: float, cells: int = 1000) -> tuple[float, float, float]:
    h = 3.2 * HALF / cells
    x = (np.arange(cells) - (cells - 1) / 2) * h
    t = np.arange(cells + 1.0)
    integral = 0.5 * t**2 * np.log(np.maximum(t, 1e-300)) - 0.75 * t**2
    second = np.append(integral[1], integral)
    compliance = -C * (toeplitz(second[2:] - 2.0 * second[1:-1] + second[:-2]) + np.log(h))
    gap, bears = gap_of(x, kink, place), np.abs(x) < HALF
    for _ in range(50):
        a = np.flatnonzero(bears)
        matrix = np.block([[compliance[np.ix_(a, a)], -np.ones((len(a), 1))], [np.ones((1, len(a))), np.zeros((1, 1))]])
        found = np.linalg.solve(matrix, np.append(-gap[a], load))
        force = np.zeros(cells)
        force[a] = found[:-1]
        now = np.where(bears, force > 0.0, compliance @ force + gap < found[-1])
        if (now == bears).all():
            return float(found[-1]), 0.5 * (x[a[-1]] + x[a[0]]), 0.5 * (x[a[-1]] - x[a[0]] + h)
        bears = now
    raise AssertionError("no bearing cells")


def test_a_parabola_is_hertz() -> None:
    """b = √(2 c q ρ), m = 0 and the gap at the vertex, from wherever the samples are centred."""
    for middle in (-0.04, 0.0, 0.02):
        δ, m, b = approach(0.0, 1.0, LOAD, middle)
        assert b == pytest.approx(HALF, rel=1e-4) and m == pytest.approx(0.0, abs=1e-5)
        assert δ == pytest.approx(0.001 + C * LOAD * (0.5 - np.log(0.5 * HALF)), abs=1e-5 * C * LOAD)


@pytest.mark.parametrize("kink", [1e-3, 4e-3, 1e-2])
@pytest.mark.parametrize("place", [-0.05, 0.0, 0.05, 0.08])
def test_kinks_anywhere_below_the_contact(kink: float, place: float) -> None:
    """Slopes of a relief of up to 10 µm/mm, from one end of the contact to the other: δ within 1e-3 c q, the interval
    within half a per cent of its half-width."""
    δ, m, b = approach(kink, place, LOAD)
    wanted = by_cells(kink, place, LOAD)
    assert abs(δ - wanted[0]) < 1e-3 * C * LOAD
    assert (m, b) == pytest.approx(wanted[1:], abs=5e-3 * HALF)


def test_stiffness_is_that_of_the_half_width() -> None:
    """dδ/dq = −c ln(b/2), by differences of δ."""
    (low, *_), (high, *_), (_, _, b) = (approach(4e-3, 0.03, load) for load in (99.0, 101.0, 100.0))
    assert (high - low) / 2.0 == pytest.approx(-C * np.log(0.5 * b), rel=1e-3)
