"""Strips of patches: what is left out at their rims, and which patches of the symmetric part are alike. Exact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent.gears.two_level.symmetric_strips import Strip, symmetric_strips


def strip(levels: int, rows: int) -> Strip:
    """Forces on 2 × 2 nodes move levels × rows of them, about the middle."""
    change = np.random.default_rng(levels).normal(size=(12, 3 * levels * rows))
    return Strip(change, (2, 2), (levels, rows), (4, 4), (4 - (levels - 2) // 2, 4 - (rows - 2) // 2), 6)


def test_small_displacements_at_the_rim_are_left_out() -> None:
    """A strip whose outer level and two outer rows hardly move loses them, and nothing else."""
    whole = strip(6, 5)
    change = whole.change.reshape(-1, 6, 5, 3)
    change[:, 0], change[:, :, -2:] = 1e-6 * change[:, 0], 1e-6 * change[:, :, -2:]
    found = whole.trimmed(1e-3)
    assert found.moved == (5, 3) and found.start == (whole.start[0] + 1, whole.start[1])
    assert np.array_equal(found.change, change[:, 1:, :-2].reshape(len(change), -1))
    assert whole.trimmed(0.0).moved == (6, 5)


def test_patches_with_the_same_neighbours_are_alike() -> None:
    """Patches that move the levels next to theirs: of six, the first and the last lack a neighbour, and four share one
    matrix. It is symmetric between a patch and the next, and rows that only the forces on it move have half of D."""
    whole = strip(4, 4)
    first, inner, last = symmetric_strips([whole], 2)
    assert [each.layers for each in (first, inner, last)] == [1, 4, 1]
    assert inner.moved == (6, 4) and first.moved == (5, 4)
    S = inner.blocks()
    D = whole.blocks()
    up, down = S[:, :, :, 4:, 1:3], S[:, :, :, :2, 1:3]
    assert np.allclose(up, np.transpose(down, (3, 4, 5, 0, 1, 2)), rtol=1e-6)
    assert np.allclose(S[:, :, :, 1:5, 0], 0.5 * D[:, :, :, :, 0], rtol=1e-6)
    own = D[:, :, :, 1:3, 1:3]
    assert np.allclose(S[:, :, :, 2:4, 1:3], 0.5 * (own + np.transpose(own, (3, 4, 5, 0, 1, 2))), atol=1e-6)


def test_a_single_patch_keeps_its_place() -> None:
    """Alone, the symmetric part of the forces on a patch has its own size and half of what moves around it."""
    alone = replace(strip(4, 4), layers=1)
    (found,) = symmetric_strips([alone], 2)
    assert (found.source, found.start, found.moved) == (alone.source, alone.start, alone.moved)
    assert found.change.dtype == np.float32
