"""Oscillators that are swept over the speed, whether their mesh was computed or is given."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed, speeds_to_periods
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep, sweep_speeds
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats

FROM, TO = 1.0 / 6.0, 1.6
"""Speeds from and to which branches of steady states are followed at least, over the natural one."""


class MeshOscillator(Protocol):
    """An oscillator that a mesh excites."""

    @property
    def model(self) -> TorsionalModel:
        """Equation of motion."""

    @property
    def teeth(self) -> int:
        """Number of teeth of the pinion."""

    @property
    def natural_speed(self) -> float:
        """Speed of the pinion at which the mesh frequency is the natural frequency [r/min]."""

    def body_speed(self, harmonic: int) -> float:
        """Speed of the pinion at which this mesh harmonic excites the gear bodies' own vibration [r/min]; infinite
        without any."""


@dataclass(frozen=True, eq=False)
class GivenMesh:
    """An oscillator on a mesh whose stiffness and unloaded error are given."""

    model: TorsionalModel
    """Equation of motion."""
    teeth: int
    """Number of teeth of the pinion."""
    mean_stiffness: float
    """Mean stiffness of the mesh [N/mm]."""

    @property
    def natural_speed(self) -> float:
        """Speed of the pinion at which the mesh frequency is the natural frequency at the mean stiffness [r/min]."""
        return MeshSpeed.of_natural(self.mean_stiffness, self.model.mass, self.teeth).rpm

    def body_speed(self, harmonic: int) -> float:
        """Infinite: there are no gear bodies."""
        return np.inf


def sweep_at(pair: MeshOscillator, speeds: Floats, computed: Callable[[], None] = lambda: None) -> SpeedSweep:
    """A pair that runs up and down through ascending speeds (n,) [r/min]. computed: called twice a speed. Raises
    NoSteadyState."""
    slowest, fastest = speeds_to_periods(pair.natural_speed * np.array([FROM, TO]), pair.teeth)
    periods = speeds_to_periods(speeds, pair.teeth)
    return sweep_speeds(pair.model, periods, (float(slowest), float(fastest)), computed)
