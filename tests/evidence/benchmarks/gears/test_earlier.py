"""An earlier commit beside this one: the order of the runs, what the cache holds before each, and the verdict."""

from __future__ import annotations

from dataclasses import replace
from math import nan
from pathlib import Path
from typing import Any

import pytest

from evidence.benchmarks.gears import earlier
from evidence.benchmarks.gears.earlier import CASES, EarlierCase, EarlierRow, Program
from evidence.processes import Cost

ROW = EarlierRow("a", "standard", 1, "abc", 300.0, 5e3, 100.0, 2.9e3, 50.0, 1e3, 2.0, 0.0, 3.0, 3e3, 5.9)


@pytest.mark.parametrize(
    ("row", "met"),
    [
        (ROW, True),
        (replace(ROW, empty_seconds=101.0), False),
        (replace(ROW, filled_seconds=51.0), False),
        (replace(ROW, empty_MB=3.1e3), False),
        (replace(ROW, filled_MB=3.1e3), False),
        (replace(ROW, filled_seconds=99.0, filled_MB=9e3, least_filled_ratio=nan, memory_bar_MB=nan), True),
    ],
)
def test_bars(row: EarlierRow, met: bool) -> None:
    """300 s over 100 s and 50 s are ratios of 3 and 6; bars of nan are none."""
    assert row.met is met


def test_each_scene_is_run_before_on_an_empty_cache_and_on_a_filled_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first run of this commit keeps an entry, which is there in its second run and gone before the next scene;
    compiled forms stay. Transmission errors of 2.5 µm before and 2 µm now are 0.5 µm apart."""
    found: list[tuple[str, int, int]] = []

    def run(self: Program, out: Path, case: EarlierCase, *settings: str) -> tuple[Cost, dict[str, Any]]:
        entries, forms = self.cache / "evolvent" / "condensed", self.cache / "fenics"
        for folder in (entries, forms):
            folder.mkdir(parents=True, exist_ok=True)
        found.append((out.name, len(list(entries.iterdir())), len(list(forms.iterdir()))))
        (entries / "entry").touch()
        (forms / "form").touch()
        error = 2.5 if self.root == checkout else 2.0
        return Cost(1.0, 1.0, 10.0), {"frictions": [{"transmission_error_peak_to_peak_um": error}]}

    checkout = tmp_path / "checkout"
    monkeypatch.setattr(Program, "commit", "abc")
    monkeypatch.setattr(Program, "run", run)
    measured = list(earlier.rows(CASES[:2], checkout, tmp_path))
    assert found[2:] == [
        ("0_before", 1, 1), ("0_empty", 0, 1), ("0_filled", 1, 1),
        ("1_before", 1, 1), ("1_empty", 0, 1), ("1_filled", 1, 1),
    ]
    assert [row.peak_to_peak_off_um for row in measured] == [0.5, 0.5]
