"""Transient contact of a pair beside its statics: rows over the mesh period and over a tooth's engagement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.results.transient.cases import UM, CasePressures
from evolvent.dynamics.results.transient.errors import CaseErrors
from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.line_peaks import line_peak
from evolvent.results.tables.table import Table


@dataclass(frozen=True)
class TransientRow:
    """A line of transient.csv: a position of the last mesh period that was computed."""

    speed_rpm: float
    """Speed of the pinion."""
    friction: float
    """Friction coefficient μ."""
    pinion_angle_deg: float
    """Nominal rotation of the pinion; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
    time_s: float
    """Time since the pinion stood at rotation 0, within this mesh period."""
    transmission_error_um: float
    """Transmission error r_b1 φ_1 − r_b2 φ_2."""
    transmission_error_um_error: float
    """Estimated error of the transmission error by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    static_transmission_error_um: float
    """Transmission error without inertia."""
    velocity_mm_per_s: float
    """Rate of the transmission error."""
    mesh_force_N: float
    """Mesh force along the line of action in the transverse section; in statics the torque over the base radius."""
    mesh_force_N_error: float
    """Estimated error of the mesh force by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    pinion_torque_Nm: float
    """Moment of the contact forces about the pinion's axis."""
    wheel_torque_Nm: float
    """Moment of the contact forces about the wheel's axis."""
    max_pressure_MPa: float
    """Largest fitted peak pressure between the tip-edge zones, which all cases have in common: of their last mesh
    periods, of statics and, from rest, of their first mesh periods. NaN where all contact lies in these, or nothing
    touches."""
    max_pressure_MPa_error: float
    """Estimated error of the largest pressure by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    static_max_pressure_MPa: float
    """Largest fitted peak pressure without inertia, between the tip-edge zones."""


@dataclass(frozen=True)
class TransientToothRow:
    """A line of transient_teeth.csv: a tooth pair at a position of the last mesh period."""

    speed_rpm: float
    """Speed of the pinion."""
    friction: float
    """Friction coefficient μ."""
    tooth_angle_deg: float
    """Rotation of the pinion since this tooth pair touched at the pitch point, in the mid-face section."""
    normal_force_N: float
    """Normal force of the tooth pair."""
    normal_force_N_error: float
    """Estimated error of the normal force by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    static_normal_force_N: float
    """Normal force of the tooth pair without inertia."""
    max_pressure_MPa: float
    """Largest fitted peak pressure of the tooth pair, between the tip-edge zones of transient.csv."""
    max_pressure_MPa_error: float
    """Estimated error of the largest pressure by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    static_max_pressure_MPa: float
    """Largest fitted peak pressure of the tooth pair without inertia, between the tip-edge zones of transient.csv."""


TRANSIENT, TRANSIENT_TEETH = Table("transient.csv", TransientRow), Table("transient_teeth.csv", TransientToothRow)


def transient_rows(
    model: GearModel, pressures: Sequence[CasePressures], errors: Sequence[CaseErrors]
) -> Iterator[TransientRow]:
    """Rows of transient.csv: all cases with their error bars, at ascending rotations."""
    width = model.width_factor
    for each, bars in zip(pressures, errors):
        case = each.case
        columns = (*each.peaks(), bars.transmission_error_um, bars.mesh_force, bars.pressure)
        for moment, still, peak, calm, of_error, of_force, of_peak in zip(case.found.moments, case.static, *columns):
            result, angle = moment.result, moment.result.stand.angle
            yield TransientRow(
                speed_rpm=case.speed.rpm, friction=case.friction, pinion_angle_deg=float(np.degrees(angle)),
                time_s=angle / case.speed.rad_s, transmission_error_um=UM * result.transmission_error,
                transmission_error_um_error=float(of_error), static_transmission_error_um=UM * still.transmission_error,
                velocity_mm_per_s=moment.rate, mesh_force_N=width * moment.mesh_force,
                mesh_force_N_error=width * float(of_force), pinion_torque_Nm=1e-3 * width * result.torques[0],
                wheel_torque_Nm=1e-3 * width * result.torques[1], max_pressure_MPa=float(peak),
                max_pressure_MPa_error=float(of_peak), static_max_pressure_MPa=float(calm),
            )


def tooth_rows(
    model: GearModel, pressures: Sequence[CasePressures], errors: Sequence[CaseErrors]
) -> Iterator[TransientToothRow]:
    """Rows of transient_teeth.csv: all cases with their error bars, at ascending rotations of a tooth. All tooth pairs
    of a pitch make one engagement."""
    pitch, width = 2.0 * np.pi / model.pair.pinion.z, model.width_factor
    for each, bars in zip(pressures, errors):
        case, rows = each.case, []
        for k, (moving, still) in enumerate(zip(case.results, case.static)):
            teeth = np.union1d(moving.contact.tooth, still.contact.tooth)
            for tooth in (int(tooth) for tooth in teeth):
                forces = [width * result.contact.normal_force(tooth) for result in (moving, still)]
                peaks = [
                    line_peak(model.pair, own.cuts[k], tooth, own.inner_path).pressure
                    for own in (each.moving, each.still)
                ]
                angle = moving.stand.angle + tooth * pitch
                of_force, of_peak = bars.of_tooth(angle)
                rows.append(TransientToothRow(
                    speed_rpm=case.speed.rpm, friction=case.friction, tooth_angle_deg=float(np.degrees(angle)),
                    normal_force_N=forces[0], normal_force_N_error=width * of_force, static_normal_force_N=forces[1],
                    max_pressure_MPa=peaks[0], max_pressure_MPa_error=of_peak, static_max_pressure_MPa=peaks[1],
                ))
        yield from sorted(rows, key=lambda row: row.tooth_angle_deg)
