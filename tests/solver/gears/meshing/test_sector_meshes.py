"""The sector meshes of a gear pair, of first order."""

from __future__ import annotations

import pytest

from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import least_determinants

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
