"""The pressures of a pitch between its tip-edge zones, as `evolvent run` reports them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_slices import Slices, slices
from evolvent.gears.pressure.line_peaks import NO_PEAK, LinePeak, line_peak, zone_end_peaks
from evolvent.gears.pressure.tip_zones import path_between_zones, row_before_tip
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True, eq=False)
class PitchPressure:
    """Fitted peak pressures at the k positions of a pitch, at one friction coefficient."""

    pair: GearPair
    """The gear pair."""
    cuts: tuple[Slices, ...]
    """(k,) the contact of each position in slices."""
    inner_path: tuple[float, float]
    """Roll distances [mm] between which no slice bears on a tip edge at any friction coefficient."""

    @cached_property
    def at_positions(self) -> Floats:
        """(k,) largest peak pressure between the tip-edge zones [MPa]; NaN where no part of the contact lies there."""
        return np.array([_largest(self._line_peaks(cut)).pressure for cut in self.cuts])

    @cached_property
    def peak(self) -> LinePeak:
        """The largest of all positions; on a spur pair also of the limits of tip-edge zones, which lie between them."""
        return _largest([*(peak for cut in self.cuts for peak in self._line_peaks(cut)), *self._zone_end_peaks()])

    def _line_peaks(self, cut: Slices) -> list[LinePeak]:
        return [line_peak(self.pair, cut, int(tooth), self.inner_path) for tooth in np.unique(cut.tooth)]

    def _zone_end_peaks(self) -> list[LinePeak]:
        if self.pair.pinion.base_helix_angle != 0.0:
            return []
        return zone_end_peaks(self.pair, Slices.joined(self.cuts), self.inner_path)


def _largest(peaks: Sequence[LinePeak]) -> LinePeak:
    """`NO_PEAK` where no pressure is known."""
    return max((peak for peak in peaks if np.isfinite(peak.pressure)), key=lambda peak: peak.pressure, default=NO_PEAK)


def pitch_pressures(gears: GearModel, positions: Sequence[tuple[PositionResult, ...]]) -> tuple[PitchPressure, ...]:
    """The pressures at each friction coefficient. positions: of each position the results at all coefficients."""
    pinion, wheel = gears.bodies
    cuts = [[slices(result, pinion.z, (pinion.material, wheel.material)) for result in each] for each in positions]
    rows = row_before_tip(pinion.roll_length, pinion.mesh.order), row_before_tip(wheel.roll_length, wheel.mesh.order)
    known = [pair for results, row in zip(positions, cuts) for pair in zip(results, row)]
    inner = path_between_zones(gears.pair, known, rows)
    return tuple(PitchPressure(gears.pair, tuple(own), inner) for own in zip(*cuts))
