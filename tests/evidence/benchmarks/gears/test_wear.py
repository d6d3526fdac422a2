"""The cost and the error of wear studies."""

from __future__ import annotations

from evidence.benchmarks.gears.wear import BLOCKS, SMALL_CASES, cost_rows, precision_rows


def test_wear_studies_are_timed_and_compared() -> None:
    """A coarse spur pair: twenty blocks and one sweep are timed; the tighter tolerance makes more blocks and a smaller
    error, and the volume's error is not larger than that of the depths."""
    row = next(cost_rows(SMALL_CASES))
    assert BLOCKS == 20 and min(row.prepare, row.sweep) > 0.0 and row.study > row.sweep
    loose, tight = list(precision_rows(SMALL_CASES[0], (0.2, 0.02)))[:2]
    assert loose.blocks < tight.blocks and tight.error < loose.error < 0.2
    assert abs(tight.volume_error) <= tight.error
