"""Derivative of the pressures by the gaps, against equilibria with other gaps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent import NotConverged
from evolvent.contact.newton.equilibrium import frictionless
from evolvent.contact.newton.pressure_sensitivity import PressureSensitivity
from evolvent.gears.sweep.position_search import shared_position
from tests.support.gear_cases import model_of, spur_scene

STEP = 1e-7  # mm


def test_sensitivity_is_the_derivative_of_the_pressures() -> None:
    """He's pair with two teeth in contact: ∂λ for a wavy opening = the central difference of two solved states, within
    1e-4 of its norm over the points that are pressed in both; where nothing was pressed it is zero."""
    model = model_of(spur_scene())
    shared = shared_position(model, np.radians(3.0), (0.0, 0.0), [0.0], None)
    operator, smooth = shared.system.operator, shared.smooth
    opening = np.cos(40.0 * operator.points[:, 0]) * np.sin(25.0 * operator.points[:, 1])
    lower, upper = (
        frictionless(replace(shared.system, operator=replace(operator, gap=operator.gap + sign * STEP * opening)))
        for sign in (-1.0, 1.0)
    )
    slope = (upper.traction[:, 0] - lower.traction[:, 0]) / (2.0 * STEP)
    found = PressureSensitivity(shared.system, smooth)(opening)
    pressed = np.minimum(lower.traction[:, 0], upper.traction[:, 0]) > 0.0
    assert pressed.sum() > 20
    assert np.linalg.norm((found - slope)[pressed]) < 1e-4 * np.linalg.norm(slope[pressed])
    assert not found[smooth.traction[:, 0] == 0.0].any()


def test_pressure_changes_keep_the_load() -> None:
    """The torque is prescribed, so that the change of the pressure has no torque: Hᵀ ∂f = 0."""
    model = model_of(spur_scene())
    shared = shared_position(model, np.radians(1.0), (0.0, 0.0), [0.0], None)
    operator = shared.system.operator
    change = PressureSensitivity(shared.system, shared.smooth)(np.linspace(0.0, 1e-3, len(operator.weights)))
    moment = shared.system.motion.T @ operator.forces(change[:, None]).ravel()
    size = np.abs(shared.system.motion).T @ np.abs(operator.forces(change[:, None]).ravel())
    assert abs(moment[0]) < 1e-10 * size[0]


def test_sensitivity_of_an_open_contact_is_refused() -> None:
    """Without a point in contact there is no derivative: NotConverged."""
    model = model_of(spur_scene())
    shared = shared_position(model, 0.0, (0.0, 0.0), [0.0], None)
    apart = replace(shared.smooth, traction=np.zeros_like(shared.smooth.traction))
    with pytest.raises(NotConverged, match="no node in contact"):
        PressureSensitivity(shared.system, apart)
