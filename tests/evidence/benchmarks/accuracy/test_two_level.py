"""Flanks with levels of their own beside the same cells and beside Hertz: the comparisons, on small pairs."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from evidence.benchmarks.accuracy.same_cells import fine_nodes, split_sector
from evidence.benchmarks.accuracy.slice_peaks import SlicePeaks
from evidence.benchmarks.accuracy.two_level import (
    TINY,
    AccuracyRow,
    difference_rows,
    left_out,
    random_cases,
    yang_case,
)
from evidence.tables import write_rows
from evolvent.gears.meshing.flank_levels import levelled_sector
from evolvent.gears.meshing.levelled_meshes import is_two_level, levelled_mesh
from evolvent.gears.problem.gear_problem import MeshSettings
from evolvent.gears.two_level.flank_refinement import FlankRefinement
from evolvent_meshes.gears.member import Member

NARROW = yang_case(MeshSettings("standard"), 2.8, (0.0,))


def test_split_sector_has_the_cells_of_the_levels() -> None:
    """Two levels: all nodes of the cells below the finest flank are nodes of the sector that is split everywhere."""
    problem, member = NARROW.problem, Member.PINION
    levels = levelled_sector(problem, member)
    refinement = FlankRefinement(
        problem.pair.pinion, levelled_mesh(problem, member).mesh, problem.materials[0], levels.levels
    )
    finest = list(refinement.bodies())[-1].fine
    whole = split_sector(problem, member)
    assert len(levels.levels) == 2 and len(np.unique(whole.facets["flank"])) == fine_nodes(levels)
    assert cKDTree(whole.points).query(finest.mesh.points)[0].max() < 1e-9


def test_random_pairs_are_helical_and_small() -> None:
    """The same ones each time."""
    first, second = list(random_cases(2)), list(random_cases(2))
    assert [case.name for case in first] == [case.name for case in second] and first[0].name != first[1].name
    for case in first:
        assert is_two_level(case.problem) and case.problem.pair.pinion.base_helix_angle > 0.0
        assert fine_nodes(levelled_sector(case.problem, Member.WHEEL)) <= 3_000


def test_slices_are_compared_place_by_place() -> None:
    """Slices that only one of two pitches has are left out; errors are relative to the other's peaks."""

    def peaks(places: list[tuple[int, int, float]], values: list[float]) -> SlicePeaks:
        array = np.array(values)
        return SlicePeaks(places, array, array, np.array([z > 0.0 for _, _, z in places]))

    own = peaks([(0, 0, -1.0), (0, 1, -1.0), (1, 0, 1.0)], [101.0, 500.0, 196.0])
    other = peaks([(1, 0, 1.0), (0, 0, -1.0), (1, 0, 2.0)], [200.0, 100.0, 900.0])
    error, near_end = own.differences(other)
    assert error == pytest.approx([0.01, 0.02]) and near_end.tolist() == [False, True]
    assert AccuracyRow("a", "b", 0.01, math.nan).met and not AccuracyRow("a", "b", 0.01, 0.005).met


@pytest.mark.evidence
@pytest.mark.slow
def test_levels_are_compared_with_the_same_cells() -> None:
    """A narrow, coarse pair with crowning, relief and misalignment: all that is measured is there, and the peaks are
    within their bars."""
    found = list(difference_rows(TINY))
    named = {row.what.split(":")[0] for row in found}
    assert named == {
        "peak-to-peak transmission error", "mean transmission error", "load sharing, of the load", "peaks",
        "peaks beside face ends",
    }
    assert all(row.met for row in found if row.what.startswith(("peaks", "load", "mean")))
    assert next(row.figure for row in found if row.what.startswith("mean")) < 1e-3


def test_page_names_the_case_that_is_furthest_off(tmp_path: Path) -> None:
    """Differences of 1, 2, 3 and 9 %: the median is 2.5 %; all but two within 2 %, all but one within 3 %; other rows
    of a case do not count."""
    percents = {"a": 3.0, "b": 9.0, "c": 1.0, "d": 2.0}
    whats = "peak-to-peak transmission error", "load sharing, of the load", "peaks: nine in ten of 5", "peaks: all of 5"
    rows = [AccuracyRow(case, what, 0.01 * off, math.nan) for case, off in percents.items() for what in whats]
    rows += [AccuracyRow("a", what, 0.99, math.nan) for what in ("mean transmission error", "peaks beside face ends")]
    (tmp_path / "benchmark").mkdir()
    write_rows(tmp_path / "benchmark" / "two_level.csv", rows)
    lines = left_out(tmp_path).splitlines()
    assert len(lines) == 6 and "median of 4 cases" in lines[0]
    assert all(line.endswith("| 2.5 | 2 | 3 | 9 | b |") for line in lines[2:])


def test_page_wants_what_was_measured(tmp_path: Path) -> None:
    """No rows, no table."""
    with pytest.raises(ValueError, match="wanted 'peak-to-peak transmission error' of three cases, found 0"):
        left_out(tmp_path)
