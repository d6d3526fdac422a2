"""Error bars of a pair's transient contact: from the same case on a companion of elements of twice the size.

The companion moves twice, in the time steps of the case and in steps of a quarter. It has more natural modes. So the
error of a figure has two parts, each a multiple of a difference D (`results.error_bars.compared`) between curves:

- Mesh and modes: between the case and the companion in the same steps. The factors are those of a run and of an
  excitation: what varies over the pitch excites. The modes that the case leaves out are in the same difference.
- Time steps: between the companion's two motions. Where a tooth comes into contact within a step, or teeth part and
  meet, the method is of first order. Then a quarter of the step has a quarter of the error, and the longer step is off
  by 1/(1 − 1/4) of the difference; of second order 16/15 would do.

Every other position, as for the vibration, says too little: a vibration that the case smears is smeared in longer steps
all the more, so that both agree while both are wrong. Of He's pair at 20 positions and eight speeds the difference to
every other position was up to seven times smaller than the error of the dynamic factor, that of the companion to half
the step up to four times.

Pressures have the errors of a run: of fitted peaks against Hertz' for the computed loads, and of the loads, here by
both motions of the companion; the largest one that of the spacing of positions, between which a pressure is not
evaluated. Statics have theirs by the companion's statics and by the spacing of positions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from evolvent.dynamics.results.curves import LOADED, TANGENT, PitchCurve
from evolvent.dynamics.results.transient.cases import UM, CasePressures
from evolvent.dynamics.results.transient.compared import ComparedMotion
from evolvent.dynamics.results.transient.curves import MotionCurves, largest, mesh_force
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.error_bars.compared import SHARING, STIFFNESS, Compared, by_rotation, keys
from evolvent.results.error_bars.peak_bounds import tops
from evolvent.results.error_bars.position_spacing import every_other
from evolvent_meshes.arrays import Floats

SAME_STEPS, FINER_STEPS = "on elements of twice the size", "on elements of twice the size in a quarter of the time step"


@dataclass(frozen=True, eq=False)
class MovingCompanion:
    """Motions of the cases of a scene on elements of twice the size."""

    model: GearModel
    """Gear pair with elements of twice the size."""
    order: int
    """Polynomial order of the finite elements."""
    static: Sequence[tuple[PositionResult, ...]]
    """Static results at all positions, for each friction coefficient."""
    same: Mapping[int, MeshPeriods | str]
    """Number of a case -> its motion in the time steps of the scene, or why there is none."""
    finer: Mapping[int, MeshPeriods | str]
    """Number of a case -> its motion in steps of a quarter of those, or why there is none."""

    def motions(self, number: int) -> tuple[MeshPeriods, MeshPeriods] | str:
        """Motions of a case, in the time steps of the scene and in a quarter of those; the sentence on the one
        that was not found."""
        same, finer = self.same[number], self.finer[number]
        if isinstance(same, str) or isinstance(finer, str):
            what, why = (SAME_STEPS, same) if isinstance(same, str) else (FINER_STEPS, finer)
            return f"no error bars, as the motion {what} was not found: {why}"
        return same, finer


@dataclass(frozen=True, eq=False)
class CaseErrors:
    """Error bars of a case with n positions and m tooth pairs in transient_teeth.csv; NaN where they are not known."""

    transmission_error_um: Floats
    """(n,) errors of the transmission error [µm]."""
    mesh_force: Floats
    """(n,) errors of the mesh force [N; N/mm in 2D]."""
    pressure: Floats
    """(n,) errors of the largest pressure at each position [MPa]."""
    tooth_force: dict[float, float] = field(default_factory=dict)
    """Rotation of a tooth pair (`by_rotation`) -> error of its normal force [N; N/mm in 2D]."""
    tooth_pressure: dict[float, float] = field(default_factory=dict)
    """Rotation of a tooth pair (`by_rotation`) -> error of its largest pressure [MPa]."""
    peak_to_peak_um: float = float("nan")
    static_peak_to_peak_um: float = float("nan")
    dynamic_factor: float = float("nan")
    max_pressure: float = float("nan")
    """Error of the largest pressure [MPa]."""
    static_max_pressure: float = float("nan")
    """Error of the largest static pressure [MPa]."""
    natural_frequency: float = float("nan")
    """Relative error of the natural frequency."""
    said: str = ""
    """Sentence on why error bars are not known; empty where they are, or were not asked for."""

    def of_tooth(self, angle: float) -> tuple[float, float]:
        """Errors of force [N; N/mm in 2D] and pressure [MPa] at a rotation of a tooth pair [rad]."""
        (key,) = keys([angle])
        return self.tooth_force.get(key, float("nan")), self.tooth_pressure.get(key, float("nan"))


def case_errors(
    own: GearModel, pressures: Sequence[CasePressures], companion: MovingCompanion | None
) -> list[CaseErrors]:
    """Error bars of all cases, in their order; unknown without a companion."""
    frictions = list(dict.fromkeys(each.case.friction for each in pressures))
    found = []
    for number, each in enumerate(pressures):
        count = len(each.case.static)
        if companion is None:
            found.append(_unknown(count))
            continue
        motions, still = companion.motions(number), companion.static[frictions.index(each.case.friction)]
        if isinstance(motions, str):
            found.append(_unknown(count, motions))
            continue
        found.append(_errors(own, each, companion, motions, still))
    return found


def _unknown(count: int, said: str = "") -> CaseErrors:
    nothing = np.full(count, np.nan)
    return CaseErrors(nothing, nothing, nothing, said=said)


def _errors(
    own: GearModel, pressures: CasePressures, companion: MovingCompanion, motions: tuple[MeshPeriods, MeshPeriods],
    still: Sequence[PositionResult],
) -> CaseErrors:
    """Error bars of one case. motions: of the companion, in the time steps of the case and in a quarter of them; still:
    the companion's statics."""
    case, order, inner = pressures.case, companion.order, pressures.moving.inner_path
    factor = SHARING[order]
    moving, static = (
        MotionCurves(own, results, each.cuts, inner)
        for results, each in ((case.results, pressures.moving), (case.static, pressures.still))
    )
    moved = [[moment.result for moment in each.moments] for each in motions]
    same, finer, calm = (MotionCurves.of(companion.model, results, inner) for results in (*moved, still))
    error = ComparedMotion(STIFFNESS[order], *(each.transmission_error for each in (moving, same, finer)))
    force = ComparedMotion(factor, *(mesh_force(each) for each in (case.found, *motions)))
    rotations = np.union1d(*(keys(each.tooth_force.angle) for each in (moving, static)))
    teeth = ComparedMotion(factor, *(each.tooth_force.at(rotations, 0.0) for each in (moving, same, finer)))
    loads = [each.line_loads for each in (moving, same, finer)]
    peaks = ComparedMotion(factor, *(each.positions for each in loads))
    tooth_peaks = ComparedMotion(factor, *(each.teeth for each in loads))
    fitted, hertz = moving.fitted, moving.hertz
    return CaseErrors(
        UM * error.of_each(),
        force.of_each(),
        Compared(fitted.positions, hertz.positions).of_each() + peaks.of_each(),
        by_rotation(teeth.own, teeth.of_each()),
        by_rotation(fitted.teeth, Compared(fitted.teeth, hertz.teeth).of_each() + tooth_peaks.of_each()),
        UM * replace(error, factor=factor).of_varying(np.ptp),
        _pitch_curve(LOADED, UM, static, calm, order).peak_to_peak_error,
        force.of_figure(np.max) / case.load,
        _fitted_error(moving) + peaks.of_figure(largest) + _spacing_error(moving),
        _static_pressure_error(static, calm, factor),
        _natural_frequency_error(static, calm, order),
    )


def _pitch_curve(quantity: str, unit: float, static: MotionCurves, calm: MotionCurves, order: int) -> PitchCurve:
    """Static curve over the pitch, with its error bars. calm: statics of the companion."""
    own, coarse = (
        unit * np.array([result.transmission_error if quantity == LOADED else result.stiffness for result in each])
        for each in (static.results, calm.results)
    )
    return PitchCurve(quantity, own, coarse, order)


def _natural_frequency_error(static: MotionCurves, calm: MotionCurves, order: int) -> float:
    """Relative error of the natural frequency: half that of the mean stiffness."""
    curve = _pitch_curve(TANGENT, 1.0, static, calm, order)
    return float(0.5 * curve.mean_error / np.mean(curve.values))


def _static_pressure_error(static: MotionCurves, calm: MotionCurves, factor: float) -> float:
    """Error of the largest static pressure, by the mesh and by the spacing of positions."""
    loads = Compared(static.line_loads.positions, calm.line_loads.positions, factor)
    return _fitted_error(static) + loads.of_figure(largest) + _spacing_error(static)


def _fitted_error(curves: MotionCurves) -> float:
    """Error of the largest fitted pressure for the computed loads."""
    return Compared(curves.fitted.positions, curves.hertz.positions).of_figure(largest)


def _spacing_error(curves: MotionCurves) -> float:
    """Error of the largest pressure by the spacing of positions: the larger of what every other position misses, and
    what may lie between two."""
    values, teeth = curves.fitted.positions.values, curves.fitted.teeth
    top = largest(values)
    missed = np.mean([top - largest(values[every_other(len(values), first)]) for first in (0, 1)])
    between = largest(np.append(tops((teeth.angle, teeth.values), jumps=True), top)) - top
    return float(np.fmax(missed, between))
