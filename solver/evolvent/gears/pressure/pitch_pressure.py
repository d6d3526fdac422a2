"""The pressures of a pitch between its tip-edge zones and away from relief starts, as `evolvent run` reports them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_slices import Slices, slices
from evolvent.gears.pressure.flank_facets import FlankFacets
from evolvent.gears.pressure.line_peaks import NO_PEAK, LinePeak, line_peak, relief_zone_peaks, zone_end_peaks
from evolvent.gears.pressure.tip_zones import path_between_zones
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True, eq=False)
class PitchPressure:
    """Fitted peak pressures at the k positions of a pitch, at one friction coefficient."""

    pair: GearPair
    """The gear pair."""
    cuts: tuple[Slices, ...]
    """Contact (k,) of each position in slices."""
    inner_path: tuple[float, float]
    """Roll distances [mm] between which no slice bears on a tip edge at any friction coefficient."""

    @cached_property
    def at_positions(self) -> Floats:
        """Largest peak pressure (k,) between the tip-edge zones and away from the starts of linear reliefs [MPa]; NaN
        where no part of the contact lies there."""
        return np.array([_largest(self._line_peaks(cut)).pressure for cut in self.cuts])

    @cached_property
    def peak(self) -> LinePeak:
        """The largest of all positions; on a spur pair also of the limits of tip-edge zones and of the zones about
        relief starts, which lie between them."""
        return _largest([*(peak for cut in self.cuts for peak in self._line_peaks(cut)), *self._zone_end_peaks()])

    def _line_peaks(self, cut: Slices) -> list[LinePeak]:
        return [line_peak(self.pair, cut, int(tooth), self.inner_path) for tooth in np.unique(cut.tooth)]

    def _zone_end_peaks(self) -> list[LinePeak]:
        if self.pair.pinion.base_helix_angle != 0.0:
            return []
        cut = Slices.joined(self.cuts)
        return [*zone_end_peaks(self.pair, cut, self.inner_path), *relief_zone_peaks(self.pair, cut, self.inner_path)]


def _largest(peaks: Sequence[LinePeak]) -> LinePeak:
    """Largest of some peaks; `NO_PEAK` where no pressure is known."""
    return max((peak for peak in peaks if np.isfinite(peak.pressure)), key=lambda peak: peak.pressure, default=NO_PEAK)


def facets_of(gears: GearModel) -> tuple[FlankFacets, FlankFacets]:
    """The facets of both loaded flanks."""
    pinion, wheel = (
        FlankFacets.of(body.z, body.roll_length, body.gear.base_radius, body.mesh.order) for body in gears.bodies
    )
    return pinion, wheel


def pitch_pressures(gears: GearModel, positions: Sequence[tuple[PositionResult, ...]]) -> tuple[PitchPressure, ...]:
    """The pressures at each friction coefficient. positions: of each position the results at all coefficients."""
    pinion, wheel = gears.bodies
    flanks = facets_of(gears)
    cuts = [[slices(result, flanks, (pinion.material, wheel.material)) for result in each] for each in positions]
    rows = flanks[0].row_before_tip, flanks[1].row_before_tip
    known = [pair for results, row in zip(positions, cuts) for pair in zip(results, row)]
    inner = path_between_zones(gears.pair, known, rows)
    return tuple(PitchPressure(gears.pair, tuple(own), inner) for own in zip(*cuts))
