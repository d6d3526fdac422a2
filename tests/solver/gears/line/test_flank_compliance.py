"""Shape functions on the lattice of a flank."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.line.flank_compliance import quadratic_shapes


def test_shapes_reproduce_the_grid() -> None:
    """Problem: cells whose middle nodes are not midway. Exact: shape functions sum to 1, reproduce the coordinate, and
    are 1 at their node."""
    grid = np.array([0.0, 0.45, 1.0, 1.6, 2.0])
    at = np.linspace(0.0, 2.0, 41)
    nodes, values = quadratic_shapes(grid, at)
    assert values.sum(axis=1) == pytest.approx(1.0)
    assert (values * grid[nodes]).sum(axis=1) == pytest.approx(at)
    nodes, values = quadratic_shapes(grid, grid)
    assert np.abs(values[nodes == np.arange(5)[:, None]]).max() == pytest.approx(1.0)
    assert np.sort(np.abs(values), axis=1)[:, :2] == pytest.approx(0.0, abs=1e-12)
