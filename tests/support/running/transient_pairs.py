"""Gear pairs that move on in time: He's spur pair and a helical one."""

from __future__ import annotations

from functools import cache

import numpy as np

from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.modes.gear_modes import GearModes, ModeChoice, gear_modes
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import Drive, MovingPair
from evolvent.dynamics.transient.pair_state import PairState
from evolvent.dynamics.transient.pair_transient import MovingMoment, PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.gears.gear_model import GearModel
from tests.support.gear_cases import helical_scene, model_of, spur_scene

POSITIONS = 10


@cache
def condensed(kind: str) -> GearModel:
    """"spur" or "helical"."""
    return model_of(spur_scene("mesh.level=quick") if kind == "spur" else helical_scene())


@cache
def modes(kind: str, count: int) -> tuple[GearModes, GearModes]:
    """So many of each harmonic of pinion and wheel."""
    pinion, wheel = (gear_modes(body, ModeChoice(0.0, count)) for body in condensed(kind).bodies)
    return pinion, wheel


def moving(kind: str, friction: float, rpm: float, count: int = 1, free: bool = False) -> PairTransient:
    """Ten time steps a mesh period; the gear with the torque swings alone, or both do."""
    model, gears = condensed(kind), modes(kind, count)
    inertias = gears[0].moment_of_inertia, gears[1].moment_of_inertia
    on, u = model.load.on, model.pair.ratio
    torques = model.load.torque, model.load.torque * u
    drive = Drive.at_constant_speed(on, inertias[on], torques)
    if free:
        drive = Drive.free(u, inertias, torques)
    damping = 0.1 * np.sqrt(3e5 * inertias[0]) / drive.lever((1.0, 1.0))
    pair = MovingPair(model, gears, drive, 0.02, damping / model.pair.pinion.base_radius)
    kept = KeptContacts(pair, POSITIONS, 1 if friction == 0.0 else model.bodies[0].d)
    return PairTransient(pair, friction, MeshSpeed(rpm, model.pair.pinion.z), TimeScheme(0.5), kept)


def started(transient: PairTransient) -> PairState:
    """From statics."""
    (start,) = quasi_static_starts(transient.pair, transient.contacts.step_angle, [transient.friction])
    return start.at(transient.time_step)


def moments(transient: PairTransient, periods: int) -> list[MovingMoment]:
    """From statics, over so many mesh periods."""
    return list(transient.run(started(transient), periods))
