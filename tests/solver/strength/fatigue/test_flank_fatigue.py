"""Criteria over a flank, against those of single histories."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.strength.fatigue.criteria import (
    dang_van,
    fatemi_socie,
    largest_shear,
    orthogonal_shear_range,
    von_mises,
)
from evolvent.strength.fatigue.criterion import (
    CONTACT_PRESSURE,
    DANG_VAN,
    FATEMI_SOCIE,
    MAXIMUM_SHEAR,
    ORTHOGONAL_SHEAR,
    TENSION,
    VON_MISES,
    criteria_of,
)
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, flank_fatigue, passage
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.fatigue.half_plane import HertzTractions, plane_strain

STEEL = FatigueMaterial(0.3, 80e3, 900.0, 0.3, 0.1, 1.0)
PEAKS, HALF_WIDTHS, RATIOS = np.array([1500.0, 800.0]), np.array([0.12, 0.2]), np.array([0.1, 0.05])
LOADS = FlankLoads(np.zeros((2, 3), dtype=int), np.array([-3.0, 2.0]), np.zeros(2), PEAKS, HALF_WIDTHS, RATIOS)


def test_points_of_a_flank_one_by_one() -> None:
    """Two points, one of which sticks in part: each criterion at three depths is that of the history below its own
    half-ellipse in millimetres, to 1e-9; Fatemi-Socie to 5e-3, as its planes are 2° and 5° apart."""
    found = flank_fatigue(LOADS, 0.1, (0.0, 0.5, 1.2), STEEL)
    assert found.depths_mm == pytest.approx(np.outer(HALF_WIDTHS, [0.0, 0.5, 1.2]))
    for point, (peak, b, ratio) in enumerate(zip(PEAKS, HALF_WIDTHS, RATIOS)):
        for k, depth in enumerate(found.depths_mm[point]):
            x = b * passage()
            history = plane_strain(HertzTractions(b, peak, ratio).stress(x, np.full_like(x, depth)), 0.3)
            at = {criterion: values[point, k] for criterion, values in found.values.items()}
            assert at[ORTHOGONAL_SHEAR] == pytest.approx(orthogonal_shear_range(history), rel=1e-9)
            assert at[MAXIMUM_SHEAR] == pytest.approx(largest_shear(history).max(), rel=1e-9)
            assert at[VON_MISES] == pytest.approx(von_mises(history).max(), rel=1e-9)
            assert at[DANG_VAN] == pytest.approx(dang_van(history, 0.3, 0.1), rel=1e-6)
            assert at[TENSION] == pytest.approx(max(history[:, 0, 0].max(), 0.0), rel=1e-9)
            assert at[FATEMI_SOCIE] == pytest.approx(fatemi_socie(history, 80e3, 900.0, 1.0), rel=5e-3)
    assert found.values[CONTACT_PRESSURE][:, 0] == pytest.approx(PEAKS)


def test_surface_below_sliding_contact() -> None:
    """At the surface the range of orthogonal shear is μp0, tension 2μp0 (Johnson, Contact Mechanics, 7.1.1)."""
    found = flank_fatigue(LOADS, 0.1, (0.0, 0.5), STEEL)
    assert found.values[ORTHOGONAL_SHEAR][:, 0] == pytest.approx(RATIOS * PEAKS, rel=1e-6)
    assert found.values[TENSION][:, 0] == pytest.approx(2.0 * RATIOS * PEAKS, rel=1e-4)


def test_without_yield_stress_one_criterion_is_left_out() -> None:
    """That of Fatemi and Socie."""
    without = FatigueMaterial(0.3, 80e3, None, 0.3, 0.1, 1.0)
    assert set(criteria_of(STEEL.yield_stress)) - set(criteria_of(None)) == {FATEMI_SOCIE}
    assert FATEMI_SOCIE not in flank_fatigue(LOADS, 0.1, (0.0, 0.5), without).values


def test_without_friction() -> None:
    """μ = 0: no tension, range of orthogonal shear p0/2 at b/2 (Johnson, 4.2)."""
    still = FlankLoads(LOADS.place, LOADS.roll_distance, LOADS.height, PEAKS, HALF_WIDTHS, np.zeros(2))
    found = flank_fatigue(still, 0.0, (0.0, 0.5), STEEL)
    assert found.values[ORTHOGONAL_SHEAR][:, 1] == pytest.approx(0.5 * PEAKS, rel=1e-3)
    assert found.values[TENSION][:, 0] == pytest.approx([0.0, 0.0], abs=1e-6)
