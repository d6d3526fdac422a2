"""Sizes of sectors, counted without meshing, where tips are not sharp and bores are held in part.

Those of other gears: tests/solver/scene/checking/test_problem_size.py.
"""

from __future__ import annotations

import numpy as np

from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.meshing.sector_sizes import one_mesh_sizes
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene


def test_rounded_tips_and_partial_supports_add_no_node() -> None:
    """Exact: the nodes of the mesh, of its loaded flank and of its two cut faces, three degrees of freedom each, of a
    helical pair with a rounding, a chamfer and a bore that is held on half of the face."""
    form = "pinion.tip_rounding_um=300", "wheel.tip_chamfer_um=200", "wheel.support_width_mm=4"
    problem = gear_problem(helical_scene("mesh.order=2", *form))
    for member, found in zip(Member, one_mesh_sizes(problem)):
        mesh = gear_mesh(problem, member)
        flank, low, high = (len(np.unique(mesh.facets[name])) for name in ("flank", "cut_low", "cut_high"))
        assert [found.dofs, found.flank, found.cuts] == [3 * len(mesh.points), 3 * flank, 3 * (low + high)]
