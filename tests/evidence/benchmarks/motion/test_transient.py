"""evidence.benchmarks.motion.transient."""

from __future__ import annotations

from math import isnan

from evidence.benchmarks.motion.transient import SMALL, rows


def test_costs_of_a_small_transient() -> None:
    """A row each for both pairs' steps over positions, and one for all in all, which takes longer than any of them."""
    spur, helical, whole = rows(SMALL)
    assert spur.seconds > 0.0 and spur.below > 0.0
    assert helical.seconds < whole.seconds and helical.below < whole.seconds
    assert isnan(whole.below) and whole.found == whole.seconds
    assert "mesh periods" in whole.what
