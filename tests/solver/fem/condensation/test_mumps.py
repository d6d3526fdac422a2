"""The parts of the interface to MUMPS that need no factorisation; its results are tested with the compliance."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from evolvent.fem.condensation.mumps import fill_symmetric, upper_triangle


def test_lower_triangle_is_filled_from_the_upper_one() -> None:
    """The lower triangle becomes the upper one, also where the last tile is cut off."""
    matrix = np.triu(np.arange(49.0).reshape(7, 7))
    exact = matrix + np.triu(matrix, 1).T
    fill_symmetric(matrix, tile=3)
    assert np.array_equal(matrix, exact)


def test_upper_triangle_of_unsorted_rows() -> None:
    """[1 2 3; 4 5 6] with columns in another order, those with the number -1 left out: [1 2 3; 0 5 0]. Exact."""
    rows = np.array([3.0, 1.0, 2.0, 6.0, 5.0, 4.0]), np.array([2, 0, 1, -1, 1, 0]), np.array([0, 3, 6])
    found = upper_triangle(sp.csr_matrix(rows, shape=(2, 3)))
    assert np.array_equal(found.toarray(), [[1.0, 2.0, 3.0], [0.0, 5.0, 0.0]]) and found.nnz == 4
