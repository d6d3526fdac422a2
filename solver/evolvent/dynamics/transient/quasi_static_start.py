"""The state in which a transient begins: statics, turning at the rate at which the equilibrium turns."""

from __future__ import annotations

import numpy as np

from evolvent.contact.transient.time_scheme import MotionState
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_transient import PairState, PairTransient
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats

BEFORE = 4
"""Positions that are solved before the first one: friction then has a history."""


def quasi_static_start(transient: PairTransient) -> PairState:
    """At pinion rotation 0. Raises NotConverged, SearchError."""
    pair, step, μ = transient.pair, transient.contacts.step_angle, transient.friction
    pitch = Pitch(tuple(float(step * k) for k in range(-BEFORE, 1)))
    swept = list(sweep_pitch(pair.model, pitch, [μ], initial_state([μ])))
    earlier, last = (_coordinates(pair, position.results[0]) for position in swept[-2:])
    rate = (last - earlier) / transient.time_step
    motion = MotionState(last, rate, np.zeros(len(rate)))
    (history,) = swept[-1].state.histories
    return PairState(motion, history, np.zeros(pair.count), swept[-1].state.patch)


def _coordinates(pair: MovingPair, result: PositionResult) -> Floats:
    """Modes and ψ (m + 1,) of a static position."""
    modes = pair.static((result.pinion_rows, result.wheel_rows), (result.pinion_forces, result.wheel_forces))
    return np.append(modes, pair.drive.of(result.stand.extra, pair.base_radii))
