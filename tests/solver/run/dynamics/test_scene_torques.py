"""Torques of an excitation, and the torque that its meshes are sized for."""

from __future__ import annotations

import pytest

from evolvent.gears.meshing.levelled_meshes import flank_cells
from evolvent.run.dynamics.scene_torques import listed_torques, scene_torques
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import SceneError
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import spur_scene

LIST = [200.0, 5.0, 100.0]
"""He's pair has 170 N·m."""


def test_meshes_are_those_of_the_scenes_torque() -> None:
    """As many cells as its own run has, also with the lightest torque of a list at 5 %; torques in N·mm, ascending,
    on a gear of base radius r cos α."""
    loads = scene_torques(spur_scene(), LIST)
    assert loads.torques == pytest.approx((8.5e3, 170e3, 340e3))
    assert flank_cells(loads.problem, Member.PINION) == flank_cells(gear_problem(spur_scene()), Member.PINION)
    assert loads.problem.mesh_torques == pytest.approx((170e3, 340e3))
    assert loads.problem.base_radius == pytest.approx(70.4769, rel=1e-5)


@pytest.mark.parametrize(("percents", "sized"), [([5.0, 50.0], 85e3), ([150.0, 200.0], 255e3)])
def test_lists_beside_the_scenes_torque(percents: list[float], sized: float) -> None:
    """The nearest torque of the list."""
    assert scene_torques(spur_scene(), percents).problem.torque == pytest.approx(sized)


@pytest.mark.parametrize("percents", [(50.0,), (5.0, 50.0), (150.0, 200.0), (40.0, 100.0)])
def test_the_scene_lists_the_same_torques(percents: tuple[float, ...]) -> None:
    """Exact: the scene that is kept with the results, read again, has the torques of the results, also where its own
    torque is now the nearest one of the list."""
    loads = listed_torques(spur_scene(), percents)
    assert listed_torques(loads.scene, ()).torques == pytest.approx(loads.torques, rel=1e-12)
    assert loads.torques == pytest.approx([1.7e3 * each for each in percents], rel=1e-12)


def test_scene_may_ask_for_meshes_of_lighter_torques() -> None:
    """`load.mesh_torques_Nm` from a sixteenth on: a quarter of the Hertz width, about four times the cells, but for
    half a step of torques."""
    scenes = spur_scene(), spur_scene("load.mesh_torques_Nm=[10.625, 170]")
    plain, fine = (scene_torques(each, LIST).problem for each in scenes)
    assert fine.mesh_torques == pytest.approx((10.625e3, 340e3))
    (few, _), (many, _) = (flank_cells(each, Member.PINION) for each in (plain, fine))
    assert many == pytest.approx(4 * few, rel=0.07)


def test_elements_across_the_contact() -> None:
    """3 at level standard under the scene's torque, and with the root of the torque under others."""
    assert scene_torques(spur_scene("mesh.level=standard"), LIST).elements == pytest.approx(
        [3.0 * 0.05**0.5, 3.0, 3.0 * 2.0**0.5]
    )


def test_contacts_too_narrow_for_error_bars_are_said() -> None:
    """At level quick 2 % of the torque have a contact 0.24 elements wide, 5 % one of 0.38; the remedy is one: with its
    meshes nothing is said."""
    quick = spur_scene("mesh.level=quick")
    assert scene_torques(quick, [5.0, 100.0]).warnings == []
    (said,) = scene_torques(quick, [2.0, 5.0, 100.0]).warnings
    assert "torques up to 3.4 N·m" in said and "found 0.24 under" in said
    remedy = said.rsplit("--set ", 1)[1]
    assert scene_torques(spur_scene("mesh.level=quick", remedy), [2.0, 5.0, 100.0]).warnings == []


def test_torques_beyond_the_scenes_limits_are_refused() -> None:
    """As `load.torque_Nm` itself."""
    with pytest.raises(SceneError, match=r"load\.torque_Nm"):
        scene_torques(spur_scene(), [100.0, 1e12])


def test_wear_is_left_out() -> None:
    """The excitation is that of the flanks as they are."""
    wearing = "wear.pinion_mm2_per_N=1e-13", "wear.wheel_mm2_per_N=1e-13", "wear.cycles=1e5"
    assert scene_torques(spur_scene(*wearing), LIST).scene.wear is None
