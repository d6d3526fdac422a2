"""Moving pair from condensed gears: modes, inertia, damping and load torques."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from evolvent.dynamics.modes.gear_modes import GearModes, ModeChoice, gear_modes
from evolvent.dynamics.modes.mode_meshes import mode_mesh
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.transient.moving_pair import Drive, MovingPair
from evolvent.gears.gear_model import GearModel
from evolvent.gears.problem.gear_inertia import refuse_less_than_the_body
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.gears.member import Member

RESOLVED = 0.25
"""Highest resolved frequency over the sampling frequency of the time steps. Modes up to it have four steps a period,
others respond quasi-statically."""
LEAST = 1
"""Fewest modes of each harmonic. Without any, inertia stays at the bore, and the pair's natural frequency is lower: by
6 % of a spur pair (docs/he2022.md)."""


def resolved_modes(
    problem: GearProblem, model: GearModel, density: float, sampled: float, per_harmonic: int | None,
    least: int = LEAST, computed: Callable[[], None] = lambda: None,
) -> tuple[GearModes, GearModes]:
    """Modes of pinion and wheel that have four time steps a period, and at least so many of each harmonic.

    density: [t/mm³]. sampled: time steps a second, at the highest speed. per_harmonic: so many of each harmonic of the
    ring of teeth instead, None for the default. least: by default `LEAST`. computed: called after each harmonic.

    Raises MeshError, NotPositiveDefinite, OutOfMemory.
    """
    choice = ModeChoice(2.0 * np.pi * RESOLVED * sampled, per_harmonic, least)
    heavy = [replace(body, material=replace(body.material, density=density)) for body in model.bodies]
    pinion, wheel = (gear_modes(body, choice, mode_mesh(problem, body), computed) for body in heavy)
    return pinion, wheel


def driven_pair(
    model: GearModel, modes: tuple[GearModes, GearModes], settings: DriveSettings, static: Sequence[PositionResult],
    mode_damping: float, constant_speed: bool,
) -> MovingPair:
    """Condensed pair with modes, inertia, damping and load torques.

    static: positions of a pitch, whose mean tangent stiffness makes the damping of the mesh. mode_damping: ratio of
    each mode. constant_speed: whether the gear without the torque turns uniformly; else both are free.

    Raises InputError for an inertia below that of the body whose modes move.
    """
    on, u, torque = model.load.on, model.pair.ratio, model.load.torque
    pinion, wheel = (inertia / model.width_factor for inertia in settings.inertias)
    for member, inertia in zip(Member, (pinion, wheel)):
        if modes[member].count:
            body = modes[member].moment_of_inertia
            width = model.width_factor
            refuse_less_than_the_body(member, width * inertia, width * body, "transient.modes_per_harmonic = 0")
    torques = (torque, torque * u) if on == 0 else (torque / u, torque)  # but for friction
    drive = Drive.free(u, (pinion, wheel), torques)
    if constant_speed:
        drive = Drive.at_constant_speed(on, (pinion, wheel)[on], torques)
    pair = MovingPair(model, modes, drive, mode_damping, 0.0, settings.damping_in_separation)
    stiffness = float(np.mean([result.stiffness for result in static]))
    critical = 2.0 * np.sqrt(stiffness * drive.inertia) / pair.lever
    return replace(pair, mesh_damping=settings.damping_ratio * critical)


def loaded_as_static(pair: MovingPair, static: Sequence[PositionResult]) -> MovingPair:
    """The pair under the scene's torque on one gear and the mean static reaction torque on the other, which friction
    makes smaller or larger. static: positions of a pitch at one friction coefficient."""
    other = 1 - pair.model.load.on
    torques = list(pair.drive.torques)
    torques[other] = float(np.mean([result.torques[other] for result in static]))
    return replace(pair, drive=replace(pair.drive, torques=(torques[0], torques[1])))
