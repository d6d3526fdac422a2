"""Curves of root stress and their error bars, from stresses that are written out."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from evolvent.strength.results.root_curves import compression_curve, curve_errors, tension_curve
from evolvent.strength.root_passage import GearRoots, RootPassage
from evolvent_meshes.arrays import Floats

ANGLES = np.radians([0.0, 1.0, 2.0, 3.0, 4.0])
TENSION = np.array([10.0, 40.0, 60.0, 50.0, 20.0])


def roots(tension: Floats, pressure: Floats) -> GearRoots:
    """Two nodes a side, of which the second bears half of the stress, along x."""
    root: Any = SimpleNamespace(is_fillet=np.array([True, True]))

    def passage(values: Floats) -> RootPassage:
        stress = np.zeros((len(values), 2, 3, 3))
        stress[:, :, 0, 0] = values[:, None] * [1.0, 0.5]
        return RootPassage(root, ANGLES[: len(values)], stress, *np.ones((2, len(values))))

    return GearRoots(passage(tension), passage(pressure))


def test_curves_are_the_extreme_principal_stresses() -> None:
    """Of the node that bears most: tension of the loaded side, compression of the back."""
    own = roots(TENSION, -2.0 * TENSION)
    assert tension_curve(own).values == pytest.approx(TENSION, rel=1e-12)
    assert compression_curve(own).values == pytest.approx(-2.0 * TENSION, rel=1e-12)
    assert tension_curve(own).angle == pytest.approx(ANGLES, rel=1e-12)


@pytest.mark.parametrize(("order", "factor"), [(1, 2.0), (2, 1.0 / 3.0)])
def test_bars_of_curves_that_differ_by_a_factor(order: int, factor: float) -> None:
    """The companion has 0.9 of every stress: each bar is a tenth of the peak by Richardson's factor. Behind the largest
    tension the line through 40, 60 and that through 50, 20 cross at 68, so that the spacing adds 8, of
    compression twice that."""
    own, coarse = roots(TENSION, -2.0 * TENSION), roots(0.9 * TENSION, -1.8 * TENSION)
    for curve, times in ((tension_curve, 1.0), (compression_curve, 2.0)):
        bars = curve_errors(curve, own, coarse, order)
        assert bars.values == pytest.approx(np.full(5, 0.1 * factor * times * 60.0), rel=1e-9)
        assert bars.peak == pytest.approx(times * (0.1 * factor * 60.0 + 8.0), rel=1e-9)


def test_bars_do_not_vanish_where_curves_cross() -> None:
    """The companion is right at the peak and wrong elsewhere: bars are at least the root mean square difference of the
    curves over that of the curve, times the peak, and at least the difference there."""
    less = TENSION - [5.0, 5.0, 0.0, 5.0, 5.0]
    relative = 10.0 / float(np.linalg.norm(TENSION))
    bars = curve_errors(tension_curve, roots(TENSION, -TENSION), roots(less, -TENSION), 2)
    assert bars.values[2] == pytest.approx(relative / 3.0 * 60.0, rel=1e-9)
    assert bars.values[0] == pytest.approx(max(5.0, relative * 60.0) / 3.0, rel=1e-9)
    assert bars.peak == pytest.approx(relative / 3.0 * 60.0 + 8.0, rel=1e-9)


def test_without_a_companion_bars_are_unknown() -> None:
    """NaN, for each value and for the largest."""
    bars = curve_errors(tension_curve, roots(TENSION, -TENSION), None, 2)
    assert np.isnan(bars.values).all()
    assert bars.values.shape == (5,)
    assert np.isnan(bars.peak)
