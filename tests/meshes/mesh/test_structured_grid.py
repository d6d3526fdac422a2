"""Structured grids: cell sizes along a graded line."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.structured_grid import graded_ends


def test_graded_cells_grow_by_at_most_the_given_ratio() -> None:
    """Cells of 1 up to 3, then at most 1.5 times the last, ending at 20 exactly."""
    sizes = np.diff(graded_ends(20, 1, 3, 1.5))
    np.testing.assert_allclose(sizes[:3], 1)
    assert (sizes[1:] / sizes[:-1]).max() <= 1.5 + 1e-12
    assert sizes.sum() == pytest.approx(20)
    with pytest.raises(MeshError, match="fine < length"):
        graded_ends(2, 1, 3)
