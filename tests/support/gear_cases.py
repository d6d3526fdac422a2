"""He's spur pair (plane strain) and a narrow, coarse helical pair, ready to be solved."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from mpi4py import MPI

from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshing.flank_levels import FlankLevel, LevelledSector
from evolvent.gears.meshing.levelled_meshes import LevelledMesh, levelled_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import shared_position
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene, scene_from_text
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from tests.support.checkout import ROOT

LEVEL = FlankLevel(2, 2, (2, 1, 1))
QUIET = ("output.pictures=false", "output.animation=false", "output.fields=false", "output.error_bars=false")
HELICAL = """
[pair]
normal_module_mm = 3.0
normal_pressure_angle_deg = 20.0
helix_angle_deg = 20.0
[pinion]
teeth = 20
face_width_mm = 8
bore_diameter_mm = 36
[wheel]
teeth = 24
face_width_mm = 8
bore_diameter_mm = 44
[mesh]
level = "quick"
order = 1
elements_per_contact_width = 0.5
[load]
torque_Nm = 120
[contact]
friction = [0.0, 0.3]
[sweep]
positions = 2
"""


def spur_scene(*settings: str) -> Scene:
    """He's pair."""
    return load_scene(ROOT / "demos/he2022.toml", [*QUIET, *settings])


def helical_scene(*settings: str) -> Scene:
    """A narrow helical pair, first-order cells and half of one across the contact: for algebra, not for stress."""
    return scene_from_text(HELICAL, [*QUIET, *settings])


def model_of(scene: Scene) -> GearModel:
    """Condensed on this rank alone; the same object for the last few scenes, which many tests share."""
    return _condensed(scene.resolved_toml())


@lru_cache(maxsize=6)
def _condensed(text: str) -> GearModel:
    return prepare_model(gear_problem(scene_from_text(text)), MPI.COMM_SELF).model


def few_cells(problem: GearProblem, member: Member) -> LevelledMesh:
    """A sector whose flank has 6 × 2 coarse cells, each divided into 2 × 2 on its one level."""

    def adapted(sector: LevelledSector) -> LevelledSector:
        return LevelledSector(replace(sector.coarse, profile_elements=6, face_elements=2), (LEVEL,))

    return levelled_mesh(problem, member, adapted)


@dataclass(frozen=True)
class Curves:
    """A sweep at one friction coefficient: pinion rotations (k,) [°] and results (k)."""

    degrees: Floats
    results: list[PositionResult]

    def of(self, name: Literal["transmission_error", "torques", "residual", "friction_loss"]) -> Floats:
        """An attribute of all results."""
        return np.array([getattr(result, name) for result in self.results])

    @property
    def torque_ratio(self) -> Floats:
        """T_2 z_1 / T_1 z_2 (k,)."""
        torques = self.of("torques")
        return torques[:, 1] / (torques[:, 0] * self.results[0].stand.pair.ratio)

    @property
    def tip_edge(self) -> Bools:
        """(k,) bool: a tooth bears on a tip edge."""
        return np.array([bool(result.contact.edge.any()) for result in self.results])

    def forces(self, tooth: int) -> Floats:
        """Normal force (k,) of a tooth pair [N; per mm in 2D]."""
        return np.array([force(result, tooth) for result in self.results])


def swept(model: GearModel, degrees: Floats, frictions: list[float]) -> list[Curves]:
    """Solves these pinion rotations [°] one after the other; one Curves per friction coefficient."""
    pitch = Pitch(tuple(np.radians(degrees)))
    positions: list[SweptPosition] = list(sweep_pitch(model, pitch, frictions, initial_state(frictions)))
    return [Curves(degrees, [p.results[i] for p in positions]) for i in range(len(frictions))]


def force(result: PositionResult, tooth: int) -> float:
    """Normal force of a tooth pair [N; per mm in 2D]."""
    c = result.contact
    return float(np.sum((c.pressure * c.weights)[c.tooth == tooth]))


def friction_force(result: PositionResult, tooth: int) -> float:
    """Tangential force of a tooth pair along the profile [N; per mm in 2D]."""
    c = result.contact
    return float(np.sum((c.traction[:, 1] * c.weights)[c.tooth == tooth]))


def touches(model: GearModel, degrees: float, tooth: int) -> bool:
    """Whether a tooth pair carries load without friction at a pinion rotation [°]."""
    shared = shared_position(model, float(np.radians(degrees)), (0.0, 0.0), (0.0,), None)
    pressed = shared.smooth.traction[:, 0] > 0.0
    return bool(np.any(pressed & (shared.contact.geometry.point_tooth == tooth)))


def with_load(model: GearModel, torque: float, on: Member) -> GearModel:
    """The same gears under another load."""
    return replace(model, load=replace(model.load, torque=torque, on=on))
