"""The speeds at which a scene's vibration is computed."""

from __future__ import annotations

import numpy as np

from evolvent.dynamics.mesh_oscillator import FROM, TO
from evolvent.dynamics.mesh_oscillator import sweep_at as sweep_at
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.arrays import Floats

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


def _even(natural_speed: float, section: DynamicsSection, count: int) -> Floats:
    """Evenly spaced speeds (count,) over the range of the section [r/min]."""
    low, high = section.speed_rpm or (FROM * natural_speed, TO * natural_speed)
    return np.linspace(low, high, count)
