"""Static equilibrium as the initial state of a transient, with the velocity at which this equilibrium changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.transient.time_schemes.time_scheme import KinematicState
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_state import PairState
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.friction_history import FrictionHistory
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats

BEFORE = 4
"""Positions that are solved before the first one, so that friction has a history."""
FEWEST = 5
"""Positions a pitch at the widest spacing of those solved before the first one: further back the same teeth do not
touch any more."""


@dataclass(frozen=True)
class QuasiStaticStart:
    """The static equilibrium at pinion rotation 0, with m modes."""

    position: Floats
    """Amplitudes of the modes, and ψ (m + 1,)."""
    change: Floats
    """Change of modes and ψ (m + 1,) from one position to the next."""
    history: FrictionHistory | None
    """Friction history; None without friction."""
    patch: ContactPatch | None
    """Contact patch of the equilibrium."""

    def at(self, time_step: float) -> PairState:
        """Initial state of a transient. time_step: between two positions [s]."""
        motion = KinematicState(self.position, self.change / time_step, np.zeros(len(self.position)))
        return PairState(motion, self.history, np.zeros(len(self.position) - 1), self.patch)


def quasi_static_starts(pair: MovingPair, step_angle: float, frictions: Sequence[float]) -> list[QuasiStaticStart]:
    """Static equilibria at pinion rotation 0, one for each friction coefficient. step_angle: between positions [rad].
    Raises NotConverged, SearchError."""
    spacing = min(step_angle, 2.0 * np.pi / pair.model.pair.pinion.z / FEWEST)
    pitch = Pitch(tuple(float(spacing * k) for k in range(-BEFORE, 1)))
    before, last = list(sweep_pitch(pair.model, pitch, frictions, initial_state(frictions)))[-2:]
    starts = []
    for earlier, result, history in zip(before.results, last.results, last.state.histories):
        now = _coordinates(pair, result)
        change = (now - _coordinates(pair, earlier)) * (step_angle / spacing)
        starts.append(QuasiStaticStart(now, change, history, last.state.patch))
    return starts


def _coordinates(pair: MovingPair, result: PositionResult) -> Floats:
    """Amplitudes of the modes, and ψ (m + 1,), at a static position."""
    ψ = pair.drive.of(result.stand.beyond_nominal, pair.base_radii)
    return np.append(pair.static(pair.modal_forces(result)), ψ)
