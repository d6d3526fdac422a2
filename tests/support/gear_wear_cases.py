"""Gear pairs that wear: scenes, solved pitches of unworn flanks, smooth worn depths, He's pair with Hertz' pressure."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from mpi4py import MPI

from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.run_data import RunData
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.wear.archard import Archard
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.meshed_pair import GearMeshMotion
from evolvent.wear.gears.pitch_state import PitchState
from evolvent.wear.results.report import WornPair
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from tests.support.gear_cases import helical_scene, model_of, spur_scene
from tests.support.synthetic_run import synthetic_run

K = 1.3832e-10  # mm²/N, He et al. 2022
RELIEF = tuple(f"{gear}.tip_relief_{key}" for gear in ("pinion", "wheel") for key in ("um=30", "form=parabolic"))


def wear_scene(kind: str, *settings: str) -> Scene:
    """A spur pair without loaded tip edges, or a coarse helical one."""
    if kind == "spur":
        return spur_scene("mesh.level=quick", *RELIEF, *settings)
    return helical_scene("contact.friction=0", *settings)


def condenser(scene: Scene) -> Callable[[Callable[[Member], MeshData]], GearModel]:
    """See GearMeshMotion."""
    return lambda mesh: prepare_model(gear_problem(scene), MPI.COMM_SELF, lambda _, gear: mesh(gear)).model


def wearing_gears(scene: Scene, positions: int = 4, refresh: float = np.inf) -> GearWear:
    """Both gears wear alike."""
    model = model_of(scene)
    pitch, following = uniform_pitch(model.pair.pinion.z, positions), GearMeshMotion(refresh, condenser(scene))
    return GearWear(model, pitch, 0.0, Archard(K, K), MPI.COMM_SELF, following)


def smooth_wear(gears: GearWear, depth: float) -> Floats:
    """A smooth wear of both flanks: nothing at root and tip, `depth` in the middle."""
    parts = []
    for grid in gears.grids:
        own, x = np.empty(grid.node.size), (grid.arcs - grid.arcs[0]) / np.ptp(grid.arcs)
        own[grid.node] = depth * np.sin(np.pi * x) ** 2
        parts.append(own)
    return np.concatenate(parts)


@cache
def solved_pitch(positions: int, friction: float = 0.0, scene: str = "spur") -> tuple[GearWear, PitchState]:
    """A pitch of unworn flanks."""
    make = spur_scene if scene == "spur" else helical_scene
    model = model_of(make(f"contact.friction={friction}"))
    pitch = uniform_pitch(model.pair.pinion.z, positions)
    study = GearWear(model, pitch, friction, Archard(K, 2.0 * K))
    return study, study.evaluate(study.begin)


@cache
def he_run() -> RunData:
    """He's pair with Hertz' pressure, both tooth pairs bearing half the load where there are two."""
    return synthetic_run("sweep.positions=40", "mesh.level=fine", file="demos/he2022.toml")


def unworn_pair(run: RunData) -> WornPair:
    """The run with charts on the flanks' own nodes."""
    charts = []
    for shape in run.shapes:
        diameters = np.unique(np.round(2.0 * np.hypot(*shape.points[shape.flank_nodes].T[:2]), 9))
        charts.append(FlankChart(diameters, np.zeros(1), np.zeros((len(diameters), 1))))
    return WornPair(0.0, run, (charts[0], charts[1]), (0.0, 0.0))
