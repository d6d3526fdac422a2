"""Memory that gears with flanks in levels are told to want, against what whole runs of the benchmark took."""

from __future__ import annotations

import pytest

from evidence.benchmarks.gears.whole_runs import FULL, RANKS, RunRow
from evidence.tables import read_rows
from evolvent.check.problem_size import memory_megabytes
from evolvent.scene.scene import load_scene
from tests.support.checkout import ROOT

RUNS = [each for each in read_rows(ROOT / "docs/benchmark/runs.csv", RunRow) if each.flank_dofs and not each.error_bars]


@pytest.mark.parametrize("measured", RUNS, ids=lambda row: f"{row.case}, {row.level}")
def test_memory_estimate_of_flanks_in_levels_on_two_ranks(measured: RunRow) -> None:
    """From 10 % below to 40 % above what plain runs took, all ranks together (docs/benchmark.md, whole runs): the
    largest patches of both gears are taken to be condensed at once, which they seldom are."""
    (case,) = (each for each in FULL if (each.name, each.level) == (measured.case, measured.level))
    scene = load_scene(ROOT / case.scene, [*case.settings, f"mesh.level={case.level}"])
    assert 0.9 * measured.memory_MB < memory_megabytes(scene, RANKS) < 1.4 * measured.memory_MB
