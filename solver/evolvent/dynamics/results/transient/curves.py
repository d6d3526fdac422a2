"""Curves of a motion or of statics, on which error bars compare meshes and time steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_slices import Slices, slices
from evolvent.gears.pressure.line_peaks import line_peak
from evolvent.gears.pressure.pitch_pressure import PitchPressure, facets_of
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.error_bars.compared import Curve
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class PressureCurves:
    """Largest pressures [MPa] of a mesh period; NaN where none is known."""

    positions: Curve
    """Largest pressures at the n positions of the mesh period."""
    teeth: Curve
    """Largest pressures of a tooth pair over its engagement."""


@dataclass(frozen=True, eq=False)
class MotionCurves:
    """Curves of a mesh period of one motion, or of statics."""

    model: GearModel
    """The pair on one kind of meshes."""
    results: tuple[PositionResult, ...]
    """(n,) positions, at ascending rotations from 0 on."""
    cuts: tuple[Slices, ...]
    """(n,) contact of each position in slices."""
    inner: tuple[float, float]
    """Roll distances [mm] between which pressures are evaluated."""
    since_start: Floats | None = None
    """(n,) rotations of the pinion since the start [rad] of a motion whose teeth are numbered anew after each pitch;
    None: the positions have those of one mesh period."""

    @staticmethod
    def of(
        model: GearModel, results: Sequence[PositionResult], inner: tuple[float, float],
        since_start: Floats | None = None,
    ) -> MotionCurves:
        """Cuts the contact of each position into slices."""
        pinion, wheel = model.bodies
        materials, flanks = (pinion.material, wheel.material), facets_of(model)
        cuts = tuple(slices(result, flanks, materials) for result in results)
        return MotionCurves(model, tuple(results), cuts, inner, since_start)

    @property
    def angle(self) -> Floats:
        """(n,) rotation of the pinion [rad]."""
        if self.since_start is not None:
            return self.since_start
        return np.array([result.stand.angle for result in self.results])

    @property
    def transmission_error(self) -> Curve:
        """Transmission error [mm] over the rotation of the pinion."""
        return Curve(self.angle, np.array([result.transmission_error for result in self.results]))

    @property
    def tooth_force(self) -> Curve:
        """Normal force of a tooth pair over its engagement [N; N/mm in 2D]."""
        return self._over_engagement(lambda k, tooth: self.results[k].contact.normal_force(tooth))

    @property
    def fitted(self) -> PressureCurves:
        """Fitted pressures, as in the tables."""
        return self._pressures(self.cuts)

    @property
    def hertz(self) -> PressureCurves:
        """Hertzian pressures for the line loads."""
        return self._pressures([cut.of_hertz() for cut in self.cuts])

    @property
    def line_loads(self) -> PressureCurves:
        """Pressures that depend on the line loads alone."""
        return self._pressures([cut.of_line_loads(self.model.pair) for cut in self.cuts])

    def _pressures(self, cuts: Sequence[Slices]) -> PressureCurves:
        pair, inner = self.model.pair, self.inner
        peaks = PitchPressure(pair, tuple(cuts), inner).at_positions
        teeth = self._over_engagement(lambda k, tooth: line_peak(pair, cuts[k], tooth, inner).pressure)
        return PressureCurves(Curve(self.angle, peaks), teeth)

    def _over_engagement(self, value: Callable[[int, int], float]) -> Curve:
        """Curve of a tooth pair over its engagement. value: of a position and a tooth pair in contact there."""
        pitch = 2.0 * np.pi / self.model.pair.pinion.z
        rows = [
            (result.stand.angle + tooth * pitch, value(k, tooth))
            for k, result in enumerate(self.results)
            for tooth in (int(tooth) for tooth in np.unique(result.contact.tooth))
        ]
        angle, values = zip(*sorted(rows)) if rows else ((), ())
        return Curve(np.array(angle), np.array(values))


def mesh_force(found: MeshPeriods) -> Curve:
    """Mesh force over the last mesh period [N; N/mm in 2D]."""
    angle = np.array([moment.result.stand.angle for moment in found.moments])
    return Curve(angle, np.array([moment.mesh_force for moment in found.moments]))


def largest(values: Floats) -> float:
    """Largest of the values (n,) that are known; NaN where none is."""
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else float("nan")
