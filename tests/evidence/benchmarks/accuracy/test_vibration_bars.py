"""Bars against true errors of the vibration, of runs that are made up."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.benchmarks.accuracy.vibration_bars import FIGURES, Swept, hit_rows
from evolvent_meshes.arrays import Floats

SPEEDS = np.arange(1000.0, 1010.0)


def made(values: Floats, bar: float, jumps: tuple[float, ...]) -> Swept:
    """Ten speeds, both figures alike."""
    columns = {"speed_rpm": SPEEDS}
    for figure in FIGURES:
        columns |= {figure: values, f"{figure}_error": np.full(len(SPEEDS), bar)}
    return Swept(columns, np.array(jumps))


def test_rows_beside_jumps_count_apart() -> None:
    """Off by 0.1 and, in the last three rows and in one beside a jump at 1002 r/min, by 0.3; bars of 0.2: five rows lie
    within two steps of the jump, one of them outside its bar; of the others two are inside."""
    best = np.full(10, 1.0)
    tried = best + np.where(np.isin(np.arange(10), (2, 7, 8, 9)), 0.3, 0.1)
    rows = list(hit_rows("", 20, made(tried, 0.2, ()), made(best, np.nan, (1002.0,))))
    assert [row.figure for row in rows] == list(FIGURES)
    assert {(row.away, row.beside) for row in rows} == {("2 of 5", "4 of 5")}
    assert rows[0].median_error == pytest.approx(0.3 / 1.3)
