"""A scene under a list of torques, for its excitation: the meshes are those of its own torque.

Transmission error and stiffness of lighter torques need no contact that is resolved as finely as for pressures, and
meshes for the narrowest contact of a list cost many times the rest. Error bars say what is lost: at 5 % of the torque
of He's pair, level standard, 1 % of the transmission error and 2 % of the tangent stiffness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, scene_from_values
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class SceneTorques:
    """A scene and the torques that it is solved under."""

    scene: Scene
    """Without wear, under the torque that the meshes are sized for."""
    torques: tuple[float, ...]
    """Ascending [N·mm]."""

    @cached_property
    def problem(self) -> GearProblem:
        """Of the scene, on flanks that are long enough for the heaviest torque."""
        own = gear_problem(self.scene)
        lightest, heaviest = own.mesh_torques or (own.torque, own.torque)
        return replace(own, mesh_torques=(lightest, max(heaviest, self.torques[-1])))

    @property
    def base_radius(self) -> float:
        """Of the gear with the torque [mm]."""
        return self.problem.pair.gears[self.problem.torque_on].base_radius

    @property
    def forces(self) -> Floats:
        """(m,) along the line of action [N]."""
        return np.array(self.torques) / self.base_radius


def scene_torques(scene: Scene, percents: Sequence[float]) -> SceneTorques:
    """The scene under parts of its torque. Meshes are sized for its own torque or, where this lies outside the list,
    for the nearest one of that; for lighter ones where the scene says so (`load.mesh_torques_Nm`).

    percents: different ones. Raises SceneError where one of the torques is refused.
    """
    ascending = sorted(percents)
    torques = [scene.load.torque_Nm * percent / 100.0 for percent in ascending]
    for torque in torques:
        _under(scene, torque)
    if scene.load.mesh_torques_Nm is None:
        scene = _under(scene, min(max(scene.load.torque_Nm, torques[0]), torques[-1]))
    return SceneTorques(scene.model_copy(update={"wear": None}), tuple(1e3 * torque for torque in torques))


def _under(scene: Scene, torque: float) -> Scene:
    """On meshes for this torque [N·m] alone."""
    values = scene.model_dump(exclude_none=True)
    load = {name: value for name, value in values["load"].items() if name != "mesh_torques_Nm"}
    return scene_from_values({**values, "load": {**load, "torque_Nm": torque}})
