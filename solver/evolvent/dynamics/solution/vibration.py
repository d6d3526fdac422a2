"""Vibration of a gear pair over the speed from Python, on an excitation that was computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from evolvent.dynamics.mesh_oscillator import sweep_at
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.dynamics.results.response import DriveSummary, summary
from evolvent.dynamics.results.response_errors import unknown_errors
from evolvent.dynamics.solution.mesh_excitation import GearExcitation
from evolvent.dynamics.solution.swept_vibration import SweptVibration, checked_speeds, swept_tables
from evolvent.fem.material import STEEL
from evolvent.gears.problem.gear_inertia import polar_moment
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import instance, number, refuse

ROUNDING = 1.0 + 1e-9
"""Factor on the heaviest torque by which a torque may lie above it."""
LIGHTEST = 0.02
"""Least moment of inertia over that of a gear's body as drawn, of steel: plastics have an eighth of its density, and a
value in kg·m² is a thousandth of that in t·mm²."""
PERFECT = Accuracy()
"""Accuracy of gears without known deviations, for which there is no K_v of ISO 6336-1."""


@dataclass(frozen=True, eq=False)
class PairVibration(SweptVibration):
    """Vibration of a gear pair over the speed."""

    facts: DriveSummary
    """Mass, stiffness, natural speed, folds and jumps; the keys of dynamics.json. Error bars are NaN."""

    def plot(self, path: Path | str) -> Path:
        """Draws amplitude, dynamic factor and time out of contact over the speed to a PNG file, and returns its path;
        creates missing folders. Raises InputError for another ending, WriteError."""
        from evolvent.dynamics.figures.response import response_figure
        from evolvent.results.solution.user_files import save_picture

        return save_picture(path, response_figure, self.facts, self.rows, self.branch)


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
    instance("accuracy", accuracy, Accuracy, "write accuracy=Accuracy(f_pb, f_fα), in µm")
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
    heaviest = float(excitation.torques[-1])
    wanted = f"a number above 0 up to the heaviest of the excitation, {heaviest:.6g} N·mm"
    remedy = "for a heavier one give mesh_excitation a heavier torque, too"
    number("torque", torque, wanted, remedy, lambda T: 0.0 < T <= heaviest * ROUNDING)
    load = torque / excitation.base_radius
    _check_fit(excitation.pair, load, settings)
    return drive(excitation.pair, excitation.mesh, load, settings)


def _check_fit(pair: GearPair, load: float, settings: DriveSettings) -> None:
    """Raises InputError for settings that do not fit the size of the gears, most often by their unit. load: static
    mesh force [N]."""
    for member, gear, inertia in zip(Member, pair.gears, settings.inertias):
        least = LIGHTEST * polar_moment(gear, STEEL.density)
        wanted = f"of the {member.label} at least {least:.2g} t·mm², a fiftieth of its body's, of steel"
        if inertia < least:
            refuse("inertias", wanted, inertia, "1 kg·m² is 1000 t·mm²")
    module = pair.pinion.normal_module
    wanted = f"a number from 0 to the module, {module:g} mm"
    number("backlash", settings.backlash, wanted, "50 µm are 0.05", lambda j: j <= module)
    if load / settings.series_stiffness > module:
        wanted = f"at least {load / module:.4g} N/mm, which gives way by a module under the torque"
        refuse("series_stiffness", wanted, settings.series_stiffness, "1 N/µm is 1000 N/mm")
