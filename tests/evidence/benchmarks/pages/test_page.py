"""The page says what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from evidence.benchmarks.accuracy.error_bars import BarRow
from evidence.benchmarks.accuracy.excitation_bars import ExcitationRow
from evidence.benchmarks.accuracy.root_bars import RootBarRow
from evidence.benchmarks.accuracy.two_level import AccuracyRow
from evidence.benchmarks.comparison.work_precision import Row
from evidence.benchmarks.gears.earlier import EarlierPitchRow, EarlierRow
from evidence.benchmarks.gears.pitch_precision import PitchRow
from evidence.benchmarks.gears.plane_and_solid import SpurRow
from evidence.benchmarks.gears.profile import ProfileRow
from evidence.benchmarks.gears.skips import SkipRow
from evidence.benchmarks.gears.wear import WearCostRow, WearPrecisionRow
from evidence.benchmarks.gears.whole_runs import RunCase, RunRow, failed
from evidence.benchmarks.motion.motion_row import MotionRow
from evidence.benchmarks.pages.comparison import advantage, unmatched
from evidence.benchmarks.pages.page import write_page
from evidence.report import header, machine
from evidence.tables import read_rows, write_rows

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def test_an_advantage_counts_only_at_no_larger_error(tmp_path: Path) -> None:
    """Evolvent's fast but coarse row may not beat a peer's better one; a peer that nobody matches is said so; rows
    survive their file."""

    def row(program: str, seconds: float, error: float, dofs: int = 50_000) -> Row:
        return Row("c", program, "quadrilateral", 2, 8, dofs, cpu=seconds, profile_error=error)

    rows = [row("Evolvent", 1.0, 0.05), row("Evolvent", 4.0, 0.01), row("GetFEM", 6.0, 0.02), row("GetFEM", 2.0, 0.06)]
    assert [ratio for *_, ratio in advantage(rows, 20_000)] == [1.5, 2.0]
    assert unmatched([*rows, row("Kratos", 9.0, 0.001)], 20_000)[0].program == "Kratos"
    assert not advantage([row("Evolvent", 1.0, 0.05), row("GetFEM", 6.0, 0.05, 10_000)], 20_000)
    write_rows(tmp_path / "rows.csv", rows)
    assert [r.cpu for r in read_rows(tmp_path / "rows.csv", Row)] == [1.0, 4.0, 6.0, 2.0]


def test_the_page_says_what_was_measured(tmp_path: Path) -> None:
    """Rows of every kind, in and out of their bars: the page holds ratios of the rows (30/10, 25/1, one of two inside),
    names the skip beyond its tolerance, and leaves out what was not measured."""
    nan = float("nan")
    rows: dict[str, Sequence[DataclassInstance]] = {
        "skips": [SkipRow("plane", "demos/a.toml", "", 10.0, 30.0, 100.0, 250.0, 1e-5, 1e-3),
                  SkipRow("window", "demos/a.toml", "", 10.0, 11.0, 100.0, 100.0, 1e-2, 1e-3)],
        "spur": [SpurRow(1.0, 0, 1.0, 100.0, 0.003, 1.0, 3, 25.0, 900.0, 0.002)],
        "bars": [BarRow("a", "peak", 0.1, 100.0, 2.0, 1.0, 0.1), BarRow("b", "peak", 0.1, 100.0, 2.0, 3.0, 0.1)],
        "excitation_bars": [
            ExcitationRow("a", "2, hexahedron, 3", 5.0, name, "positions", 20, 19, 12, 11, error, 0.03, 0.001)
            for name, error in (("transmission_error_um", 0.012), ("tangent_stiffness_N_per_um", 0.025))
        ],
        "root_bars": [
            RootBarRow("a", "2, hexahedron, 3", 2, 0.1, "pinion", side, 200.0, 3.0, error, 0.1, 50, 47, 40, 38)
            for side, error in (("tension", 2.0), ("pressure", 4.0))
        ],
        "dynamics": [MotionRow("speeds", 12.0, nan, 10.0), MotionRow("torques", 30.0, 20.0, 2.0)],
        "transient": [MotionRow("a step over a position", 1.0, 2.0, 1.5)],
        "two_level": [AccuracyRow("a", "peaks", 0.0042, 0.005), AccuracyRow("a", "sharing", 0.002, 0.001),
                      AccuracyRow("a", "mean", 0.001, nan)],
        "runs": [RunRow("long", "fine", 1, 10, 20, 5.0, 6.0, 0.0, 1.0, 12.0, 10.0, 300.0, nan, 8.0),
                 failed(RunCase("hung", "b.toml", "quick", ()), "ended after 9 s")],
        "earlier": [
            EarlierRow(
                "both", "fine", 1, "abcdef0", "bcdef01", 400.0, 9e3, 100.0, 2e3, 50.0, 1e3, 2.0, -0.1, 3.0, 3e3, 9.0
            )
        ],
        "earlier_pitches": [EarlierPitchRow(0.8, 20, "abcdef0", "bcdef01", 90.0, 900.0, 0.01, 30.0, 800.0, 0.005)],
        "wear_cost": [WearCostRow("spur", 1000, 1.0, 2.0, 8.0), WearCostRow("helical", 1000, 9.0, 1.0, 8.0)],
        "wear": [WearPrecisionRow("implicit", 0.05, 10, 0, 2.0, 0.02, -0.01),
                 WearPrecisionRow("explicit", 0.05, 30, 2, 4.0, 0.001, 0.001)],
        "profile": [ProfileRow("search", 1000, 4, 2.0, 0.25, 4), ProfileRow("everything else", 1000, 4, 6.0, 0.75, 1)],
        "profile_levels": [ProfileRow("patches", 1000, 4, 8.0, 1.0, 40)],
        "pitches": [PitchRow("hexahedron", 2, 1, "one mesh", 0.5, 1000, 4, 5.0, 9.0, 14.0, 300.0, 0.01, 0.001),
                    PitchRow("hexahedron", 1, 1, "levels", 0.7, 0, 0, nan, nan, nan, nan, nan, nan, "killed")],
    }
    for name, own in rows.items():
        write_rows(tmp_path / "benchmark" / f"{name}.csv", own)
    text = write_page(tmp_path).read_text(encoding="utf-8")
    for wanted in ("**3.00**", "Beyond their tolerance: window.", "**25.0**", "**1 of 2** figures",
                   "**38 of 40** figures", "| a, 5 % of the torque | 40 | 38 | 95 | 24 | 22 |",
                   "| a | 2, hexahedron, 3 | 1.20 (0.10) | 2.50 (0.10) |", "75.0", "14",
                   "**1 of 2** largest tensions and compressions", "94 of 100 stresses",
                   "| tension | 1 | 1 | 100 | 1 | 1 | 1.00 | 1.00 | 1.50 | 94 |",
                   "| speeds | 12 |  | **12** | at most 10 | MISSED |",
                   "| torques | 30 | 20 | **1.5** | at most 2 | met |",
                   "| a step over a position | 1 | 2 | **0.5** | at most 1.5 | met |",
                   "killed", "**3.00**", "8.00", "whole met, bare missed", "**1 of 2** bars are met",
                   "| a | sharing | 0.20 | 0.1 | MISSED |", "| a | mean | 0.10 |  |  |",
                   "Commits abcdef0 (*before*) and bcdef01 (*now*)",
                   "| **4.0** | 3 | 50 | **8.0** | 9 | 2.000 | -0.100 | MISSED |",
                   "| 0.8 | 90 | 900 | +1.00 | 30 | 800 | +0.50 | **3.0** |",
                   "| long | fine | 1 | 30 | 5 | 6 | 0 | 1 | 12 | 10 | 300 |  | 8.0 |  | MISSED |", "ended after 9 s"):
        assert wanted in text
    for figure in ("pitches", "earlier_pitches"):
        assert (tmp_path / f"pictures/benchmark/{figure}.png").stat().st_size > 10_000
    assert "Cylinder on block" not in text


def test_a_page_that_is_written_again_keeps_the_machine_that_measured(tmp_path: Path) -> None:
    """Problem: a page by another machine, written again from kept tables. Exact: its header stays as it is; after a
    measurement it names this machine."""
    (tmp_path / "benchmark").mkdir()
    other = header("Benchmarks", "a command").replace(machine(), "another machine")
    page = write_page(tmp_path, measured=False)
    assert machine() in page.read_text(encoding="utf-8")
    page.write_text(f"{other}\n\nold text\n", encoding="utf-8")
    text = write_page(tmp_path, measured=False).read_text(encoding="utf-8")
    assert text.startswith(f"{other}\n") and "old text" not in text
    assert machine() in write_page(tmp_path).read_text(encoding="utf-8")
