"""Figures of a pair at its operating speed, and their change with wear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.oscillator.response import response

UM = 1e3  # µm per mm


@dataclass(frozen=True)
class OperationFigures:
    """A pair at its operating speed, in numbers."""

    speed_rpm: float
    """Speed of the pinion."""
    natural_speed_rpm: float
    """Speed of the pinion at which the mesh frequency is the natural frequency at the mean stiffness in motion."""
    mean_stiffness_N_per_um: float
    """Mesh stiffness of the whole face under the static torque, mean over the pitch, with the series compliance: the
    secant one where dynamics.mesh is secant, else the tangent one."""
    mean_secant_stiffness_N_per_um: float
    """Force over the deflection beyond first contact, mean over the pitch, without the series compliance."""
    unloaded_peak_to_peak_um: float
    """Peak-to-peak value of the unloaded transmission error."""
    static_peak_to_peak_um: float
    """Peak-to-peak value of the transmission error under the static torque."""
    equivalent_amplitude_um: float
    """√ΣA_r² of the first three mesh harmonics of s = r_b1 θ_1 − r_b2 θ_2, the unloaded transmission error in it."""
    static_force_N: float
    """Static mesh force: torque over base radius."""
    largest_force_N: float
    """Largest mesh force, damping included."""
    heaviest_torque_share: float
    """Largest mesh force over that of the heaviest torque of the force surface; above 1 the surface is extrapolated
    linearly. NaN, in JSON null, with another model of the mesh."""
    smallest_force_N: float
    """Smallest mesh force: below 0 where back flanks press, or the damper pulls."""
    separated_share: float
    """Share of the time in which no flanks touch."""
    lifted_share: float
    """Share of the pitch in which the contact is computed under a thousandth of the static force, because flanks
    separate or the mesh force is less."""
    repeats: int
    """Mesh periods after which the motion repeats; 0 where it does not within sixteen. Where they are several, contact
    is computed under their largest force at each phase, wear under their mean force."""

    @staticmethod
    def of(operation: Operation) -> OperationFigures:
        """Figures of a pair's operation."""
        pair, excitation = operation.drive, operation.excitation
        number = int(np.argmin(np.abs(excitation.loaded.forces - pair.model.load)))
        found = response(pair.model, operation.speed.mesh_period, operation.state, operation.repeats)
        return OperationFigures(
            speed_rpm=operation.speed.rpm, natural_speed_rpm=pair.natural_speed,
            mean_stiffness_N_per_um=1e-3 * pair.mean_stiffness,
            mean_secant_stiffness_N_per_um=1e-3 * float(np.mean(excitation.secant[:, number])),
            unloaded_peak_to_peak_um=UM * float(np.ptp(excitation.unloaded_error)),
            static_peak_to_peak_um=UM * float(np.ptp(excitation.loaded.errors[:, number])),
            equivalent_amplitude_um=UM * found.equivalent_amplitude, static_force_N=pair.model.load,
            largest_force_N=found.largest_force, heaviest_torque_share=operation.heaviest_torque_share,
            smallest_force_N=found.smallest_force, separated_share=found.separated_share, lifted_share=operation.lifted,
            repeats=operation.repeats,
        )


@dataclass(frozen=True)
class OperationFacts(OperationFigures):
    """operation.json: a pair at its operating speed, and its gear bodies."""

    bodies: str
    """elastic or rigid gear bodies, as in dynamics.json."""

    @staticmethod
    def of(operation: Operation) -> OperationFacts:
        """Facts of a pair's operation."""
        return OperationFacts(
            **asdict(OperationFigures.of(operation)), bodies=operation.drive.settings.bodies_named
        )


def operation_warnings(found: Sequence[OperationFigures]) -> list[str]:
    """Warnings on contact and wear that are computed under the mesh forces of these vibrations."""
    sentences = []
    shares = [each.heaviest_torque_share for each in found if each.heaviest_torque_share > 1.0]
    if (largest := max(shares, default=0.0)) > 1.0:
        sentences.append(
            f"dynamics.torque_percents: the largest mesh force at the operating speed is {largest:.3g} times that of "
            "the heaviest torque; beyond that the force goes on straight. Add heavier ones until this is below 1"
        )
    if several := [each.repeats for each in found if each.repeats != 1]:
        what = f"after {several[-1]} meshes" if several[-1] else "not within sixteen meshes"
        sentences.append(
            f"the vibration at the operating speed does not repeat with every mesh, but {what}: stresses are those "
            "under the largest force of these at each phase; where the flanks wear, they and the wear are those under "
            "the mean force, and single meshes have larger stresses"
        )
    return sentences


@dataclass(frozen=True)
class VibrationRow(OperationFigures):
    """A line of vibration.csv: the worn pair after some cycles."""

    cycles: float
    """Revolutions of the pinion."""

    @staticmethod
    def after(cycles: float, operation: Operation) -> VibrationRow:
        """Row of an operation after so many revolutions of the pinion."""
        return VibrationRow(**asdict(OperationFigures.of(operation)), cycles=cycles)
