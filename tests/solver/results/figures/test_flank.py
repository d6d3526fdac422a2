"""The colour scale of the pressures on the flank."""

from __future__ import annotations

import numpy as np

from evolvent.results.engagement import largest_peak
from evolvent.results.figures.flank import pressure_top
from evolvent.results.tables.figure_rows import friction_rows
from tests.support.synthetic_run import steep_run


def test_scale_reaches_the_headline() -> None:
    """Problem: the largest pressure of a spur pair is where a tip-edge zone begins, between two positions, and in none
    of their slices. Exact: the colours of 01 and 02 reach it, to a hundred MPa."""
    run = steep_run()
    headline, slices = friction_rows(run)[0].max_pressure_MPa, [each[0].cut.peak for each in run.positions]
    assert largest_peak(run, 0).at_zone_end and headline > 100.0 + np.nanmax(np.concatenate(slices))
    assert headline <= pressure_top(run, 0) < headline + 100.0
