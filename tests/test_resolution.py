"""Sizes that are told before a mesh is made, against the mesh."""

from __future__ import annotations

import numpy as np
import pytest
from gear_cases import helical_scene, spur_scene

from solver.resolution import sector_resolutions, sector_size
from solver.sectors import gear_mesh


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("plane", [True, False])
def test_sector_size(order: int, plane: bool) -> None:
    """Exact: the nodes of the mesh, of its loaded flank and of its two cut faces, times the dimension."""
    scene = (spur_scene if plane else helical_scene)(f"mesh.order={order}")
    for index, gear in enumerate(scene.gear_pair().gears):
        mesh = gear_mesh(scene, index)
        found = sector_size(gear, sector_resolutions(scene)[index], order, plane)
        flank, low, high = (len(np.unique(mesh.facets[name])) for name in ("flank", "cut_low", "cut_high"))
        exact = np.array([len(mesh.points), flank, low + high]) * mesh.dimension
        assert [found.dofs, found.flank, found.cuts] == exact.tolist()
