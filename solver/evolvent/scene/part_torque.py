"""A scene under a part of its torque, as load lists and excitations compute it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from evolvent.scene.scene import Scene, SceneError, scene_from_values
from evolvent.scene.schema.errors import shown


def listed_percents(
    scene: Scene, given: Sequence[float] = (), default: Sequence[float] = (100.0,)
) -> tuple[float, ...]:
    """Torques of a list in percent of the scene's own: those given, those of the scene, or those by default."""
    return tuple(given or scene.load.percents or default)


def with_percents(scene: Scene, percents: Sequence[float]) -> Scene:
    """The scene with torques of a list, in percent of its own."""
    return scene.changed("load", percents=tuple(percents))


def under_percents(scene: Scene, percents: Sequence[float]) -> dict[float, Scene]:
    """Part of its torque in percent, ascending -> the scene under it, on meshes that serve all of these torques. Raises
    SceneError where one of them is refused."""
    one, torques = with_percents(scene, ()), {each: scene.load.torque_Nm * each / 100.0 for each in sorted(percents)}
    served = min(torques.values()), max(torques.values())
    return {percent: under_torque(one, torque, served) for percent, torque in torques.items()}


def under_torque(scene: Scene, torque: float, mesh_torques: tuple[float, float] | None = None) -> Scene:
    """The scene under another torque [N·m], on meshes for a range of torques [N·m] or for this one alone. Raises
    SceneError, which says what part of the scene's own torque is refused."""
    values = scene.model_dump(exclude_none=True)
    load = {name: value for name, value in values["load"].items() if name != "mesh_torques_Nm"}
    served = {} if mesh_torques is None else {"mesh_torques_Nm": mesh_torques}
    try:
        return scene_from_values({**values, "load": {**load, "torque_Nm": torque, **served}})
    except SceneError as error:
        own = scene.load.torque_Nm
        part = f"{shown(own)}, at {100.0 * torque / own:.6g} % of it "
        raise SceneError([
            replace(each, found=part + each.found) if each.key == "load.torque_Nm" else each for each in error.problems
        ]) from error
