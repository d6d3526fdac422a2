"""Tables of a pair's excitation: over the pitch under each torque, and their mesh harmonics."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.results.curves import (
    LOADED,
    NO_COMPANION,
    SECANT,
    TANGENT,
    CoarseExcitation,
    PitchCurve,
    pitch_curves,
    unloaded_curve,
)
from evolvent.results.tables.table import Table

NO_TORQUE = 0.0
"""Of the unloaded transmission error [N·m]."""


@dataclass(frozen=True)
class ExcitationRow:
    """A line of excitation.csv: a position under a torque."""

    pinion_angle_deg: float
    """Rotation of the pinion; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
    torque_Nm: float
    """On the gear that the scene names."""
    mesh_force_N: float
    """That torque over the base radius, in the transverse section."""
    unloaded_transmission_error_um: float
    """e: r_b1 φ_1 − r_b2 φ_2 at which the flanks just touch, by geometry, within 1 nm."""
    transmission_error_um: float
    """The same under the torque, without friction."""
    transmission_error_um_error: float
    """Its estimated error by the mesh; NaN where there is no coarse companion (`output.error_bars`)."""
    tangent_stiffness_N_per_um: float
    """Change of the mesh force by the transmission error, of the whole face."""
    tangent_stiffness_N_per_um_error: float
    """Its estimated error by the mesh."""
    secant_stiffness_N_per_um: float
    """Mesh force over what the torque adds to the unloaded transmission error."""
    secant_stiffness_N_per_um_error: float
    """Its estimated error by the mesh."""


@dataclass(frozen=True)
class HarmonicRow:
    """A line of harmonics.csv: a mesh harmonic of a quantity under a torque."""

    quantity: str
    """As in excitation.csv."""
    torque_Nm: float
    """0 of the unloaded transmission error."""
    mean: float
    """Over the pitch, in the quantity's unit, like all that follows but the phase."""
    mean_error: float
    """Its estimated error, by the mesh and by the spacing of the positions; NaN where there is no coarse companion."""
    peak_to_peak: float
    """Largest less smallest value of the positions."""
    peak_to_peak_error: float
    """Its estimated error, likewise."""
    harmonic: int
    """1 at the frequency of the mesh."""
    amplitude: float
    """A of A cos(2π r φ z_1/2π + ψ)."""
    amplitude_error: float
    """Its estimated error, likewise."""
    phase_deg: float
    """ψ."""


EXCITATION, HARMONICS = Table("excitation.csv", ExcitationRow), Table("harmonics.csv", HarmonicRow)


def excitation_rows(
    excitation: MeshExcitation, radius: float, companion: CoarseExcitation = NO_COMPANION
) -> list[ExcitationRow]:
    """The lightest torque first. radius: base radius of the gear with the torque [mm]."""
    loaded, unloaded, rows = excitation.loaded, unloaded_curve(excitation).values, []
    for force, curves in zip(loaded.forces, pitch_curves(excitation, companion)):
        error, tangent, secant = curves[LOADED], curves[TANGENT], curves[SECANT]
        of_error, of_tangent, of_secant = error.bars, tangent.bars, secant.bars
        for k, angle in enumerate(np.degrees(loaded.angles)):
            rows.append(ExcitationRow(
                pinion_angle_deg=float(angle), torque_Nm=1e-3 * float(force) * radius, mesh_force_N=float(force),
                unloaded_transmission_error_um=float(unloaded[k]), transmission_error_um=float(error.values[k]),
                transmission_error_um_error=float(of_error[k]), tangent_stiffness_N_per_um=float(tangent.values[k]),
                tangent_stiffness_N_per_um_error=float(of_tangent[k]),
                secant_stiffness_N_per_um=float(secant.values[k]), secant_stiffness_N_per_um_error=float(of_secant[k]),
            ))
    return rows


def harmonic_rows(
    excitation: MeshExcitation, radius: float, companion: CoarseExcitation = NO_COMPANION
) -> list[HarmonicRow]:
    """All quantities of excitation.csv that vary over the pitch; as many harmonics as its positions hold, at most five.
    """
    rows = list(_harmonics(NO_TORQUE, unloaded_curve(excitation)))
    for force, curves in zip(excitation.loaded.forces, pitch_curves(excitation, companion)):
        for curve in curves.values():
            rows += _harmonics(1e-3 * float(force) * radius, curve)
    return rows


def _harmonics(torque: float, curve: PitchCurve) -> Iterator[HarmonicRow]:
    mean, size = float(curve.values.mean()), float(np.ptp(curve.values))
    parts = *curve.harmonics, curve.amplitude_errors
    for r, (amplitude, phase, error) in enumerate(zip(*parts), 1):
        yield HarmonicRow(
            quantity=curve.quantity, torque_Nm=torque, mean=mean, mean_error=curve.mean_error, peak_to_peak=size,
            peak_to_peak_error=curve.peak_to_peak_error, harmonic=r, amplitude=float(amplitude),
            amplitude_error=float(error), phase_deg=float(np.degrees(phase)),
        )
