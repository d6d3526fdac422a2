"""Differences of two curves, and of their figures."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.results.error_bars.compared import Compared, Curve


def test_difference_of_curves_is_the_larger_of_figure_and_rms() -> None:
    """Exact: 3 + sin over a whole turn against the same shifted by 0.3: peak-to-peak agrees, the relative rms
    difference is 0.3/√9.5; against twice itself the figure's own difference is the larger one. NaN in one curve and
    rotations of one alone do not count."""
    at = np.arange(64) * 2 * np.pi / 64
    first = Curve(at, 3.0 + np.sin(at))
    assert Compared(first, Curve(at, first.values + 0.3)).of_figure(np.ptp) == pytest.approx(2.0 * 0.3 / np.sqrt(9.5))
    assert Compared(first, Curve(at, 2.0 * first.values)).of_figure(np.mean) == pytest.approx(3.0)
    holes = np.where(at < 1.0, np.nan, first.values)
    assert Compared(first, Curve(at, holes)).of_figure(np.nanmax) == 0.0
    assert Compared(first, Curve(np.append(at, 9.0), np.append(first.values, 3.5))).of_figure(np.nanmax) == 0.0
    assert Compared(Curve(at, 0.0 * at), Curve(at, 0.0 * at)).of_figure(np.mean) == 0.0
