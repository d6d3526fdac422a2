"""Tables of a pair's excitation: over the pitch under each torque, and their mesh harmonics."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.harmonics import COUNT, mesh_harmonics
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.tables import csv_text
from evolvent_meshes.arrays import Floats

EXCITATION, HARMONICS = "excitation.csv", "harmonics.csv"
UNLOADED = 0.0
"""Torque of the unloaded transmission error [N·m]."""


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
    """e: r_b1 φ_1 − r_b2 φ_2 at which the flanks just touch, by geometry."""
    transmission_error_um: float
    """The same under the torque, without friction."""
    tangent_stiffness_N_per_um: float
    """Change of the mesh force by the transmission error, of the whole face."""
    secant_stiffness_N_per_um: float
    """Mesh force over what the torque adds to the unloaded transmission error."""


@dataclass(frozen=True)
class HarmonicRow:
    """A line of harmonics.csv: a mesh harmonic of a quantity under a torque."""

    quantity: str
    """As in excitation.csv."""
    torque_Nm: float
    """0 of the unloaded transmission error."""
    mean: float
    """Over the pitch, in the quantity's unit, like the amplitude."""
    peak_to_peak: float
    """Largest less smallest value of the positions."""
    harmonic: int
    """1 at the frequency of the mesh."""
    amplitude: float
    """A of A cos(2π r φ z_1/2π + ψ)."""
    phase_deg: float
    """ψ."""


def excitation_rows(excitation: MeshExcitation, radius: float) -> list[ExcitationRow]:
    """The lightest torque first. radius: base radius of the gear with the torque [mm]."""
    loaded, e, secant = excitation.loaded, excitation.unloaded_error, excitation.secant
    return [
        ExcitationRow(
            float(np.degrees(angle)), 1e-3 * float(force) * radius, float(force), 1e3 * float(e[i]),
            1e3 * float(loaded.errors[i, j]), 1e-3 * float(loaded.stiffness[i, j]), 1e-3 * float(secant[i, j]),
        )
        for j, force in enumerate(loaded.forces)
        for i, angle in enumerate(loaded.angles)
    ]  # fmt: skip


def harmonic_rows(excitation: MeshExcitation, radius: float) -> list[HarmonicRow]:
    """All quantities of excitation.csv that vary over the pitch; as many harmonics as its positions hold, at most five.
    """
    loaded = excitation.loaded
    rows = list(_harmonics("unloaded_transmission_error_um", UNLOADED, 1e3 * excitation.unloaded_error))
    for j, force in enumerate(loaded.forces):
        torque = 1e-3 * float(force) * radius
        rows += _harmonics("transmission_error_um", torque, 1e3 * loaded.errors[:, j])
        rows += _harmonics("tangent_stiffness_N_per_um", torque, 1e-3 * loaded.stiffness[:, j])
        rows += _harmonics("secant_stiffness_N_per_um", torque, 1e-3 * excitation.secant[:, j])
    return rows


def _harmonics(quantity: str, torque: float, values: Floats) -> Iterator[HarmonicRow]:
    count = min(COUNT, (len(values) - 1) // 2)
    amplitudes, phases = mesh_harmonics(values, count)
    for r, (amplitude, phase) in enumerate(zip(amplitudes, phases), 1):
        mean, span = float(values.mean()), float(np.ptp(values))
        yield HarmonicRow(quantity, torque, mean, span, r, float(amplitude), float(np.degrees(phase)))


def write_tables(folder: RunFolder, positions: Sequence[ExcitationRow], harmonics: Sequence[HarmonicRow]) -> None:
    """Writes excitation.csv and harmonics.csv. Raises WriteError, FolderError."""
    folder.write_text(EXCITATION, csv_text([asdict(row) for row in positions]))
    folder.write_text(HARMONICS, csv_text([asdict(row) for row in harmonics]))
