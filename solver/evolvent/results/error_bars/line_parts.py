"""Parts by which figures of a line contact are off beside the error of its meshes: nine in ten deviations from resolved
contacts are smaller (docs/line_contact.md), for pressures those from Hertz' pressure for the resolved load."""

from __future__ import annotations

import numpy as np

from evolvent.gears.line.line_result import FACE_LOAD_OFF, PRESSURE_OFF
from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.engagement import engagement
from evolvent.results.face_load import face_load
from evolvent.results.position_figures import (
    mesh_stiffness,
    pitch_loss_percent,
    secant_stiffness,
    transmission_error_um,
)
from evolvent.results.run_data import RunData

ERROR_VARIES, ERROR_LEAST = 6e-3, 1e-3
"""Part by which the peak-to-peak transmission error is off, and the least error of it, over the mean deflection."""
TANGENT_OFF, SECANT_OFF = 5e-3, 2e-3
"""Parts by which mean stiffnesses are off."""
LOSS_OFF = 5e-3
"""Part by which the friction loss is off."""
RUBBING_VARIES, RUBBING_OFF = 2.5e-2, 1.5e-2
"""Parts of the deflection by which the peak-to-peak transmission error and the mean deflection of a helical pair are
off for each unit of the friction coefficient: friction sticks behind the pitch point, and slides along the line where
loads change."""


def line_parts(run: RunData, index: int) -> FigureErrors:
    """The part of the error bars of a line contact at the friction coefficient with this index that no mesh has."""
    solved = [each[index] for each in run.positions]
    errors = np.array([transmission_error_um(run, each) for each in solved])
    deflection = float(np.nanmean(errors - 1e3 * np.array([each.unloaded_error for each in solved])))
    tangent, secant = (float(np.mean([of(run, each) for each in solved])) for of in (mesh_stiffness, secant_stiffness))
    results = [each.result for each in solved]
    loss = pitch_loss_percent([each.friction_loss for each in results], [each.input_power for each in results])
    rubbing = results[0].friction if run.pair.pinion.base_helix_angle else 0.0
    curve = engagement(run, index)
    return FigureErrors(
        max_pressure_MPa=PRESSURE_OFF * curve.peak.pressure,
        mean_pressure_MPa=PRESSURE_OFF * curve.whole_mean,
        transmission_error_peak_to_peak_um=max(ERROR_VARIES * float(np.ptp(errors)), ERROR_LEAST * deflection)
        + RUBBING_VARIES * rubbing * deflection,
        mesh_stiffness_N_per_mm_um=TANGENT_OFF * tangent,
        secant_stiffness_N_per_mm_um=(SECANT_OFF + RUBBING_OFF * rubbing) * secant,
        loss_percent=LOSS_OFF * float(loss),
        face_load_factor=0.0 if run.plane else FACE_LOAD_OFF * face_load(run, index).factor(),
    )
