"""The path over a mesh period, with the force on both sides of the instants at which contact begins or ends."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from evolvent.dynamics.oscillator.mesh_law import MeshLaw, linear_side, no_side
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, history

MASS, STIFFNESS, LOAD = 0.77e-3, 258.6e3, 2412.0
NATURAL, STATIC = float(np.sqrt(STIFFNESS / MASS)), LOAD / STIFFNESS


def damped(share: float, apart: bool = False) -> TorsionalModel:
    """Constant stiffness without transmission error or back flanks."""
    law = MeshLaw(linear_side(np.full(4, STIFFNESS), np.zeros(4)), no_side())
    return TorsionalModel(MASS, LOAD, law, 2.0 * share * MASS * NATURAL, apart)


def test_largest_force_is_that_just_after_a_blow() -> None:
    """A mass that the load F moves onto the flanks from a distance h strikes with v = √(2Fh/m). Critically damped, the
    force falls from then on: the largest is c v, to 1e-9. No phase at which the path is recorded is near the blow."""
    one, distance = damped(1.0), 5.0 * STATIC
    fall = np.sqrt(2.0 * MASS * distance / LOAD)
    path = history(one, 1.3 * fall, np.array([-distance, 0.0]))
    exact = one.damping * np.sqrt(2.0 * LOAD * distance / MASS)
    assert path.force.max() < 0.8 * exact
    assert path.largest_force == pytest.approx(exact, rel=1e-9)
    assert path.smallest_force == pytest.approx(0.0, abs=1e-9 * LOAD)


def test_smallest_force_is_that_just_before_flanks_part() -> None:
    """Released at x = A, x = x₀ + (A − x₀) e^(−ζωt) [cos ω_d t + ζω/ω_d sin ω_d t], and where that is 0 the damper
    pulls with c ẋ, more than at any other time in contact; then the force is 0. To 1e-9."""
    share, size = 0.05, 3.0 * STATIC
    one, rate, turn = damped(share), share * NATURAL, NATURAL * np.sqrt(1.0 - share**2)

    def x(t: float) -> float:
        swing = np.cos(turn * t) + rate / turn * np.sin(turn * t)
        return float(STATIC + (size - STATIC) * np.exp(-rate * t) * swing)

    parting = brentq(x, 0.0, np.pi / turn, xtol=1e-16, rtol=1e-14)
    speed = -(size - STATIC) * np.exp(-rate * parting) * NATURAL**2 / turn * np.sin(turn * parting)
    path = history(one, 1.2 * parting, np.array([size, 0.0]))
    assert path.side.tolist()[-1] == 0
    assert path.smallest_force == pytest.approx(one.damping * speed, rel=1e-9)
    assert path.smallest_force < path.force.min()


def test_force_of_a_damper_that_always_acts_does_not_jump() -> None:
    """With damping in free flight, too, the force just before the blow is that just after it: the path through the
    instant of contact has it, to 1e-6."""
    one, distance = damped(1.0, apart=True), 5.0 * STATIC
    path = history(one, 20.0 / NATURAL, np.array([-distance, 0.0]), np.linspace(0.0, 1.0, 20001))
    assert {0, 1} <= set(path.side.tolist())
    assert path.largest_force == pytest.approx(path.force.max(), rel=1e-6)
