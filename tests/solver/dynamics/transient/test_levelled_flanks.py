"""Transients of a pair whose flanks are meshed in levels: the compliance is then known by products alone.

Yang's pair on 1.4 mm of its face, at level quick, one mode of each harmonic, friction 0.2.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.contact.newton.applied_compliance import AppliedCompliance
from evolvent.contact.transient.time_scheme import TimeScheme
from evolvent.dynamics.modes.gear_modes import GearModes, ModeChoice, gear_modes
from evolvent.dynamics.modes.mode_meshes import mode_mesh
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import Drive, MovingPair
from evolvent.dynamics.transient.pair_transient import MovingMoment, PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import yang

POSITIONS, FRICTION = 8, 0.2


def problem() -> GearProblem:
    """With one level."""
    pair = yang()
    pinion, wheel = (replace(gear, face_width=1.4) for gear in pair.gears)
    narrow = GearPair(pinion, wheel, pair.centre_distance)
    return GearProblem(narrow, 20e3, mesh=MeshSettings("quick", two_level=True))


@cache
def condensed() -> tuple[GearModel, tuple[GearModes, GearModes]]:
    """The pair and its modes."""
    model = prepare_model(problem(), MPI.COMM_SELF).model
    pinion, wheel = (gear_modes(body, ModeChoice(0.0, 1), mode_mesh(problem(), body)) for body in model.bodies)
    return model, (pinion, wheel)


def moving(count: int, friction: float, rpm: float) -> PairTransient:
    """With one mode of each harmonic or none; the pinion has the torque, and the wheel turns uniformly."""
    model, gears = condensed()
    inertia = gears[0].moment_of_inertia
    drive = Drive.at_constant_speed(model.load.on, inertia, (model.load.torque, model.load.torque * model.pair.ratio))
    if not count:
        gears = (without(gears[0]), without(gears[1]))
    pair = MovingPair(model, gears, drive, 0.02, 0.5)
    kept = KeptContacts(pair, POSITIONS, 3 if friction else 1)
    return PairTransient(pair, friction, 2.0 * np.pi * rpm / 60.0, TimeScheme(0.5), kept)


def without(gear: GearModes) -> GearModes:
    """Its moment of inertia alone."""
    nothing = np.zeros(gear.count, dtype=bool)
    return replace(gear, modes=gear.modes.some(nothing), spun=gear.spun[nothing])


def first(transient: PairTransient) -> MovingMoment:
    """The end of the first time step from statics, whose balances have been certified."""
    (start,) = quasi_static_starts(transient.pair, transient.contacts.step_angle, [transient.friction])
    return next(transient.run(start.at(transient.time_step), 1))


@pytest.mark.slow
def test_a_long_step_is_statics() -> None:
    """A time step of 1e6 s, without friction: the transmission error with modes is that without to 1e-7, and the mesh
    force is the load's. Compliances are known by products."""
    found = []
    for count in (0, 1):
        slow = moving(count, 0.0, 1.0)
        slow = replace(slow, speed=slow.contacts.step_angle / 1e6)
        moment = first(slow)
        assert moment.mesh_force == pytest.approx(slow.pair.drive.torque / slow.pair.lever, rel=1e-8)
        assert all(isinstance(at.compliance, AppliedCompliance) for at in slow.contacts.kept.values())
        found.append(moment.result.transmission_error)
    assert found[1] == pytest.approx(found[0], rel=1e-7)


@pytest.mark.slow
def test_a_step_with_friction_is_in_balance() -> None:
    """3000 r/min, μ = 0.2, one mode of each harmonic of both gears: momentum and reaction hold to 1e-8, for another
    motion than without modes."""
    found = [first(moving(count, FRICTION, 3000.0)) for count in (0, 1)]
    for moment in found:
        assert moment.residuals.momentum < 1e-8 and moment.residuals.reaction < 1e-8
    errors = [moment.result.transmission_error for moment in found]
    assert abs(errors[1] / errors[0] - 1.0) > 1e-5
    assert len(found[1].state.vibration) == 17 + 60
