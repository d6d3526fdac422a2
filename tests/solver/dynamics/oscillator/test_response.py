"""Figures of a motion: harmonics of a linear vibration, lines between them, and forces of a blow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.dynamics.oscillator.mesh_law import MeshLaw, linear_side, no_side
from evolvent.dynamics.oscillator.response import HIGHEST_ORDER, histories, response
from evolvent.dynamics.oscillator.settling import settled
from evolvent.dynamics.oscillator.steady_state import steady_state
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel

MASS, STIFFNESS, LOAD = 0.77e-3, 258.6e3, 2412.0
NATURAL, STATIC = float(np.sqrt(STIFFNESS / MASS)), LOAD / STIFFNESS
DAMPING = 2.0 * 0.03 * MASS * NATURAL


def model(swing: float, error: float) -> TorsionalModel:
    """Stiffness and transmission error with one harmonic each."""
    cosine = np.cos(2.0 * np.pi * np.arange(512) / 512)
    side = linear_side(STIFFNESS * (1.0 + swing * cosine), error * cosine)
    return TorsionalModel(MASS, LOAD, MeshLaw(side, no_side()), DAMPING)


def test_spectrum_of_a_linear_vibration() -> None:
    """e = A cos τ on a constant stiffness, without separation: s has the amplitude |A (k + iωc)/(k − mω² + iωc)|, the
    force mω² times that; the first line of both, to 1e-7, and no other, to 1e-7 of it."""
    ω, size = 0.6 * NATURAL, 0.05 * STATIC
    one = model(0.0, size)
    found = steady_state(one, 2.0 * np.pi / ω, np.array([STATIC, 0.0]))
    exact = abs(size * (STIFFNESS + 1j * ω * DAMPING) / (STIFFNESS - MASS * ω**2 + 1j * ω * DAMPING))
    each = response(one, found.period, found.state)
    lines = each.spectrum
    assert lines.orders.tolist() == list(range(1, HIGHEST_ORDER + 1))
    assert lines.total[0] == pytest.approx(exact, rel=1e-7) == pytest.approx(each.total[0])
    assert lines.force[0] == pytest.approx(MASS * ω**2 * exact, rel=1e-7) == pytest.approx(each.force[0])
    assert np.abs(lines.total[1:]).max() < 1e-7 * exact
    assert each.largest_force == pytest.approx(LOAD + MASS * ω**2 * exact, rel=1e-4)


def test_a_doubled_period_has_half_orders() -> None:
    """At twice the resonance a motion that repeats after two meshes turns at the natural frequency: order ½ is its
    strongest line, and the lines taken over two meshes have those of four at the same orders, to 1e-6."""
    one, period = model(0.25, 0.0), 2.0 * np.pi / (2.0 * NATURAL)
    end = settled(one, period, np.array([0.5 * STATIC, 0.0]))
    assert end.repeats == 2
    two, four = (response(one, period, end.state, count) for count in (2, 4))
    lines = two.spectrum
    assert lines.orders.tolist() == [0.5 * i for i in range(1, 2 * HIGHEST_ORDER + 1)]
    assert int(np.argmax(lines.force)) == 0
    assert four.spectrum.force[1::2] == pytest.approx(lines.force, abs=1e-6 * LOAD)
    assert np.abs(four.spectrum.force[::2]).max() < 1e-6 * LOAD
    assert two.force == pytest.approx(lines.force[1:10:2], abs=1e-9 * LOAD)


def test_histories_follow_each_other() -> None:
    """Each mesh period begins where the one before ends; the largest force of the response is that of all of them."""
    one, period = model(0.25, 0.0), 2.0 * np.pi / (2.0 * NATURAL)
    end = settled(one, period, np.array([0.5 * STATIC, 0.0]))
    paths = histories(one, period, end.state, 2, np.arange(256) / 256)
    for before, after in zip(paths, [*paths[1:], paths[0]]):
        assert after.displacement[0] == pytest.approx(before.displacement[-1], abs=1e-7 * STATIC)
    each = response(one, period, end.state, 2)
    assert each.largest_force == max(path.largest_force for path in paths)
    assert each.smallest_force == min(path.smallest_force for path in paths)


def test_forces_of_a_motion_that_does_not_repeat() -> None:
    """Undamped, a thousandth as fast as the mesh: sixteen meshes after the static deflection with a velocity ω A the
    force has risen by 10 % of k A, after a quarter of its own period, within the five hundred that are looked at, by
    k A: 1e-6."""
    one, size = replace(model(0.0, 0.0), damping=0.0), 0.4 * STATIC
    period = 2.0 * np.pi / NATURAL / 1000.0
    found = response(one, period, np.array([STATIC, NATURAL * size]), 0)
    assert found.largest_force == pytest.approx(LOAD + STIFFNESS * size, rel=1e-6)
    sixteen = response(one, period, np.array([STATIC, NATURAL * size]), 16)
    assert sixteen.largest_force < LOAD + 0.11 * STIFFNESS * size
