"""Motions that touch a side of the teeth for a moment."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.oscillator.mesh_law import MeshLaw, behind, linear_side
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, period_map
from evolvent_meshes.arrays import Floats

MASS, STIFFNESS, LOAD = 0.77e-3, 258.6e3, 2412.0
NATURAL = float(np.sqrt(STIFFNESS / MASS))
STATIC = LOAD / STIFFNESS
BACKLASH = 5.0 * STATIC


def flight() -> TorsionalModel:
    """Constant stiffness, undamped."""
    side = linear_side(np.full(4, STIFFNESS), np.zeros(4))
    return TorsionalModel(MASS, LOAD, MeshLaw(side, behind(side, BACKLASH)))


def exact(depth: float, after: float) -> Floats:
    """State (2,) of a flight that would go `depth` [mm] beyond the back flanks, so that it reaches them with
    v² = 2 depth F/m, `after` [s] that: it touches them for 2/ω · arctan(ωv m/F) and flies on."""
    speed = np.sqrt(2.0 * depth * LOAD / MASS)
    touched = 2.0 / NATURAL * np.arctan(NATURAL * speed * MASS / LOAD)
    t = after - touched
    return np.array([-BACKLASH + speed * t + 0.5 * LOAD / MASS * t**2, speed + LOAD / MASS * t])


@pytest.mark.parametrize("depth", [1e-2, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("part", [0.137, 0.1411, 0.1499])
def test_touching_for_a_moment(depth: float, part: float) -> None:
    """A flight that would go `depth` deflections beyond the back flanks, wherever in a step it turns there: its exact
    state after the period, 1e-11 of the deflection. Missed, the touch leaves an error of depth^(3/2)."""
    period = 2.0 / NATURAL
    before, after = part * period, (1.0 - part) * period
    speed = np.sqrt(2.0 * depth * STATIC * LOAD / MASS)
    start = np.array([-BACKLASH + speed * before + 0.5 * LOAD / MASS * before**2, -speed - LOAD / MASS * before])
    found, _ = period_map(flight(), period, start)
    scale = STATIC * np.array([1.0, NATURAL])
    assert found / scale == pytest.approx(exact(depth * STATIC, after) / scale, abs=1e-11)
