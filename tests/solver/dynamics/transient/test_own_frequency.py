"""The natural frequency of a spur pair in plane strain on its mesh."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.own_frequency import own_frequency
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from tests.support.running.transient_pairs import condensed, moving, started

POSITIONS, PERIODS = 120_000, 3


@cache
def at_rotation_0() -> PositionResult:
    (position,) = sweep_pitch(condensed("spur"), Pitch((0.0,)), [0.0], initial_state([0.0]))
    return position.results[0]


def test_without_modes() -> None:
    """Exact: √(k/m) with the tangent stiffness of the mesh and the inertia along the line of action."""
    pair, position = moving("spur", 0.0, 30.0, count=0).pair, at_rotation_0()
    exact = np.sqrt(position.stiffness / (pair.drive.inertia / pair.lever**2)) / (2.0 * np.pi)
    assert own_frequency(pair, [position]) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("count", [0, 3])
def test_pair_swings_at_it(count: int) -> None:
    """Problem: at 1 r/min the pair swings undamped about statics, pushed by a fiftieth of its static deflection.
    Exact: the harmonic that fits its course best has the frequency, which time steps lower by 0.4 % and which changes
    as the contact turns by a hundredth of a degree."""
    slow = moving("spur", 0.0, 1.0, count=count, free=True)
    pair = replace(slow.pair, mesh_damping=0.0, damping_ratio=0.0)
    case = replace(slow, pair=pair, scheme=TimeScheme(1.0), contacts=KeptContacts(pair, POSITIONS, 1))
    wanted = own_frequency(pair, [at_rotation_0()])
    state, step = started(case), case.time_step
    steps = int(np.ceil(PERIODS / wanted / step))
    assert 1.0 / wanted / step > 25.0
    push = 2.0 * np.pi * wanted * 0.02 * at_rotation_0().transmission_error / pair.lever
    velocity = np.append(np.zeros(pair.count), push)
    state = replace(state, motion=replace(state.motion, velocity=state.motion.velocity + velocity))
    errors = np.array([moment.result.transmission_error for moment, _ in zip(case.run(state, 1), range(steps))])
    frequencies = np.linspace(0.8, 1.25, 2001) * wanted
    time = step * np.arange(1, steps + 1)
    basis = np.stack([np.ones(steps), time])
    left = []
    for f in frequencies:
        wave = np.exp(2j * np.pi * f * time)
        left.append(_left(np.vstack([basis, wave.real, wave.imag]), errors))
    assert frequencies[int(np.argmin(left))] == pytest.approx(wanted, rel=0.015)


def test_modes_raise_it() -> None:
    """Three modes of each harmonic of each body: the inertia is not all behind what gives way."""
    rigid, soft = (own_frequency(moving("spur", 0.0, 30.0, count).pair, [at_rotation_0()]) for count in (0, 3))
    assert soft > 1.01 * rigid


def _left(basis: np.ndarray, values: np.ndarray) -> float:  # type: ignore[type-arg]
    """What the best sum of the rows leaves of the values."""
    weights = np.linalg.lstsq(basis.T, values, rcond=None)[0]
    return float(np.linalg.norm(values - weights @ basis))
