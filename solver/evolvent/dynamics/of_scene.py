"""Vibration settings and operating point from the section [dynamics] of a scene."""

from __future__ import annotations

import math
from typing import Literal

from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.dynamics.pair_model import RIGID, DriveSettings, geometric_backlash, lacking_room
from evolvent.gears.problem.gear_inertia import refuse_light_gears
from evolvent.gears.problem.load_limits import rounded_up
from evolvent.scene.backlash import GIVING, unnamed_backlash
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.inertias import moments_of_inertia
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.schema.errors import InputProblem, SceneError
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

FEWEST_POSITIONS = 3


def check_positions(scene: Scene) -> None:
    """Raises SceneError where a pitch has too few positions for an excitation that varies over it."""
    if (found := scene.sweep.positions) < FEWEST_POSITIONS:
        allowed = f"{FEWEST_POSITIONS} or more for an excitation, whose first harmonic two positions do not show"
        raise SceneError([InputProblem("sweep.positions", str(found), allowed, "20 are usual, 40 show each step")])


def check_vibration(scene: Scene) -> None:
    """Raises SceneError where the vibration of a scene has too few positions, where nobody has named a backlash, or the
    unloaded errors of the flanks leave no room in it; InputError where gear bodies that give way have less inertia
    than they are drawn with. All of it is known by geometry alone, before any contact is solved."""
    check_positions(scene)
    if problem := backlash_problem(scene):
        raise SceneError([problem])
    check_bodies(scene)


def check_bodies(scene: Scene) -> None:
    """Raises InputError where a gear's inertia is below that of its body, all of which moves where it is elastic."""
    section, pair = scene.dynamics or DynamicsSection(), scene.gear_pair()
    if section.bodies == "elastic":
        refuse_light_gears(pair, moments_of_inertia(pair, section), section.density, RIGID)


def refusals(scene: Scene) -> list[str]:
    """Messages of `check_vibration` on backlash and bodies; none where it raises nothing."""
    found = [str(problem)] if (problem := backlash_problem(scene)) else []
    try:
        check_bodies(scene)
    except InputError as error:
        found.append(str(error))
    return found


def backlash_problem(scene: Scene) -> InputProblem | None:
    """Input problem of a scene whose vibration cannot be computed with its backlash; None where it can."""
    section, problem = scene.dynamics or DynamicsSection(), gear_problem(scene)
    if missing := unnamed_backlash(problem.pair, section.backlash_um):
        return missing
    settings = drive_settings(problem.pair, section)
    lacking = 1e3 * lacking_room(problem, scene.sweep.positions, settings)
    if lacking == 0.0:
        return None
    backlash = 1e3 * settings.backlash
    found = f"{backlash:.4g} µm, {lacking:.3g} µm less than unloaded errors of the flanks want"
    least = rounded_up(backlash + lacking)
    allowed = f"from {least} µm on for these flanks at {scene.sweep.positions} positions a pitch"
    return InputProblem("dynamics.backlash_um", found, allowed, f"give {GIVING}")


def drive_settings(
    pair: GearPair, section: DynamicsSection, driving: Member = Member.PINION
) -> DriveSettings:
    """Settings of a vibration from the section, with those that follow from the gears where it leaves them open.
    driving: the gear that drives."""
    backlash = geometric_backlash(pair) if section.backlash_um is None else 1e-3 * section.backlash_um
    series = math.inf if section.series_stiffness_N_per_um is None else 1e3 * section.series_stiffness_N_per_um
    return DriveSettings(
        moments_of_inertia(pair, section), section.damping_ratio, backlash, section.damping_in_separation,
        section.ground_damping_ratio, series, section.mesh, driving=driving,
    )


def operating_point(scene: Scene) -> OperatingPoint | None:
    """Operating point under whose mesh force the contact is computed; None where it is computed under the constant
    torque. Raises as `check_vibration`."""
    section = scene.dynamics
    if section is None or section.operating_rpm is None:
        return None
    check_vibration(scene)
    shares = tuple(sorted(percent / 100.0 for percent in section.torque_percents))
    settings = drive_settings(scene.gear_pair(), section, Member.named(scene.load.driving))
    of_several: Literal["mean", "largest"] = "largest" if scene.wear is None else "mean"
    return OperatingPoint(settings, section.operating_rpm, section.direction, shares, scene.sweep.positions, of_several)
