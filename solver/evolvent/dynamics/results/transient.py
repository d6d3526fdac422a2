"""Transient contact of a pair beside its statics: rows over the mesh period and over a tooth's engagement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.line_peaks import line_peak
from evolvent.gears.pressure.pitch_pressure import PitchPressure, pitch_pressures
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.tables import csv_text
from evolvent_meshes.arrays import Floats

TRANSIENT, TRANSIENT_TEETH = "transient.csv", "transient_teeth.csv"
UM = 1e3


@dataclass(frozen=True)
class TransientRow:
    """A line of transient.csv: a position of the last mesh period that was computed."""

    speed_rpm: float
    """Of the pinion."""
    friction: float
    """μ."""
    pinion_angle_deg: float
    """Nominal rotation of the pinion; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
    transmission_error_um: float
    """r_b1 φ_1 − r_b2 φ_2."""
    static_transmission_error_um: float
    """The same without inertia."""
    velocity_mm_per_s: float
    """Rate of the transmission error."""
    mesh_force_N: float
    """Along the line of action in the transverse section; the torque over the base radius in statics."""
    pinion_torque_Nm: float
    """Moment of the contact forces about the pinion's axis."""
    wheel_torque_Nm: float
    """About the wheel's axis."""
    max_pressure_MPa: float
    """Largest fitted peak pressure between the tip-edge zones; NaN where all contact lies in these, or nothing
    touches."""
    static_max_pressure_MPa: float
    """The same without inertia."""


@dataclass(frozen=True)
class TransientToothRow:
    """A line of transient_teeth.csv: a tooth pair at a position of the last mesh period."""

    speed_rpm: float
    """Of the pinion."""
    friction: float
    """μ."""
    tooth_angle_deg: float
    """Rotation of the pinion since this tooth pair touched at the pitch point, in the mid-face section."""
    normal_force_N: float
    """Of this tooth pair."""
    static_normal_force_N: float
    """The same without inertia."""
    max_pressure_MPa: float
    """Largest fitted peak pressure between the tip-edge zones."""
    static_max_pressure_MPa: float
    """The same without inertia."""


@dataclass(frozen=True, eq=False)
class TransientCase:
    """A speed and friction coefficient, with the statics of the same positions."""

    speed: float
    """Of the pinion [r/min]."""
    friction: float
    """μ."""
    found: MeshPeriods
    """The transient."""
    static: tuple[PositionResult, ...]
    """Its positions without inertia."""
    load: float
    """Along the line of action [N; N/mm in 2D]."""

    @property
    def results(self) -> tuple[PositionResult, ...]:
        """Positions of the last mesh period."""
        return tuple(moment.result for moment in self.found.moments)


@dataclass(frozen=True, eq=False)
class CasePressures:
    """Fitted pressures of a case; NaN where nothing is known."""

    case: TransientCase
    """The case."""
    moving: PitchPressure
    """Of its positions."""
    still: PitchPressure
    """Without inertia."""

    def peaks(self) -> tuple[Floats, Floats]:
        """Largest pressure at each position (n,), with inertia and without [MPa]."""
        return self.moving.at_positions, self.still.at_positions


def case_pressures(model: GearModel, cases: Sequence[TransientCase]) -> list[CasePressures]:
    """Of all cases, between the same tip-edge zones."""
    still = {case.friction: case.static for case in cases}  # the same at all speeds
    columns = [*(case.results for case in cases), *still.values()]
    found = pitch_pressures(model, [tuple(column[k] for column in columns) for k in range(len(columns[0]))])
    static = dict(zip(still, found[len(cases) :]))
    return [CasePressures(case, moving, static[case.friction]) for case, moving in zip(cases, found)]


def transient_rows(model: GearModel, pressures: Sequence[CasePressures]) -> Iterator[TransientRow]:
    """Of all cases, at ascending rotations."""
    width = model.width_factor
    for each in pressures:
        case = each.case
        for moment, still, peak, calm in zip(case.found.moments, case.static, *each.peaks()):
            result = moment.result
            yield TransientRow(
                case.speed, case.friction, float(np.degrees(result.stand.angle)), UM * result.transmission_error,
                UM * still.transmission_error, moment.rate, width * moment.mesh_force,
                1e-3 * width * result.torques[0], 1e-3 * width * result.torques[1], float(peak), float(calm),
            )  # fmt: skip


def tooth_rows(model: GearModel, pressures: Sequence[CasePressures]) -> Iterator[TransientToothRow]:
    """Of all cases, at ascending rotations of a tooth: all pairs of a pitch make one engagement."""
    pitch, width = 2.0 * np.pi / model.pair.pinion.z, model.width_factor
    for each in pressures:
        case, rows = each.case, []
        for k, (moving, still) in enumerate(zip(case.results, case.static)):
            teeth = np.union1d(moving.contact.tooth, still.contact.tooth)
            for tooth in (int(tooth) for tooth in teeth):
                forces = [width * _force(result, tooth) for result in (moving, still)]
                peaks = [
                    line_peak(model.pair, own.cuts[k], tooth, own.inner_path).pressure
                    for own in (each.moving, each.still)
                ]
                angle = float(np.degrees(moving.stand.angle + tooth * pitch))
                rows.append(TransientToothRow(case.speed, case.friction, angle, *forces, *peaks))
        yield from sorted(rows, key=lambda row: row.tooth_angle_deg)


def write_rows(folder: RunFolder, rows: Sequence[TransientRow], teeth: Sequence[TransientToothRow]) -> None:
    """transient.csv and transient_teeth.csv. Raises WriteError."""
    folder.write_text(TRANSIENT, csv_text([asdict(row) for row in rows]))
    folder.write_text(TRANSIENT_TEETH, csv_text([asdict(row) for row in teeth]))


def _force(result: PositionResult, tooth: int) -> float:
    """Normal force of a tooth pair [N; N/mm in 2D]."""
    contact = result.contact
    return float(np.sum((contact.weights * contact.pressure)[contact.tooth == tooth]))
