"""Tables of a pair's excitation: over the pitch under each torque, and their mesh harmonics."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
"""Torque under which the unloaded transmission error is tabulated [N·m]."""


@dataclass(frozen=True)
class ExcitationRow:
    """A line of excitation.csv: a position under a torque."""

    pinion_angle_deg: float
    """Rotation of the pinion; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
    case: str
    """Names of the load cases with this torque, or its part of the scene's torque; empty where it has none."""
    torque_Nm: float
    """Torque on the gear that the scene names."""
    mesh_force_N: float
    """Mesh force: the torque over the base radius, in the transverse section."""
    unloaded_transmission_error_um: float
    """Unloaded transmission error e: r_b1 φ_1 − r_b2 φ_2 at which the flanks just touch, by geometry, within 1 nm."""
    transmission_error_um: float
    """Transmission error r_b1 φ_1 − r_b2 φ_2 under the torque, without friction."""
    transmission_error_um_error: float
    """Estimated error of the transmission error by the mesh; NaN where there is no coarse companion
    (`output.error_bars`)."""
    tangent_stiffness_N_per_um: float
    """Tangent mesh stiffness: change of the mesh force by the transmission error, of the whole face."""
    tangent_stiffness_N_per_um_error: float
    """Estimated error of the tangent stiffness by the mesh; NaN where there is no coarse companion
    (`output.error_bars`)."""
    secant_stiffness_N_per_um: float
    """Secant mesh stiffness: mesh force over what the torque adds to the unloaded transmission error."""
    secant_stiffness_N_per_um_error: float
    """Estimated error of the secant stiffness by the mesh; NaN where there is no coarse companion
    (`output.error_bars`)."""


@dataclass(frozen=True)
class HarmonicRow:
    """A line of harmonics.csv: a mesh harmonic of a quantity under a torque."""

    quantity: str
    """Name of the quantity, as in excitation.csv."""
    case: str
    """Names of the load cases with this torque, or its part of the scene's torque; empty where it has none."""
    torque_Nm: float
    """Torque on the gear that the scene names; 0 for the unloaded transmission error."""
    mean: float
    """Mean over the pitch, in the unit of the quantity."""
    mean_error: float
    """Estimated error of the mean, by the mesh and by the spacing of the positions; NaN where there is no coarse
    companion (`output.error_bars`)."""
    peak_to_peak: float
    """Largest less smallest value of the positions, in the unit of the quantity."""
    peak_to_peak_error: float
    """Estimated error of the peak-to-peak value, by the mesh and by the spacing of the positions; NaN where there is no
    coarse companion (`output.error_bars`)."""
    harmonic: int
    """Number r of the mesh harmonic; 1 at the mesh frequency."""
    amplitude: float
    """Amplitude A of the harmonic A cos(2π r φ z_1/2π + ψ), in the unit of the quantity."""
    amplitude_error: float
    """Estimated error of the amplitude, by the mesh and by the spacing of the positions; NaN where there is no coarse
    companion (`output.error_bars`)."""
    phase_deg: float
    """Phase ψ of the harmonic A cos(2π r φ z_1/2π + ψ)."""


EXCITATION, HARMONICS = Table("excitation.csv", ExcitationRow), Table("harmonics.csv", HarmonicRow)


def excitation_rows(
    excitation: MeshExcitation, companion: CoarseExcitation = NO_COMPANION, cases: Sequence[str] = ()
) -> list[ExcitationRow]:
    """Rows of excitation.csv, the lightest torque first. cases: (m,) names of the torques; empty where they have none.
    """
    loaded, unloaded, rows = excitation.loaded, unloaded_curve(excitation).values, []
    known = loaded.torques, loaded.forces, pitch_curves(excitation, companion), _names(excitation, cases)
    for torque, force, curves, case in zip(*known):
        error, tangent, secant = curves[LOADED], curves[TANGENT], curves[SECANT]
        of_error, of_tangent, of_secant = error.bars, tangent.bars, secant.bars
        for k, angle in enumerate(np.degrees(loaded.angles)):
            rows.append(ExcitationRow(
                pinion_angle_deg=float(angle), case=case, torque_Nm=1e-3 * float(torque), mesh_force_N=float(force),
                unloaded_transmission_error_um=float(unloaded[k]), transmission_error_um=float(error.values[k]),
                transmission_error_um_error=float(of_error[k]), tangent_stiffness_N_per_um=float(tangent.values[k]),
                tangent_stiffness_N_per_um_error=float(of_tangent[k]),
                secant_stiffness_N_per_um=float(secant.values[k]), secant_stiffness_N_per_um_error=float(of_secant[k]),
            ))
    return rows


def harmonic_rows(
    excitation: MeshExcitation, companion: CoarseExcitation = NO_COMPANION, cases: Sequence[str] = ()
) -> list[HarmonicRow]:
    """Rows of harmonics.csv: all quantities of excitation.csv that vary over the pitch, each with as many harmonics as
    its positions hold, at most five. cases: as of `excitation_rows`."""
    rows = list(_harmonics("", NO_TORQUE, unloaded_curve(excitation)))
    curves_of_each = pitch_curves(excitation, companion)
    for torque, curves, case in zip(excitation.loaded.torques, curves_of_each, _names(excitation, cases)):
        for curve in curves.values():
            rows += _harmonics(case, 1e-3 * float(torque), curve)
    return rows


def _names(excitation: MeshExcitation, cases: Sequence[str]) -> Sequence[str]:
    """Name of each torque of an excitation, the heaviest of which may have been left out. cases: of all of them."""
    return cases or [""] * len(excitation.loaded.torques)


def _harmonics(case: str, torque: float, curve: PitchCurve) -> Iterator[HarmonicRow]:
    mean, size = float(curve.values.mean()), float(np.ptp(curve.values))
    parts = *curve.harmonics, curve.amplitude_errors
    for r, (amplitude, phase, error) in enumerate(zip(*parts), 1):
        yield HarmonicRow(
            quantity=curve.quantity, case=case, torque_Nm=torque, mean=mean, mean_error=curve.mean_error,
            peak_to_peak=size, peak_to_peak_error=curve.peak_to_peak_error, harmonic=r, amplitude=float(amplitude),
            amplitude_error=float(error), phase_deg=float(np.degrees(phase)),
        )
