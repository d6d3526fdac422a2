"""Counts by which the cells below a contact surface are split."""

from __future__ import annotations

import numpy as np

from evolvent.contact.two_level.split_counts import split_counts
from evolvent_meshes.mesh.splitting import split
from evolvent_meshes.shapes.blocks import box


def test_cells_are_split_along_the_surface_and_less_with_depth() -> None:
    """2 × 1 × 3 cells below the top: 3 and 2 along it in all depths, then 4, 2 and 1 in depth. The split top has
    6 × 2 facets, and the levels of nodes lie where these counts put them. Exact."""
    mesh = box((2.0, 1.0, 3.0), (2, 1, 3))
    along = np.tile([3, 2, 9], (len(mesh.cells), 1))
    fine = split(mesh, split_counts(mesh, "top", along, (4, 2))).mesh
    assert len(fine.facets["top"]) == 12 and len(fine.cells) == 6 * 2 * 7
    ends = np.unique(np.round(fine.points[fine.cells[:, :8], 2], 9))
    assert ends.tolist() == [0.0, 1.0, 1.5, 2.0, 2.25, 2.5, 2.75, 3.0]
