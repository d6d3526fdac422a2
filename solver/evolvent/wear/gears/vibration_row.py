"""What wear does to the vibration of a pair: figures of its operation, after each block of cycles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.oscillator.response import response
from evolvent.dynamics.oscillator.settling import LONGEST_REPEAT

UM = 1e3  # µm per mm


@dataclass(frozen=True)
class VibrationRow:
    """A line of vibration.csv: the operation of the pair as worn after some cycles."""

    cycles: float
    """Revolutions of the pinion."""
    mean_stiffness_N_per_um: float
    """Tangent mesh stiffness of the whole face under the static torque, mean over the pitch."""
    natural_speed_rpm: float
    """Of the pinion, at which the mesh frequency is the natural one at that stiffness."""
    unloaded_peak_to_peak_um: float
    """Of the unloaded transmission error."""
    static_peak_to_peak_um: float
    """Of the transmission error under the static torque."""
    equivalent_amplitude_um: float
    """√ΣA_r² of the first three mesh harmonics of s = r_b1 θ_1 − r_b2 θ_2 at the operating speed."""
    largest_force_N: float
    """Largest mesh force."""
    smallest_force_N: float
    """Smallest one."""
    separated_share: float
    """Share of the time in which no flanks touch."""
    repeats: int
    """Mesh periods after which the motion repeats; 0 where it does not within sixteen."""

    @staticmethod
    def of(cycles: float, operation: Operation) -> VibrationRow:
        """After so many revolutions of the pinion."""
        pair, excitation = operation.drive, operation.excitation
        number = int(np.argmin(np.abs(excitation.loaded.forces - pair.model.load)))
        found = response(pair.model, operation.period, operation.state, operation.repeats or LONGEST_REPEAT)
        return VibrationRow(
            cycles, 1e-3 * pair.mean_stiffness, pair.natural_speed, UM * float(np.ptp(excitation.unloaded_error)),
            UM * float(np.ptp(excitation.loaded.errors[:, number])), UM * found.equivalent_amplitude,
            found.largest_force, found.smallest_force, found.apart, operation.repeats,
        )  # fmt: skip
