"""The picture of a start from rest, from rows with known curves."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.figures.transient_start import start_figure
from evolvent.dynamics.results.transient.beginning import StartRow

TIMES = (0.001, 0.002, 0.003, 0.004)


def row(speed: float, friction: float, time: float) -> StartRow:
    """The force falls from twice the load to none, in steps of half a load; the error is 10 µm a millisecond."""
    force = 100.0 * (2.0 - 500.0 * (time - 0.001))
    return StartRow(speed, friction, time, 1.0, 1e4 * time, 1.0, 5.0, force, 10.0, 100.0, 7.0 * force, 50.0, 700.0)


def rows(frictions: tuple[float, ...] = (0.0, 0.1)) -> list[StartRow]:
    return [row(speed, μ, time) for speed in (100.0, 200.0) for μ in frictions for time in TIMES]


def test_curves_are_those_of_the_rows() -> None:
    """A line of three panels for each speed; a solid and a dashed curve for each coefficient. The force begins with
    none at t = 0, where the other two are not known; time is in ms, the force over the load."""
    panels = start_figure("pair", rows()).axes
    assert len(panels) == 6
    force, error, pressure = panels[:3]
    moving, still, *_ = force.lines
    np.testing.assert_allclose(moving.get_xdata(), [0.0, 1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(moving.get_ydata(), [0.0, 2.0, 1.5, 1.0, 0.5])
    np.testing.assert_allclose(np.asarray(still.get_ydata(), float)[1:], 1.0)
    np.testing.assert_allclose(error.lines[0].get_ydata(), [np.nan, 10.0, 20.0, 30.0, 40.0])
    assert pressure.get_ylim()[0] == force.get_ylim()[0] == 0.0


@pytest.mark.parametrize(("frictions", "bands"), [((0.0, 0.1), 2), ((0.0, 0.1, 0.2), 0)])
def test_bands_of_few_coefficients(frictions: tuple[float, ...], bands: int) -> None:
    """Error bars are drawn for up to two coefficients: more would hide each other."""
    assert len(start_figure("pair", rows(frictions)).axes[0].collections) == bands
