"""The first mesh periods of a motion from rest: rows over time, with error bars as those of the last mesh period."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.results.transient.cases import UM, CasePressures
from evolvent.dynamics.results.transient.compared import ComparedMotion
from evolvent.dynamics.results.transient.curves import MotionCurves
from evolvent.dynamics.results.transient.errors import MovingCompanion
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.gear_model import GearModel
from evolvent.results.error_bars.compared import SHARING, STIFFNESS, Compared, Curve
from evolvent.results.tables.table import Table
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class StartRow:
    """A line of transient_start.csv: a position of the first two mesh periods from rest."""

    speed_rpm: float
    """Speed of the pinion."""
    friction: float
    """Friction coefficient μ."""
    time_s: float
    """Time since the flanks touched."""
    pinion_angle_deg: float
    """Nominal rotation of the pinion since the flanks touched; it begins at 0 of transient.csv."""
    transmission_error_um: float
    """Transmission error r_b1 φ_1 − r_b2 φ_2."""
    transmission_error_um_error: float
    """Estimated error of the transmission error by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    static_transmission_error_um: float
    """Transmission error without inertia."""
    mesh_force_N: float
    """Mesh force along the line of action in the transverse section."""
    mesh_force_N_error: float
    """Estimated error of the mesh force by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    load_N: float
    """Load along the line of action, as in transient.json: the mean mesh force in a steady state."""
    max_pressure_MPa: float
    """Largest fitted peak pressure between the tip-edge zones of transient.csv; NaN where all contact lies in these, or
    nothing touches."""
    max_pressure_MPa_error: float
    """Estimated error of the largest pressure by mesh, modes and time steps; NaN where there is no coarse companion
    (`output.error_bars`)."""
    static_max_pressure_MPa: float
    """Largest fitted peak pressure without inertia, between the tip-edge zones of transient.csv."""


TRANSIENT_START = Table("transient_start.csv", StartRow)


@dataclass(frozen=True, eq=False)
class StartErrors:
    """Error bars of the first mesh periods of a case, n positions; NaN where they are not known."""

    transmission_error_um: Floats
    """(n,) errors of the transmission error [µm]."""
    mesh_force: Floats
    """(n,) errors of the mesh force [N; N/mm in 2D]."""
    pressure: Floats
    """(n,) errors of the largest pressure [MPa]."""
    largest_force: float
    """Error of the largest mesh force of all time steps [N; N/mm in 2D]."""


@dataclass(frozen=True, eq=False)
class Beginning:
    """The first mesh periods of a motion, n positions over the rotation of the pinion since the start."""

    found: MeshPeriods
    """Motion with its first mesh periods."""
    curves: MotionCurves
    """Curves of the positions of the first mesh periods."""

    @staticmethod
    def of(model: GearModel, found: MeshPeriods, inner: tuple[float, float]) -> Beginning:
        """First mesh periods of a motion. inner: roll distances [mm] between which pressures are evaluated."""
        pitch, n = 2.0 * np.pi / model.pair.pinion.z, len(found.moments)
        angle = pitch / n * np.arange(1, len(found.beginning) + 1)
        return Beginning(found, MotionCurves.of(model, [each.result for each in found.beginning], inner, angle))

    @property
    def mesh_force(self) -> Curve:
        """Mesh force [N; N/mm in 2D] over the rotation since the start."""
        return Curve(self.curves.angle, np.array([moment.mesh_force for moment in self.found.beginning]))

    @property
    def largest_force(self) -> Curve:
        """Largest mesh force of the time steps up to each position [N; N/mm in 2D]."""
        return Curve(self.curves.angle, np.array([moment.steps.largest_force for moment in self.found.beginning]))


def start_errors(own: Beginning, order: int, motions: Sequence[Beginning]) -> StartErrors:
    """Error bars of the first mesh periods. order: polynomial order of the finite elements. motions: those of the
    companion, in the time steps of the case and in shorter ones; empty where there are none."""
    if not motions:
        nothing = np.full(len(own.found.beginning), np.nan)
        return StartErrors(nothing, nothing, nothing, float("nan"))
    every = (own, *motions)
    error = ComparedMotion(STIFFNESS[order], *(each.curves.transmission_error for each in every))
    force = ComparedMotion(SHARING[order], *(each.mesh_force for each in every))
    largest = ComparedMotion(SHARING[order], *(each.largest_force for each in every))
    peaks = ComparedMotion(SHARING[order], *(each.curves.line_loads.positions for each in every))
    pressure = Compared(own.curves.fitted.positions, own.curves.hertz.positions).of_each() + peaks.of_each()
    return StartErrors(UM * error.of_each(), force.of_each(), pressure, largest.of_figure(np.max))


def beginnings(
    model: GearModel, pressures: Sequence[CasePressures], companion: MovingCompanion | None
) -> list[tuple[Beginning, StartErrors]]:
    """First mesh periods of all cases, in their order, with their error bars; none where motions do not begin at
    rest."""
    found = []
    for number, each in enumerate(pressures):
        if not each.case.found.beginning:
            return []
        inner = each.moving.inner_path
        own, motions = Beginning.of(model, each.case.found, inner), list[Beginning]()
        if companion is not None and not isinstance(both := companion.motions(number), str):
            motions = [Beginning.of(companion.model, motion, inner) for motion in both]
        found.append((own, start_errors(own, model.bodies[0].mesh.order, motions)))
    return found


def start_rows(
    model: GearModel, pressures: Sequence[CasePressures], begun: Sequence[tuple[Beginning, StartErrors]]
) -> Iterator[StartRow]:
    """Rows of transient_start.csv: all cases, over time."""
    width = model.width_factor
    for each, (own, bars) in zip(pressures, begun):
        case, (_, calm) = each.case, each.peaks()
        values = own.curves.fitted.positions.values, bars.transmission_error_um, bars.mesh_force, bars.pressure
        for k, (moment, peak, of_error, of_force, of_peak) in enumerate(zip(case.found.beginning, *values), 1):
            still = k % len(case.static)
            yield StartRow(
                speed_rpm=case.speed.rpm, friction=case.friction, time_s=moment.time,
                pinion_angle_deg=float(np.degrees(own.curves.angle[k - 1])),
                transmission_error_um=UM * moment.result.transmission_error,
                transmission_error_um_error=float(of_error),
                static_transmission_error_um=UM * case.static[still].transmission_error,
                mesh_force_N=width * moment.mesh_force, mesh_force_N_error=width * float(of_force),
                load_N=width * case.load, max_pressure_MPa=float(peak), max_pressure_MPa_error=float(of_peak),
                static_max_pressure_MPa=float(calm[still]),
            )
