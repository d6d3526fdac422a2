"""Engineering figures of a run in reporting units: one row a position, one row a friction coefficient."""

from __future__ import annotations

import math

import numpy as np

from evolvent.gears.pressure.contact_slices import ToothSummary
from evolvent.gears.pressure.line_peaks import line_peak
from evolvent.gears.solution.certificates import balance_error, pitch_imbalance
from evolvent.results.engagement import Engagement, crossing, engagements
from evolvent.results.error_bars.position_spacing import spacing_errors
from evolvent.results.face_load import face_load
from evolvent.results.mesh_facts import few_cells_across
from evolvent.results.position_figures import (
    loss_percent,
    mesh_stiffness,
    pitch_loss_percent,
    secant_stiffness,
    transmission_error_um,
)
from evolvent.results.relief_kinks import largest_kink
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.shaft_forces import shaft_forces
from evolvent.results.tables.summary_rows import FrictionRow, PositionRow, ToothRow
from evolvent_meshes.gears.member import Member

DEGREES = 6
"""Decimals of an angle in degrees: a hundredth of a micrometre on a flank, and above the conversion's round-off."""


def degrees(angle: float) -> float:
    """An angle [rad] in degrees, without the round-off of the conversion."""
    return round(math.degrees(angle), DEGREES) + 0.0


def position_rows(run: RunData) -> list[PositionRow]:
    """Rows of all positions at all friction coefficients."""
    return [position_row(run, solved) for each in run.positions for solved in each]


def position_row(run: RunData, solved: SolvedPosition) -> PositionRow:
    """The row of one position at one friction coefficient."""
    result, width = solved.result, run.width
    teeth = tuple(_tooth_row(run, solved, tooth) for tooth in solved.teeth)
    return PositionRow(
        pinion_angle_deg=degrees(result.stand.angle),
        friction=result.friction,
        torque_pinion_Nm=1e-3 * width * result.torques[0],
        torque_gear_Nm=1e-3 * width * result.torques[1],
        transmission_error_um=transmission_error_um(run, solved),
        mesh_stiffness_N_per_mm_um=mesh_stiffness(run, solved),
        secant_stiffness_N_per_mm_um=secant_stiffness(run, solved),
        max_pressure_MPa=float(np.fmax.reduce([tooth.max_pressure_MPa for tooth in teeth])),
        kink_pressure_MPa=float(np.max([tooth.kink_pressure_MPa for tooth in teeth])),
        tip_edge=any(tooth.edge_pressure > 0.0 for tooth in solved.teeth),
        loss_percent=loss_percent(run, solved),
        newton_iterations=result.iterations,
        balance_error=balance_error(result),
        seconds=result.seconds,
        teeth=teeth,
    )


def _tooth_row(run: RunData, solved: SolvedPosition, tooth: ToothSummary) -> ToothRow:
    length, peak = tooth.contact_length * run.width, line_peak(run.pair, solved.cut, tooth.tooth, run.inner_path)
    force = tooth.force * run.width
    edge, kink = (_apart(run, pressure) for pressure in (tooth.edge_pressure, tooth.kink_pressure))
    return ToothRow(tooth.tooth, force, peak.pressure, length, edge, kink)


def _apart(run: RunData, pressure: float) -> float:
    """Pressure on an edge or over a kink [MPa], 0 where neither bears; NaN in line contact, whose pressure is Hertz'
    and not the one there."""
    return math.nan if run.is_line and pressure > 0.0 else pressure


def friction_rows(run: RunData, inner: tuple[float, float] | None = None) -> list[FrictionRow]:
    """One row a friction coefficient, in the scene's order. inner: see `engagement.engagement`."""
    curves = engagements(run, inner)
    lowest = curves[int(np.argmin(run.frictions))]
    return [_friction_row(run, index, curve, lowest) for index, curve in enumerate(curves)]


def _friction_row(run: RunData, index: int, curve: Engagement, lowest: Engagement) -> FrictionRow:
    results = [each[index].result for each in run.positions]
    errors = 1e3 * np.array([result.transmission_error for result in results])
    top, kink = curve.peak, largest_kink(run, index)
    crosses = curve is not lowest and not few_cells_across(run)  # on few cells scatter causes crossings
    loss = pitch_loss_percent([r.friction_loss for r in results], [r.input_power for r in results])
    return FrictionRow(
        friction=curve.friction,
        max_pressure_MPa=top.pressure,
        max_pressure_angle_deg=degrees(top.angle),
        max_pressure_at_zone_end=top.at_zone_end,
        kink_pressure_MPa=kink.pressure if kink else math.nan,
        kink_pressure_angle_deg=degrees(kink.roll_distance / run.pair.pinion.base_radius) if kink else math.nan,
        mean_pressure_MPa=curve.whole_mean,
        transmission_error_peak_to_peak_um=float(np.ptp(errors)),
        mesh_stiffness_N_per_mm_um=float(np.mean([mesh_stiffness(run, each[index]) for each in run.positions])),
        secant_stiffness_N_per_mm_um=float(np.mean([secant_stiffness(run, each[index]) for each in run.positions])),
        loss_percent=float(loss),
        face_load_factor=face_load(run, index).factor(),
        crossing_deg=degrees(crossing(lowest, curve)) if crosses else math.nan,
        balance_error=pitch_imbalance(results),
        forces_on_pinion=shaft_forces(run, Member.PINION, index),
        forces_on_wheel=shaft_forces(run, Member.WHEEL, index),
        estimated_error=run.errors.figures[index] if run.errors.figures else None,
        spacing_error=spacing_errors(run, index),
    )
