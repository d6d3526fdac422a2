"""Coarse cells along a line: which have patches of their own."""

from __future__ import annotations

import numpy as np

from evolvent.gears.two_level.coarse_axis import Axis


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


def test_sampled_cells_beside_the_blocks_share_their_patches() -> None:
    """Twenty cells of which 3, 6, 13 and 16 are sampled: 3 and 16 are loaded with the three beside them at each end.
    The middle layer is beside no block. Of two cells between the blocks each goes to one. Exact."""
    rows, layers, few = along(20 * [1.0], 1.1, 4), along(20 * [1.0], 1.1, 1), along(8 * [1.0], 1.1, 4)
    assert rows.loaded == [range(4), range(16, 20), range(6, 7), range(13, 14)]
    assert layers.loaded == [range(3), range(17, 20), range(10, 11)]
    assert few.loaded == [range(8)]
    two = along(8 * [1.0], 1.1, 2)
    assert two.own == [range(3), range(5, 8)] and two.loaded == [range(4), range(4, 8)]
