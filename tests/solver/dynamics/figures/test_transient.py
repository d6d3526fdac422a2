"""The picture of a transient: three panels a speed, on a mesh force of 1000 (1 + 0.5 sin) N ± 800 N."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import PolyCollection

from evolvent.dynamics.figures.transient import transient_figure
from tests.support.running.transient_tables import COUNT, LOAD, PITCH, transient_tables

FORCE, PRESSURE = 1, 2


def panels(*speeds: float) -> list:  # type: ignore[type-arg]
    tables = transient_tables(speeds or (1500.0,))
    figure = transient_figure("a pair", tables.rows, tables.teeth, tables.facts)
    figure.draw_without_rendering()
    return figure.axes


def test_mesh_force_stands_beside_the_load() -> None:
    """The curve over two pitches has 17 points and ends as it begins; the dashed line is the load without inertia."""
    axes = panels()[FORCE]
    assert axes.get_ylabel() == "mesh force [N]"
    (force,) = (line for line in axes.lines if len(line.get_xdata()) == 2 * COUNT + 1)
    assert force.get_xdata()[-1] == pytest.approx(2.0 * PITCH)
    assert force.get_ydata()[[0, COUNT, -1]] == pytest.approx([LOAD] * 3)
    assert force.get_ydata()[2] == pytest.approx(1.5 * LOAD)
    assert [LOAD, LOAD] in [list(line.get_ydata()) for line in axes.lines if line.get_linestyle() == "--"]


def test_bands_of_forces_and_pressures_end_at_zero() -> None:
    """500 N ± 800 N reach from 0 to 1300 N, 50 ± 80 MPa from 0 to 130 MPa; the panels begin at 0."""
    for axes, scale in zip(panels()[FORCE:], (1.0, 0.1)):
        (band,) = (each for each in axes.collections if isinstance(each, PolyCollection))
        heights = np.concatenate([path.vertices[:, 1] for path in band.get_paths()])
        assert (heights.min(), heights.max()) == pytest.approx((0.0, 2300.0 * scale))
        assert axes.get_ylim()[0] == 0.0


def test_no_legend_lies_on_a_panel() -> None:
    """Two speeds: the only legend is that of the sheet, above all panels."""
    axes = panels(1500.0, 3000.0)
    assert len(axes) == 6 and not any(each.get_legend() for each in axes)
    (legend,) = axes[0].figure.legends
    assert legend.get_window_extent().y0 > max(each.get_window_extent().y1 for each in axes)
