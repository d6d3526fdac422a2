"""Vibration of a gear pair over the speed from Python, on an excitation that was computed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from evolvent.dynamics.mesh_oscillator import sweep_at
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.dynamics.results.response import DriveSummary, summary
from evolvent.dynamics.results.response_errors import unknown_errors
from evolvent.dynamics.solution.mesh_excitation import GearExcitation
from evolvent.dynamics.solution.swept_vibration import SweptVibration, checked_speeds, swept_tables
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import instance, number, refuse

ROUNDING = 1.0 + 1e-9
"""Factor on the heaviest torque by which a torque may lie above it."""
PERFECT = Accuracy()
"""Accuracy of gears without known deviations, for which there is no K_v of ISO 6336-1."""


@dataclass(frozen=True, eq=False)
class PairVibration(SweptVibration):
    """Vibration of a gear pair over the speed."""

    facts: DriveSummary
    """Mass, stiffness, natural speed, folds and jumps; the keys of dynamics.json. Error bars are NaN."""

    def plot(self, path: Path | str) -> Path:
        """Draws amplitude, dynamic factor and time out of contact over the speed to a PNG file, and returns its path.
        Raises InputError for another ending, WriteError."""
        from evolvent.dynamics.figures.response import response_picture
        from evolvent.results.solution.user_files import save_picture

        return save_picture(path, response_picture(self.facts, self.rows, self.branch))


def vibration(
    excitation: GearExcitation, torque: float, speeds: Sequence[float] | Floats, settings: DriveSettings,
    accuracy: Accuracy = PERFECT,
) -> PairVibration:
    """Vibration of a pair that runs up and down through some speeds under a torque, as of `evolvent dynamics`.

    torque: up to the heaviest of the excitation [N·mm], on the same gear. Mesh forces beyond the heaviest one go on
        straight: `facts.heaviest_torque_share` above 1 says so.
    speeds: of the pinion, two at least, ascending [r/min].
    settings: inertias, damping, backlash and model of the mesh; gear bodies are rigid unless `with_elastic_bodies` has
        added their shapes.
    accuracy: deviations of the gears, for K_v of ISO 6336-1 beside; NaN without.

    Raises InputError, Jammed where the backlash has no room for unloaded errors, TooSoftBodies, NoSteadyState.
    """
    values = checked_speeds(speeds)
    pair = _drive(excitation, torque, settings)
    swept = sweep_at(pair, values)
    iso = method_b(excitation.pair, pair.equivalent_mass, pair.model.load, accuracy, excitation.moduli)
    own = swept_tables(pair, swept, iso)
    errors = unknown_errors(len(values), len(own.jumps_up), len(own.jumps_down))
    share = max(row.largest_force_N for row in own.rows), float(excitation.mesh.loaded.forces[-1])
    facts = summary(pair, settings, swept, *share, iso, errors)
    return PairVibration(own.rows, own.branch, own.natural_speed, own.jumps_up, own.jumps_down, facts)


def natural_speed(excitation: GearExcitation, torque: float, settings: DriveSettings) -> float:
    """Speed of the pinion at which the mesh frequency is the natural frequency of the pair [r/min]. Arguments and
    errors are those of `vibration`."""
    return _drive(excitation, torque, settings).natural_speed


def _drive(excitation: GearExcitation, torque: float, settings: DriveSettings) -> Drive:
    """Oscillator of the pair under a torque. Raises InputError, Jammed, TooSoftBodies."""
    instance("excitation", excitation, GearExcitation, "give what mesh_excitation(gears, torques) returns")
    instance("settings", settings, DriveSettings, "write DriveSettings(inertias, damping_ratio, backlash)")
    _check(settings)
    heaviest = float(excitation.torques[-1])
    wanted = f"a number above 0 up to the heaviest of the excitation, {heaviest:.6g} N·mm"
    remedy = "give mesh_excitation a heavier torque, too"
    number("torque", torque, wanted, remedy, lambda T: 0.0 < T <= heaviest * ROUNDING)
    return drive(excitation.pair, excitation.mesh, torque / excitation.base_radius, settings)


def _check(settings: DriveSettings) -> None:
    """Raises InputError for settings that no pair has."""
    for inertia in settings.inertias:
        number("inertias", inertia, "two numbers above 0, in t·mm²", "1 kg·m² is 1000 t·mm²", lambda J: J > 0.0)
    for name in ("damping_ratio", "ground_damping_ratio", "backlash"):
        number(name, getattr(settings, name), "a number from 0 on", "give a number", lambda value: value >= 0.0)
    if not (settings.series_stiffness > 0.0 and not math.isnan(settings.series_stiffness)):
        refuse("series_stiffness", "a number above 0, in N/mm", settings.series_stiffness, "leave it out for none")
