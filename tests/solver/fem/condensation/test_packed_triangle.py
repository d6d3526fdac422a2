"""The triangle in strips against the same sums and products of whole matrices."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.condensation.packed_triangle import HEIGHT, PackedTriangle
from evolvent_meshes.arrays import Floats


def square_of(triangle: PackedTriangle) -> Floats:
    """The upper triangle as a square, zero below."""
    square = np.zeros((triangle.size, triangle.size))
    for start, strip in zip(triangle.starts, triangle.strips):
        square[start : start + len(strip), start:] = strip
    return np.triu(square)


@pytest.mark.parametrize("size", [0, 1, HEIGHT, 2 * HEIGHT + 7])
def test_packed_triangle_minus_a_product(size: int) -> None:
    """0 − HᵀH of a random H (9 × n), for sizes within, at and beyond strips' ends; exact: the same by NumPy."""
    half = np.random.default_rng(1).standard_normal((9, size))
    triangle = PackedTriangle.zeros(size, lambda rows, columns: np.full((rows, columns), np.nan))
    triangle.subtract_product(half)
    assert np.allclose(square_of(triangle), np.triu(-half.T @ half), rtol=0.0, atol=1e-12)


def test_packed_triangle_is_added_to_a_front() -> None:
    """A random symmetric U (n = 1400) is added to the front [ss so; oo] of 300 + 2000 rows at random places: the first
    rows to ss and so, the others to oo. Exact: front[places, places] += U of whole matrices. Strips end at different
    rows of U and of oo, so no run may be added to the wrong strip."""
    rng, separator, outer, count = np.random.default_rng(2), 300, 2000, 1400
    places = np.sort(rng.choice(separator + outer, count, replace=False))
    U = rng.standard_normal((count, count))
    front = np.zeros((separator + outer, separator + outer))
    front[np.ix_(places, places)] += np.triu(U)
    ss, so = np.zeros((separator, separator)), np.zeros((separator, outer))
    oo = PackedTriangle.zeros(outer, lambda rows, columns: np.empty((rows, columns)))
    update, split = PackedTriangle.view(U), int(np.searchsorted(places, separator))
    update.add_leading(ss, so, places[:split], places[split:] - separator)
    update.add_trailing(oo, places[split:] - separator)
    assert np.array_equal(np.triu(ss), front[:separator, :separator])
    assert np.array_equal(so, front[:separator, separator:])
    assert np.array_equal(square_of(oo), front[separator:, separator:])


def test_packed_triangle_within_a_square_is_a_view() -> None:
    """What is subtracted from a triangle within a square is in the square."""
    square = np.zeros((HEIGHT + 1, HEIGHT + 1))
    PackedTriangle.view(square).subtract_product(np.ones((1, HEIGHT + 1)))
    assert np.all(np.triu(square) == np.triu(-np.ones_like(square)))
