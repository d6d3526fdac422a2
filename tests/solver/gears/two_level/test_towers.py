"""Corrections of a flank: which cells have patches, and what congruence and interpolation change.

Yang's pinion, 3 mm wide, 24 × 6 coarse cells on the flank, twice as long along the face as along the profile, that are
split in depth; Nitsche's functionals on the fine cells.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.fem.material import STEEL
from evolvent.gears.meshing.flank_levels import FlankLevel
from evolvent.gears.two_level import towers
from evolvent.gears.two_level.flank_refinement import HELD, coarse_body
from evolvent.gears.two_level.strips import StripCorrection
from evolvent.gears.two_level.towers import Axis, Towers
from evolvent_meshes.arrays import Floats
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.sector_cases import gear_and_start


def along(sizes: list[float], reach: float, samples: int) -> Axis:
    """Cells of these sizes [mm]."""
    x = np.concatenate([[0.0], np.cumsum(sizes)])
    return Axis.of(np.column_stack([x, 0 * x, 0 * x]), reach, samples)


def test_cells_near_the_ends_have_their_own_patches() -> None:
    """Twenty cells, two within reach of each other: three at each end; of the 14 between, the middle one stands for all
    layers, and four, closer near both ends, for all rows. Where one patch of all costs less, it is one.
    Exact."""
    layers, rows, few = along(20 * [1.0], 1.1, 1), along(20 * [1.0], 1.1, 4), along(8 * [1.0], 1.1, 4)
    assert layers.own == [range(3), range(17, 20)] and layers.sampled == [10]
    assert rows.own == layers.own and rows.sampled == [3, 6, 13, 16]
    assert few.own == [range(8)] and len(few.between) == 0 and few.sampled == []
    assert along(9 * [1.0], 1.1, 1).own == [range(3), range(6, 9)] and along(9 * [1.0], 1.1, 1).sampled == [4]
    assert along(7 * [1.0], 1.1, 1).own == [range(7)]


def test_cells_within_reach_are_counted_by_their_length() -> None:
    """Cells of 1 mm, then of 0.5 mm, patches that extend by 1.1 mm: two large ones or three small ones lie within
    reach. Exact."""
    axis = along(8 * [1.0] + 12 * [0.5], 1.1, 3)
    assert axis.own == [range(3), range(16, 20)]
    assert axis.extent([4]) == (2, 2) and axis.extent([6]) == (2, 2) and axis.extent([7, 14]) == (3, 3)
    assert axis.extent(axis.between) == (3, 3)


def test_patches_between_the_blocks_fit_on_the_flank() -> None:
    """Cells of 1 mm, then of 0.3 mm: the end is within reach of three at the first end, but patches about the small
    ones have four below. Exact."""
    axis = along(8 * [1.0] + 12 * [0.3], 1.1, 3)
    assert axis.extent(axis.between) == (4, 4) and axis.own == [range(4), range(15, 20)]


def correction() -> StripCorrection:
    """Of all patches."""
    gear, start = gear_and_start("yang pinion")
    gear = replace(gear, face_width=3.0)
    resolution = SectorResolution(
        profile_elements=24, face_elements=6, end_size_ratio=1.0, flank_start_diameter=start,
        layer_depths=(0.2, 0.25, 0.285),
    )  # fmt: skip
    body = coarse_body(gear, sector_mesh(gear, resolution), STEEL, FlankLevel(1, 1, (2, 1, 1)))
    flank = Towers(body, gear.base_radius, gear.twist, HELD, 2.0)
    return flank.correction({patch.block: flank.response(patch) for patch in flank.patches()})


@pytest.mark.slow
def test_shared_and_interpolated_responses_are_those_of_one_large_patch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Against one patch that is all of the tooth: the largest difference is below 1.5 % of the largest correction.
    Patches near the edges, shared along the face and interpolated along the profile all take part."""
    found = correction()
    monkeypatch.setattr(towers, "REACH", 50.0)
    exact = correction()
    D, C = matrix(found), matrix(exact)
    assert len({strip.moved for strip in found.strips}) > 5
    assert np.abs(D - C).max() < 0.015 * np.abs(C).max()


def matrix(correction: StripCorrection) -> Floats:
    """Columns under unit forces."""
    whole = correction.among([np.arange(correction.size)])
    return np.array([whole.times(f.reshape(-1, 3)).ravel() for f in np.eye(3 * correction.size)])
