"""Sizes of sectors, counted without meshing, where tips are not sharp, bores are held in part, and bodies have webs.

Those of other gears: tests/solver/check/test_problem_size.py.
"""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.meshing.levelled_meshes import levelled_mesh
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.meshing.sector_sizes import levelled_sizes, one_mesh_sizes
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from tests.support.gear_cases import helical_scene
from tests.support.running.webbed_pair import WEB

BODIES = {
    "hub": WEB,
    "to the bore": ("wheel.rim_thickness_mm=4", "wheel.web_thickness_mm=2"),
    "hub held in part": (*WEB, "wheel.support_width_mm=4"),
    "full": (*WEB, "wheel.web_thickness_mm=8", "wheel.web_offset_mm=0"),
}


def test_rounded_tips_and_partial_supports_add_no_node() -> None:
    """Exact: the nodes of the mesh, of its loaded flank and of its two cut faces, three degrees of freedom each, of a
    helical pair with a rounding, a chamfer and a bore that is held on half of the face."""
    form = "pinion.tip_rounding_um=300", "wheel.tip_chamfer_um=200", "wheel.support_width_mm=4"
    problem = gear_problem(helical_scene("mesh.order=2", *form))
    for member, found in zip(Member, one_mesh_sizes(problem)):
        assert [found.dofs, found.flank, found.cuts] == counted(gear_mesh(problem, member))


def counted(mesh: MeshData) -> list[int]:
    """Degrees of freedom of a sector, of its flank and of both cuts."""
    flank, low, high = (len(np.unique(mesh.facets[name])) for name in ("flank", "cut_low", "cut_high"))
    return [3 * len(mesh.points), 3 * flank, 3 * (low + high)]


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("long_way", [False, True])
@pytest.mark.parametrize("body", BODIES.values(), ids=list(BODIES))
def test_webs_are_counted(body: tuple[str, ...], long_way: bool, order: int) -> None:
    """Exact: a wheel with a web, with and without a hub, of both orders, also with three times the elements in its
    body."""
    off = ['exact.parts=["coarse-body"]'] if long_way else []
    problem = gear_problem(helical_scene(*body, f"mesh.order={order}", *off))
    found = one_mesh_sizes(problem)[Member.WHEEL]
    assert [found.dofs, found.flank, found.cuts] == counted(gear_mesh(problem, Member.WHEEL))


def test_webs_below_flanks_with_levels_are_counted() -> None:
    """Exact: the coarse sector."""
    problem = gear_problem(helical_scene(*WEB, "mesh.order=2"))
    found = levelled_sizes(problem)[Member.WHEEL].sector
    assert [found.dofs, found.flank, found.cuts] == counted(levelled_mesh(problem, Member.WHEEL).mesh)
