"""The table of docs/evidence.md on the positions of coarse companions."""

from __future__ import annotations

from pathlib import Path

import pytest

from evidence.benchmarks.accuracy.companion_positions import BARS, COSTS, BarsRow, CostRow, cases, table
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
    """A bar of 2 and 3 on a figure of 50, moved by 0.5: 4 → 6 (1) %. Without measured rows: what writes them."""
    with pytest.raises(ValueError, match=r"companion_positions` writes them"):
        table(tmp_path)
    write_rows(tmp_path / BARS, [BarsRow("Yang", "loss_percent", 0.1, 50.0, 2.0, 3.0, 0.5)])
    write_rows(tmp_path / COSTS, [CostRow("Yang", 23, 12, 6.5, 3.8)])
    said = table(tmp_path)
    assert "| loss_percent | 4 → 6 (1) |" in said and "Yang, μ = 0.1" in said
    assert said.endswith("Yang: 23 positions in 6.5 s of processor time, 12 in 3.8 s.")


def test_bars_with_half_of_the_positions_are_as_wide() -> None:
    """What was measured: no bar is narrower by more than 15 %, and two thirds of the positions at most are solved."""
    rows, costs = read_rows(DOCS / BARS, BarsRow), read_rows(DOCS / COSTS, CostRow)
    assert {row.figure for row in rows} == set(FIGURES) and len(costs) == len(list(cases()))
    assert all(row.second > 0.85 * row.every for row in rows)
    assert all(row.solved_second < 2.0 / 3.0 * row.solved for row in costs)
