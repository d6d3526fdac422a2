"""A scene under a part of its torque."""

from __future__ import annotations

import re

import pytest

from evolvent.scene.load_cases import under_torque
from evolvent.scene.scene import SceneError
from tests.support.gear_cases import spur_scene


def test_torque_and_meshes_are_replaced() -> None:
    """The torque, and the range of torques for the meshes, which is left out where it is not given; nothing else."""
    scene = spur_scene("load.mesh_torques_Nm=[10, 400]")
    half = under_torque(scene, 0.5 * scene.load.torque_Nm, (1.0, 500.0))
    assert (half.load.torque_Nm, half.load.mesh_torques_Nm) == (0.5 * scene.load.torque_Nm, (1.0, 500.0))
    alone = under_torque(scene, scene.load.torque_Nm)
    assert alone == scene.model_copy(update={"load": scene.load.model_copy(update={"mesh_torques_Nm": None})})


@pytest.mark.parametrize("percent", [1e-7, 1e6])
def test_refused_part_names_the_torque_of_the_scene(percent: float) -> None:
    """Too small or too large a part: the message has the torque that stands in the scene, and what part is refused."""
    scene = spur_scene()
    with pytest.raises(SceneError, match=re.escape(f"load.torque_Nm: found 170, at {percent:g} % of it")):
        under_torque(scene, scene.load.torque_Nm * percent / 100.0)
