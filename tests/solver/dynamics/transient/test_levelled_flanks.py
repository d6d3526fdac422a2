"""Transients of a pair whose flanks are meshed in levels: the compliance is then known by products alone.

A helical pair 3 mm wide, one level on 6 × 2 coarse cells, one mode of each harmonic, friction 0.2.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.contact.newton.applied_compliance import AppliedCompliance
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.modes.gear_modes import GearModes, ModeChoice, gear_modes
from evolvent.dynamics.modes.mode_meshes import mode_mesh
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import Drive, MovingPair
from evolvent.dynamics.transient.pair_transient import MovingMoment, PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.scene.gear_problem import gear_problem
from tests.support.gear_cases import few_cells, helical_scene

POSITIONS, FRICTION = 8, 0.2


def problem() -> GearProblem:
    """With one level."""
    narrow = helical_scene("pinion.face_width_mm=3", "wheel.face_width_mm=3", "load.torque_Nm=60")
    return replace(gear_problem(narrow), mesh=MeshSettings("quick", two_level=True))


@cache
def condensed() -> tuple[GearModel, tuple[GearModes, GearModes]]:
    """The pair and its modes: of the pinion on the coarse sector that a run takes, of the wheel on that of its levels.
    """
    model, choice = prepare_model(problem(), MPI.COMM_SELF, few_cells).model, ModeChoice(0.0, 1)
    pinion, wheel = model.bodies
    coarse = mode_mesh(problem(), pinion)
    assert coarse is not None
    return model, (gear_modes(pinion, choice, coarse), gear_modes(wheel, choice, wheel.mesh))


def moving(friction: float, rpm: float) -> PairTransient:
    """The pinion has the torque, and the wheel turns uniformly."""
    model, gears = condensed()
    inertia = gears[0].moment_of_inertia
    drive = Drive.at_constant_speed(model.load.on, inertia, (model.load.torque, model.load.torque * model.pair.ratio))
    pair = MovingPair(model, gears, drive, 0.02, 0.5)
    kept = KeptContacts(pair, POSITIONS, 3 if friction else 1)
    return PairTransient(pair, friction, MeshSpeed(rpm, model.pair.pinion.z), TimeScheme(0.5), kept)


def first(transient: PairTransient) -> MovingMoment:
    """The end of the first time step from statics, whose balances have been certified."""
    (start,) = quasi_static_starts(transient.pair, transient.contacts.step_angle, [transient.friction])
    return next(transient.run(start.at(transient.time_step), 1))


@pytest.mark.evidence
def test_a_step_with_friction_is_in_balance() -> None:
    """3000 r/min, μ = 0.2, one mode of each harmonic of both gears: the step solved with products alone is in balance.
    Momentum and reaction, summed from the nodes' forces and displacements, hold to 1e-8, and the modes vibrate."""
    fast = moving(FRICTION, 3000.0)
    moment = first(fast)
    assert moment.residuals.momentum < 1e-8 and moment.residuals.reaction < 1e-8
    assert all(isinstance(at.compliance, AppliedCompliance) for at in fast.contacts.store.kept.values())
    assert len(moment.state.vibration) == 20 + 24
    assert np.abs(moment.state.vibration).max() > 1e-5 * np.abs(moment.state.motion.position).max()
