"""Motions at one speed by time integration over many mesh periods, whether they repeat with the mesh or not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.oscillator.steady_state import Scales
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, period_map
from evolvent_meshes.arrays import Floats

MOST_PERIODS = 4000
"""Most mesh periods integrated until a motion repeats; at a damping ratio of 0.01 a disturbance has then decayed to
1e-100."""
FEWEST_PERIODS = 1000
"""Lower limit of `decay_periods`, the mesh periods integrated at a speed that a pair comes to with a motion on no
branch. They are limited as such motions may go on without repeating over many speeds."""
LONGEST_REPEAT = 16
"""Most mesh periods in a repeat of a subharmonic motion that is recognised as one."""
SETTLED = 1e-9
"""Change from repeat to repeat, over the static deflection, of a motion that has settled."""
DIFFERENT = 1e-5
"""Least change after fewer mesh periods of a motion that repeats after several. A motion that spirals in on a steady
state comes closest to itself after several, too."""


@dataclass(frozen=True, eq=False)
class Settled:
    """Final motion of a time integration."""

    state: Floats
    """State (2,) at phase 0: s [mm] and ṡ [mm/s]."""
    repeats: int
    """Mesh periods after which the motion repeats: 1 with the mesh, more where it is subharmonic, 0 where it does not
    within `LONGEST_REPEAT`: quasi-periodic, chaotic, not settled after `MOST_PERIODS`, or escaped."""
    waited: int
    """Number of mesh periods integrated."""
    escaped: bool = False
    """Whether the motion grew beyond measure (`TorsionalModel.escaped`); `state` is then the last one within."""


def settled(model: TorsionalModel, period: float, start: Floats, most: int = MOST_PERIODS) -> Settled:
    """Integrates from a state (2,) at phase 0 until the motion repeats. period: of the mesh [s]."""
    scales, state = Scales.of(model).array, np.asarray(start, dtype=float)
    last = np.full((LONGEST_REPEAT, 2), np.inf)
    for count in range(1, most + 1):
        last = np.vstack([state, last[:-1]])
        state = period_map(model, period, state)[0]
        if model.escaped(state):
            return Settled(last[0], 0, count, escaped=True)
        change = np.abs((last - state) / scales).max(axis=1)
        close = change <= SETTLED
        repeats = int(np.argmax(close)) + 1
        if close.any() and (change[: repeats - 1] > DIFFERENT).all():
            return Settled(state, repeats, count)
    return Settled(state, 0, most)


def decay_periods(model: TorsionalModel, period: float) -> int:
    """Mesh periods [s] in which a disturbance dies out in contact, to `SETTLED` twice over; `FEWEST_PERIODS` at least,
    `MOST_PERIODS` at most."""
    rate = (model.damping + model.ground_damping) / (2.0 * model.mass) * period
    return int(np.clip(2.0 * np.log(1.0 / SETTLED) / max(rate, 1e-9), FEWEST_PERIODS, MOST_PERIODS))


def static_state(model: TorsionalModel) -> Floats:
    """State (2,) at rest under the load on the stiffest mesh: a start for `settled`."""
    return np.array([model.load / model.law.stiffest, 0.0])
