"""The speeds at which a scene's vibration is computed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep, speeds_to_periods, sweep_speeds
from evolvent.dynamics.pair_model import Drive
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.arrays import Floats

FROM, TO = 1.0 / 6.0, 1.6
"""Lowest and highest speed that are swept by default, over the natural one."""
WAYS = 2
"""Number of motions that are computed at a speed: running up and running down."""
SAME_SPEED = 1e-9
"""Relative difference below which two speeds count as one."""


def sweep_list(natural_speed: float, section: DynamicsSection) -> Floats:
    """Ascending speeds (n,) [r/min]: the section's, evenly spaced, and those of its histories, each once."""
    even, wanted = _even(natural_speed, section, section.speeds), np.array(section.histories_rpm)
    others = [speed for speed in even if not np.isclose(speed, wanted, rtol=SAME_SPEED, atol=0.0).any()]
    return np.sort(np.concatenate([others, wanted]))


def map_list(natural_speed: float, section: DynamicsSection) -> Floats:
    """Ascending speeds (n,) [r/min] of the map over the torque, evenly spaced over the same range.

    natural_speed: under the scene's torque, whatever that of the map's line is.
    """
    return _even(natural_speed, section, section.map_speeds)


def sweep_at(pair: Drive, speeds: Floats, computed: Callable[[], None] = lambda: None) -> SpeedSweep:
    """A pair that runs up and down through ascending speeds (n,) [r/min]. computed: called `WAYS` times a speed. Raises
    NoSteadyState."""
    slowest, fastest = speeds_to_periods(pair.natural_speed * np.array([FROM, TO]), pair.teeth)
    periods = speeds_to_periods(speeds, pair.teeth)
    return sweep_speeds(pair.model, periods, (float(slowest), float(fastest)), computed)


def _even(natural_speed: float, section: DynamicsSection, count: int) -> Floats:
    """Evenly spaced speeds (count,) over the range of the section [r/min]."""
    low, high = section.speed_rpm or (FROM * natural_speed, TO * natural_speed)
    return np.linspace(low, high, count)
