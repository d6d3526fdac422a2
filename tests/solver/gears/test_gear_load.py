"""Torques that vary with the mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.gear_load import GearLoad, TorqueCourse
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import model_of, spur_scene, swept

PITCH = 2.0 * np.pi / 50.0


def test_torque_is_linear_between_phases_and_repeats_with_the_pitch() -> None:
    """Problem: shares 1, 2, 0, 1 of 10 at the quarters of a pitch of 50 teeth. Exact: those, halves between them, and
    the same a pitch later or earlier."""
    load = GearLoad(10.0, Member.WHEEL, TorqueCourse(np.array([1.0, 2.0, 0.0, 1.0]), 50))
    wanted = {0.0: 10.0, 0.25: 20.0, 0.375: 10.0, 0.5: 0.0, 0.625: 5.0, 0.875: 10.0}
    for phase, torque in wanted.items():
        for pitches in (0, 1, -3):
            assert load.at((phase + pitches) * PITCH) == pytest.approx(torque, abs=1e-9)
    assert GearLoad(10.0).at(0.3) == 10.0


def test_positions_are_those_under_the_torque_that_they_have() -> None:
    """Problem: a spur pair whose torque rises from position to position. Exact: at each position forces, transmission
    error and pressures are those under that torque held constant, to what two searches leave."""
    model, degrees = model_of(spur_scene("mesh.level=quick")), np.degrees(PITCH * np.arange(4) / 4)
    shares = np.array([0.5, 1.0, 1.5, 2.0])
    course = replace(model, load=replace(model.load, course=TorqueCourse(shares, 50)))
    (curves,) = swept(course, degrees, [0.0])
    for k, share in enumerate(shares):
        constant = replace(model, load=replace(model.load, torque=share * model.load.torque))
        (alone,) = swept(constant, degrees, [0.0])
        found, wanted = curves.results[k], alone.results[k]
        assert found.torques == pytest.approx(wanted.torques, rel=1e-9)
        assert found.transmission_error == pytest.approx(wanted.transmission_error, rel=1e-8)
        assert found.contact.pressure.max() == pytest.approx(wanted.contact.pressure.max(), rel=1e-6)
