"""Fitted peak pressures of a pitch's slices between the tip-edge zones, beside Hertz' and beside another mesh's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import between, has_peak
from evolvent.gears.pressure.pitch_pressure import pitch_pressures
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Bools, Floats

Place = tuple[int, int, float]
"""Position, tooth pair and height [mm] of a slice."""


@dataclass(frozen=True)
class SlicePeaks:
    """The n slices with a fitted peak between the tip-edge zones, at all positions and one friction coefficient."""

    places: list[Place]
    """(n,)."""
    peak: Floats
    """(n,) fitted peak pressure [MPa]."""
    hertz: Floats
    """(n,) Hertz' for the slice's line load and the curvatures where the contact lies [MPa]."""
    near_end: Bools
    """(n,) whether the slice is nearer than one normal module to a face end."""

    def differences(self, exact: SlicePeaks) -> tuple[Floats, Bools]:
        """|peak / other's peak − 1| (m,) of the slices that both have, and which are near a face end."""
        other = dict(zip(exact.places, exact.peak))
        both = np.array([place in other for place in self.places], dtype=bool)
        wanted = np.array([other[place] for place in self.places if place in other])
        return np.abs(self.peak[both] / wanted - 1.0), self.near_end[both]


def slice_peaks(model: GearModel, positions: Sequence[tuple[PositionResult, ...]]) -> list[SlicePeaks]:
    """Of each friction coefficient. positions: of each position the results at all coefficients."""
    found = []
    for pressure in pitch_pressures(model, positions):
        parts = [_peaks(model, k, cut, pressure.inner_path) for k, cut in enumerate(pressure.cuts)]
        columns = ("peak", "hertz", "near_end")
        joined = (np.concatenate([getattr(part, name) for part in parts]) for name in columns)
        found.append(SlicePeaks([place for part in parts for place in part.places], *joined))
    return found


def _peaks(model: GearModel, position: int, cut: Slices, inner: tuple[float, float]) -> SlicePeaks:
    """Slices whose peak is no fit, but the largest of a few points, are left out."""
    used = np.flatnonzero(has_peak(cut) & np.isfinite(cut.half_width) & between(cut.roll_distance, inner))
    gear, bottom, top = model.pair.pinion, model.bodies[0].z.min(), model.bodies[0].z.max()
    from_end = np.minimum(cut.z[used] - bottom, top - cut.z[used])
    places = [(position, int(cut.tooth[i]), round(float(cut.z[i]), 6)) for i in used]
    return SlicePeaks(places, cut.peak[used], cut.hertz[used], from_end < gear.normal_module)
