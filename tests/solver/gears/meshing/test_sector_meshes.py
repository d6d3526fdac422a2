"""The sector meshes of a gear pair: first order, modified flanks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import SHAPES, CellShape, MeshSettings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, scene_from_text
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import least_determinants
from tests.support.gear_cases import helical_scene, spur_scene
from tests.support.meshes.modified_gears import fully_modified

THIN_TIP = """
[pair]
normal_module_mm = 2.7
normal_pressure_angle_deg = 20.0
[pinion]
teeth = 41
face_width_mm = 5.0
[wheel]
teeth = 21
face_width_mm = 5.0
profile_shift = 0.746
addendum_coefficient = 1.244
dedendum_coefficient = 1.454
[mesh]
level = "quick"
order = 1
elements_per_contact_width = 0.58
[load]
torque_Nm = 4.4
on = "wheel"
"""
"""The wheel's tooth is 0.07 modules thick at its tip; the contact is lightly loaded and coarsely meshed."""


def test_first_order_cells_that_fold_in_a_thin_tooth_are_refused() -> None:
    """A cell next to the tip, three profile elements high, is sound with the curved edges of order 2 and folded with
    straight ones: the message names the gear and what to change."""
    problem = gear_problem(scene_from_text(THIN_TIP))
    with pytest.raises(MeshError, match=r"wheel: wanted first-order cells without folds, found 1 of .*mesh.order = 2"):
        gear_mesh(problem, Member.WHEEL)
    assert (least_determinants(gear_mesh(problem, Member.PINION)) > 0.0).all()


@pytest.mark.parametrize("setting", ["mesh.order=2", "mesh.elements_per_contact_width=3"])
def test_what_the_message_advises_helps(setting: str) -> None:
    """The same tooth with cells of order 2, or with five times as many: none is folded."""
    mesh = gear_mesh(gear_problem(scene_from_text(THIN_TIP, [setting])), Member.WHEEL)
    assert (least_determinants(mesh) > 0.0).all()


@pytest.mark.parametrize("make", [spur_scene, helical_scene], ids=["spur", "helical"])
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", SHAPES)
def test_flank_nodes_of_both_orders_lie_on_the_modified_flank(
    make: Callable[..., Scene], order: Literal[1, 2], shape: CellShape
) -> None:
    """Problem: every modification, 1 to 12 µm each. Exact: the distance of all nodes of the flank is 0, 1e-6 mm."""
    scene = make("mesh.level='quick'", "mesh.elements_per_contact_width=0.6")
    gear = fully_modified(scene.gear_pair().pinion)
    problem = replace(
        gear_problem(scene), pair=replace(scene.gear_pair(), pinion=gear), mesh=MeshSettings("quick", 0.6, shape, order)
    )
    mesh = gear_mesh(problem, Member.PINION)
    flank = mesh.points[np.unique(mesh.facets["flank"])]
    assert mesh.order == order and not problem.is_plane
    assert np.abs(Flank(gear).distance(flank)).max() < 1e-6
