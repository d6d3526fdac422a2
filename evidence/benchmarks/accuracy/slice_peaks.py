"""Fitted peak pressures of a pitch's slices between the tip-edge zones, beside Hertz' and beside another mesh's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_slices import HEIGHT_TOLERANCE, Slices
from evolvent.gears.pressure.line_peaks import between, has_peak
from evolvent.gears.pressure.pitch_pressure import pitch_pressures
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member

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
    """(n,) Hertz' for the slice's line load and the curvatures on the nominal contact line [MPa]."""
    hertz_in_place: Floats
    """(n,) the same for the curvatures where the contact lies (`hertz_in_place`) [MPa]."""
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
    for number, pressure in enumerate(pitch_pressures(model, positions)):
        parts = [
            _peaks(model, k, results[number], cut, pressure.inner_path)
            for k, (results, cut) in enumerate(zip(positions, pressure.cuts))
        ]
        columns = ("peak", "hertz", "hertz_in_place", "near_end")
        joined = (np.concatenate([getattr(part, name) for part in parts]) for name in columns)
        found.append(SlicePeaks([place for part in parts for place in part.places], *joined))
    return found


def _peaks(
    model: GearModel, position: int, result: PositionResult, cut: Slices, inner: tuple[float, float]
) -> SlicePeaks:
    """Slices whose peak is no fit, but the largest of a few points, are left out."""
    used = np.flatnonzero(has_peak(cut) & np.isfinite(cut.half_width) & between(cut.roll_distance, inner))
    gear, bottom, top = model.pair.pinion, model.bodies[0].z.min(), model.bodies[0].z.max()
    from_end = np.minimum(cut.z[used] - bottom, top - cut.z[used])
    places = [(position, int(cut.tooth[i]), round(float(cut.z[i]), 6)) for i in used]
    local = hertz_in_place(result, cut, used)
    return SlicePeaks(places, cut.peak[used], cut.hertz[used], local, from_end < gear.normal_module)


def hertz_in_place(result: PositionResult, cut: Slices, used: Ints) -> Floats:
    """Hertz' p0 (m,) [MPa] of some slices for the curvatures at the centre of their pressure on both flanks.

    Under load the contact does not lie on the nominal contact line: teeth bend, and each flank is touched some
    hundredths of a millimetre away from where rigid ones would. Near the base circle that changes the curvature by
    several per cent: ρ² = ρ_0² + 2 r_b s, s the arc of the involute between both places.
    """
    pair, c = result.stand.pair, result.contact
    before, after = np.zeros(len(used)), np.zeros(len(used))
    for member, arc in ((Member.PINION, c.across), (Member.WHEEL, c.opposite)):
        nominal = pair.pitch_point_roll_lengths[member] + member.sign * cut.roll_distance[used]
        moved = np.array([_centre(result, cut, i, arc) for i in used])
        before += 1.0 / nominal
        after += 1.0 / np.sqrt(nominal**2 + 2.0 * pair.gears[member].base_radius * moved)
    return np.asarray(cut.hertz[used] * np.sqrt(after / before))


def _centre(result: PositionResult, cut: Slices, i: int, arc: Floats) -> float:
    """Mean of a coordinate of the contact points in slice i, weighted with their forces."""
    c = result.contact
    here = (c.tooth == cut.tooth[i]) & (np.abs(c.z - cut.z[i]) <= 0.5 * cut.width[i] + HEIGHT_TOLERANCE)
    return float(np.average(arc[here], weights=c.pressure[here] * np.abs(c.weights[here])))
