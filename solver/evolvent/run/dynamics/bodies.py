"""Rigid or elastic gear bodies of a scene's vibration."""

from __future__ import annotations

from dataclasses import replace

from mpi4py import MPI

from evolvent.dynamics.modes.static_shapes import with_elastic_bodies
from evolvent.dynamics.of_scene import operating_point
from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection


def with_bodies(
    settings: DriveSettings, problem: GearProblem, section: DynamicsSection, comm: MPI.Comm
) -> DriveSettings:
    """The settings with rigid or elastic bodies, as the section asks. Collective. Raises as `with_elastic_bodies`."""
    if section.bodies == "rigid":
        return settings
    return on_first(comm, lambda: with_elastic_bodies(settings, problem, section.density))


def elastic_point(scene: Scene, comm: MPI.Comm) -> OperatingPoint | None:
    """Operating point of the scene, with rigid or elastic gear bodies as the scene asks. Collective."""
    point, section = operating_point(scene), scene.dynamics
    if point is None or section is None:
        return None
    return replace(point, settings=with_bodies(point.settings, gear_problem(scene), section, comm))
