"""Engineering figures of a drive at one position; those of a pitch are their means or extremes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from evolvent.results.run_data import RunData, SolvedPosition
from evolvent_meshes.arrays import Floats


def transmission_error_um(_: RunData, solved: SolvedPosition) -> float:
    """Transmission error r_b1 φ_1 − r_b2 φ_2 [µm]."""
    return 1e3 * solved.result.transmission_error


def loss_percent(_: RunData, solved: SolvedPosition) -> float:
    """Friction power over input power [%]."""
    return 100.0 * solved.result.friction_loss / solved.result.input_power


def pitch_loss_percent(lost: ArrayLike, given: ArrayLike) -> Floats:
    """Friction work over the input work of a pitch [%], from friction powers and input powers (n, ...) at its n
    positions, both in N·mm as of `PositionResult`."""
    return np.asarray(100.0 * np.sum(lost, axis=0) / np.sum(given, axis=0))


def mesh_stiffness(run: RunData, solved: SolvedPosition) -> float:
    """Tangent stiffness dF/dδ along the line of action [N/(mm·µm)] at the torque, without friction.

    F: torque over base radius and face width, δ: transmission error.
    """
    return 1e-3 * solved.result.stiffness * run.width / run.pair.face_width


def secant_stiffness(run: RunData, solved: SolvedPosition) -> float:
    """Secant stiffness T_1/(r_b1 b) over the deflection [N/(mm·µm)], what the torque adds to the unloaded transmission
    error: modifications, charts and wear of the flanks are in both. NaN where no flanks face each other."""
    force = run.width * solved.result.torques[0] / run.pair.pinion.base_radius / run.pair.face_width
    return force / (1e3 * (solved.result.transmission_error - solved.unloaded_error))
