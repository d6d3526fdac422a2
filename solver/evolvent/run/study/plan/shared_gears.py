"""Scenes of a study that share condensed gears.

The compliance of gears depends neither on friction nor on misalignment, and on the torque by their meshes only, which
may serve a range of torques. In line contact it depends neither on the torque nor on flank modifications.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace

from evolvent.gears.gear_model import Mesher
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.shared_gears import shared_gears_name
from evolvent.run.dynamics.scene_torques import SceneTorques, scene_torques
from evolvent.run.strength.pitch_roots import root_meshes, root_refinement
from evolvent.scene.gear_problem import gear_problem, shares_gears
from evolvent.scene.line_level import LINE
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.skips import wanted_output

NOT_SHARING = "check", "wear"
"""Computations whose scenes share no gears: flanks that wear are a scene's own."""


def meshes(scene: Scene, compute: str) -> tuple[Mesher, ...]:
    """Meshes from which a scene's gears are condensed: those of the results, and those of error bars where it asks for
    them."""
    roots = [each.mesh for each in root_meshes(scene)]
    both = tuple(roots) if compute == "strength" else (run_mesh, companion_mesh)
    return both if wanted_output(scene).error_bars else both[:1]


def own_torque(scene: Scene) -> SceneTorques:
    """Torques of an excitation of a scene: its own torque alone."""
    return SceneTorques(scene.model_copy(update={"wear": None}), (1e3 * scene.load.torque_Nm,), ("100 %",))


def condensed_problem(scene: Scene, compute: str) -> GearProblem:
    """Gear problem that a computation of the scene condenses. Raises SceneError."""
    if compute == "dynamics":
        return scene_torques(scene, (scene.dynamics or DynamicsSection()).torque_percents).problem
    return gear_problem(scene)


def on_shared_meshes(scenes: Sequence[Scene], compute: str) -> list[Scene]:
    """The scenes, those with the same gears on meshes that serve all of their torques. Those of an excitation are sized
    for the heaviest one, for the reason in `evolvent.run.dynamics.scene_torques`."""
    if compute in NOT_SHARING or compute == "dynamics":  # which has meshes for a range of torques of its own
        return list(scenes)
    torques: dict[str, set[float]] = defaultdict(set)
    names = [_without_torque(scene) for scene in scenes]
    for name, scene in zip(names, scenes):
        torques[name].add(scene.load.torque_Nm)
    narrowest = max if compute == "excitation" else min
    return [_serving(scene, (narrowest(torques[name]), max(torques[name]))) for name, scene in zip(names, scenes)]


def gears_names(scenes: Sequence[Scene], compute: str) -> list[str]:
    """Name of the gears that each scene has in common with another one; empty where it has its own."""
    if compute in NOT_SHARING:
        return [""] * len(scenes)
    names = [_name(scene, compute) if shares_gears(scene) else "" for scene in scenes]
    counts = Counter(names)
    return [name if counts[name] > 1 else "" for name in names]


def _name(scene: Scene, compute: str) -> str:
    times = root_refinement(scene) if compute == "strength" else 0
    return f"{shared_gears_name(condensed_problem(scene, compute))} {len(meshes(scene, compute))} {times}"


def _without_torque(scene: Scene) -> str:
    """Name of the gears of a scene under any torque."""
    return shared_gears_name(replace(gear_problem(scene), torque=1.0, mesh_torques=(1.0, 1.0)))


def _serving(scene: Scene, torques: tuple[float, float]) -> Scene:
    """The scene on meshes for a range of torques [N·m], unless it gives such a range itself or is in line contact, on
    meshes that do not depend on the torque."""
    own = torques == (scene.load.torque_Nm, scene.load.torque_Nm)
    if own or scene.load.mesh_torques_Nm is not None or scene.mesh.level == LINE:
        return scene
    return scene.changed("load", mesh_torques_Nm=torques)
