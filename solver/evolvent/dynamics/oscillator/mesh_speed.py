"""A speed of the pinion in its four units: r/min, rad/s, s per mesh, meshes per s."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats

MINUTE = 60.0
"""Seconds of a minute."""


@dataclass(frozen=True)
class MeshSpeed:
    """A speed of the pinion."""

    rpm: float
    """Speed [r/min]."""
    teeth: int
    """Number of teeth of the pinion."""

    @staticmethod
    def of_period(period: float, teeth: int) -> MeshSpeed:
        """Speed at a mesh period [s]."""
        return MeshSpeed(MINUTE / (period * teeth), teeth)

    @staticmethod
    def of_frequency(frequency: float, teeth: int) -> MeshSpeed:
        """Speed at a mesh frequency [Hz]."""
        return MeshSpeed(MINUTE * frequency / teeth, teeth)

    @staticmethod
    def of_natural(stiffness: float, mass: float, teeth: int) -> MeshSpeed:
        """Speed at which the mesh frequency is the natural one of a mass [t] on a stiffness [N/mm]."""
        return MeshSpeed.of_frequency(math.sqrt(stiffness / mass) / (2.0 * math.pi), teeth)

    @property
    def mesh_period(self) -> float:
        """Time from one tooth to the next [s]."""
        return MINUTE / (self.rpm * self.teeth)

    @property
    def mesh_frequency(self) -> float:
        """Teeth in a second [Hz]."""
        return self.rpm / MINUTE * self.teeth

    @property
    def rad_s(self) -> float:
        """Angular speed [rad/s]."""
        return 2.0 * math.pi * self.rpm / MINUTE


def speeds_to_periods(speeds: Floats | float, teeth: int) -> Floats:
    """Mesh periods (n,) [s] at speeds (n,) [r/min] of a gear with so many teeth; at mesh periods the speeds, as both
    are 60/(z x)."""
    return np.asarray(MINUTE / (np.asarray(speeds, dtype=float) * teeth))
