"""The table of docs/evidence.md on the positions of coarse companions."""

from __future__ import annotations

from pathlib import Path

import pytest

from evidence.benchmarks.accuracy.companion_positions import (
    BARS,
    COSTS,
    HELD,
    BarsRow,
    CostRow,
    HeldRow,
    cases,
    table,
)
from evidence.benchmarks.accuracy.error_bars import FIGURES
from evidence.checkout import DOCS
from evidence.tables import read_rows, write_rows
from evolvent.gears.sweep.companion_pitch import companion_pitch
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem


def test_cases_have_companions_at_every_second_position() -> None:
    """Each case is one whose companion has half of the positions in a run."""
    for _, scene in cases():
        whole = pitch_of(scene)
        assert 2 * len(companion_pitch(whole, gear_problem(scene).is_plane).angles) == len(whole.angles)


def test_table_has_both_bars_in_per_cent(tmp_path: Path) -> None:
    """A bar of 2 and 3 on a figure of 50, moved by 0.5: 4 → 6 (1) %; bars of two figures are counted together. Without
    measured rows: what writes them."""
    with pytest.raises(ValueError, match=r"companion_positions` writes them"):
        table(tmp_path)
    write_rows(tmp_path / BARS, [BarsRow("Yang", "loss_percent", 0.1, 50.0, 2.0, 3.0, 0.5)])
    write_rows(tmp_path / COSTS, [CostRow("Yang", 23, 12, 6.5, 3.8)])
    write_rows(tmp_path / HELD, [HeldRow("loss_percent", 8, 7, 8), HeldRow("mean_pressure_MPa", 16, 16, 15)])
    said = table(tmp_path)
    assert "| loss_percent | 4 → 6 (1) |" in said and "Yang, μ = 0.1" in said
    assert "Yang: 23 positions in 6.5 s of processor time, 12 in 3.8 s." in said
    assert "Of 24 bars" in said and "23 hold the true error with all positions and 23 with every second one" in said


def test_bars_with_half_of_the_positions_are_as_wide() -> None:
    """What was measured: no bar is narrower by more than 15 %, of no figure do fewer hold the true error, and at most
    two thirds of the positions are solved."""
    rows, costs = read_rows(DOCS / BARS, BarsRow), read_rows(DOCS / COSTS, CostRow)
    assert {row.figure for row in rows} == set(FIGURES) and len(costs) == len(list(cases()))
    assert all(row.second > 0.85 * row.every for row in rows)
    held = read_rows(DOCS / HELD, HeldRow)
    assert {row.figure for row in held} == set(FIGURES) and all(row.second >= row.every for row in held)
    assert all(row.solved_second < 2.0 / 3.0 * row.solved for row in costs)
