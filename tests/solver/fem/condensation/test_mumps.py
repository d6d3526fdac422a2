"""The parts of the interface to MUMPS that need no factorisation; its results are tested with the compliance."""

from __future__ import annotations

import numpy as np

from evolvent.fem.condensation.mumps import fill_symmetric


def test_lower_triangle_is_filled_from_the_upper_one() -> None:
    """The lower triangle becomes the upper one, also where the last tile is cut off."""
    matrix = np.triu(np.arange(49.0).reshape(7, 7))
    exact = matrix + np.triu(matrix, 1).T
    fill_symmetric(matrix, tile=3)
    assert np.array_equal(matrix, exact)
