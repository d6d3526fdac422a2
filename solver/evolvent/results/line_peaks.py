"""Peak pressures along a contact line, between the tip-edge zones, in which the pressure is singular."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.results.contact_slices import Slices
from evolvent.results.tip_zones import AT_THE_END
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class LinePeak:
    """The largest peak pressure [MPa] along a contact line between the tip-edge zones, at the roll distance ξ [mm];
    both NaN where nothing of the line lies there. at_zone_end: it lies where such a zone begins, and pressure may rise
    on."""

    ξ: float
    pressure: float
    at_zone_end: bool


NO_PEAK = LinePeak(float("nan"), float("nan"), False)


def line_peak(pair: GearPair, cut: Slices, tooth: int, inner: tuple[float, float]) -> LinePeak:
    """Along a tooth's contact line between the tip-edge zones, whose ends are the roll distances `inner` [mm].

    The line is cut where it enters these zones: which slices happen to lie inside would make the maximum jump from
    position to position, for the pressure is steepest there.
    """
    line = np.flatnonzero(cut.tooth == tooth)
    line = line[np.argsort(cut.ξ[line])]
    fitted = line[has_peak(cut)[line]]
    if len(fitted) == 0:
        return NO_PEAK
    ξ, over = cut.ξ[fitted], _over_hertz(cut, fitted)
    inside = between(ξ, inner)
    limits = _zone_ends(cut, line, inner) if np.ptp(ξ) > 0.0 else np.zeros(0)
    load = np.union1d(line[1:-1], fitted)  # on a tip edge the first and the last are loaded over a part of their width
    more = _hertz_at(limits, pair, cut, load[np.argsort(cut.ξ[load])]) * np.interp(limits, ξ, over)
    places, peaks = np.concatenate([ξ[inside], limits]), np.concatenate([(over * cut.hertz[fitted])[inside], more])
    if len(peaks) == 0:
        return NO_PEAK
    top = int(np.argmax(peaks))
    return LinePeak(float(places[top]), float(peaks[top]), bool(top >= inside.sum()))


def pooled_peaks(cut: Slices) -> Floats:
    """The fitted peaks (n,) [MPa] of a position's slices as `line_peak` takes them, pooled with their neighbours on the
    line; NaN where there is none."""
    peaks = np.full(len(cut.peak), np.nan)
    for tooth in np.unique(cut.tooth):
        line = np.flatnonzero((cut.tooth == tooth) & has_peak(cut))
        line = line[np.argsort(cut.ξ[line])]
        if len(line) == 0:
            continue
        peaks[line] = _over_hertz(cut, line) * cut.hertz[line]
    return peaks


def _over_hertz(cut: Slices, fitted: Ints) -> Floats:
    """Fitted peaks (m,) of the slices along a line over Hertz's for their loads, each slice pooled with its neighbours
    in parts of 1, 2, 1.

    A fit knows its slice's load well, and the width less so: that depends on how the contact lies in the cells, which
    differs from slice to slice as the line crosses them. Widths' squares, the second moments, are pooled: where the
    contact is 1.7 elements wide they are 8 % too large and too small by turns, and the largest of them would be taken.
    """
    square = (cut.hertz[fitted] / cut.peak[fitted]) ** 2
    summed, parts = (np.convolve(np.pad(each, 1), (1.0, 2.0, 1.0), "valid") for each in (square, np.ones_like(square)))
    return np.asarray(np.sqrt(parts / summed))


def _zone_ends(cut: Slices, line: Ints, inner: tuple[float, float]) -> Floats:
    """Those of the roll distances `inner` that a line, its slices in order, comes to."""
    half, ends = 0.5 * np.max(np.diff(cut.ξ[line])), cut.ξ[line[[0, -1]]]
    return np.array([limit for limit in inner if ends[0] - half <= limit <= ends[1] + half])


def zone_end_peaks(pair: GearPair, cut: Slices, inner: tuple[float, float]) -> list[LinePeak]:
    """Where a spur pair enters the tip-edge zones: at the ends `inner` [mm], between two positions. cut: the slices of
    all positions, which at each height are one line along the path of contact; none where no edge bears there."""
    heights = [np.flatnonzero(cut.z == z) for z in np.unique(cut.z)]
    lines = [line[np.argsort(cut.ξ[line])] for line in heights]
    return [max(found, key=lambda peak: peak.pressure) for x in inner if (found := _peaks_at(x, pair, cut, lines))]


def _peaks_at(x: float, pair: GearPair, cut: Slices, lines: list[Ints]) -> list[LinePeak]:
    """Of the heights at which an edge bears beyond the roll distance x [mm]."""
    found = []
    for line in lines:
        fitted = line[has_peak(cut)[line]]
        beyond = cut.edge[line] & (np.abs(cut.ξ[line]) >= abs(x)) & (cut.ξ[line] * x > 0.0)
        if len(fitted) and beyond.any():
            at = np.array([x])
            over = np.interp(at, cut.ξ[fitted], _over_hertz(cut, fitted))
            found.append(LinePeak(x, float((_hertz_at(at, pair, cut, line) * over)[0]), True))
    return found


def has_peak(cut: Slices) -> np.ndarray:
    """(n,) bool: the slices that carry load and have a fitted peak."""
    return np.asarray(np.isfinite(cut.peak) & (cut.hertz > 0.0))


def between(ξ: Floats, inner: tuple[float, float]) -> np.ndarray:
    """(n,) bool: whether slices at the roll distances ξ [mm] lie between the tip-edge zones, whose ends are `inner`; at
    an end, one bears on the edge."""
    return np.asarray((ξ > inner[0] + AT_THE_END) & (ξ < inner[1] - AT_THE_END))


def _hertz_at(x: Floats, pair: GearPair, cut: Slices, load: Ints) -> Floats:
    """Hertz's peak pressure [MPa] for the line load where a contact line, its slices `load` in order, has the roll
    distances x (m,) [mm]. The loads are known on tip edges too, where no peak can be fitted: continuing the peaks
    themselves would multiply their scatter."""
    even = np.interp(x, cut.ξ[load], cut.hertz[load] * _root_of_radius(pair, cut.ξ[load]))
    return np.asarray(even / _root_of_radius(pair, x))


def _root_of_radius(pair: GearPair, ξ: Floats) -> Floats:
    """√R [√mm] at roll distances; p0√R depends on the line load alone."""
    return np.sqrt(pair.relative_curvature_radius(np.clip(ξ, *pair.path_of_contact)))


def line_mean(cut: Slices, tooth: int, inner: tuple[float, float]) -> float:
    """Mean along the contact line of the fitted peak pressures [MPa] between the tip-edge zones, see `line_peak`; NaN
    where no slice with a fitted peak is left."""
    here = (cut.tooth == tooth) & has_peak(cut) & between(cut.ξ, inner)
    return float(np.average(cut.peak[here], weights=cut.width[here])) if here.any() else float("nan")
