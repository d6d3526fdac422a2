"""Peak pressures along a contact line between the tip-edge zones, where the pressure is not singular, and away from the
starts of linear reliefs, where it depends on how sharp the kink of the flank is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.pressure.contact_curvature import nominal_radius
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.relief_starts import zone_limits
from evolvent.gears.pressure.tip_zones import AT_LIMIT
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class LinePeak:
    """The largest peak pressure along a contact line between the tip-edge zones and away from relief starts."""

    roll_distance: float
    """Roll distance of the peak [mm]; NaN where there is none."""
    pressure: float
    """Peak pressure [MPa]; NaN where there is none: no part of the line lies between the zones, or the contact covers
    the start of a relief."""
    at_zone_end: bool
    """Whether the peak lies where a tip-edge zone begins, and the pressure may be larger further in."""


NO_PEAK = LinePeak(float("nan"), float("nan"), False)


def line_peak(pair: GearPair, cut: Slices, tooth: int, inner: tuple[float, float]) -> LinePeak:
    """The peak along a tooth's contact line. inner: limits of the tip-edge zones, as roll distances [mm].

    The pressure is interpolated to these limits: it is steepest there, and the maximum would jump from position to
    position with the slices that happen to lie inside.
    """
    line = np.flatnonzero(cut.tooth == tooth)
    line = line[np.argsort(cut.roll_distance[line])]
    fitted = line[counts(cut)[line]]
    if len(fitted) == 0:
        return NO_PEAK
    ξ, over = cut.roll_distance[fitted], _over_hertz(cut, fitted)
    inside = between(ξ, inner)
    limits = _limits_reached(cut, line, inner) if np.ptp(ξ) > 0.0 else np.zeros(0)
    load = np.union1d(line[1:-1], fitted)  # on a tip edge the first and the last are loaded over a part of their width
    more = _hertz_at(limits, pair, cut, load[np.argsort(cut.roll_distance[load])]) * np.interp(limits, ξ, over)
    places, peaks = np.concatenate([ξ[inside], limits]), np.concatenate([(over * cut.hertz[fitted])[inside], more])
    if len(peaks) == 0:
        return NO_PEAK
    top = int(np.argmax(peaks))
    return LinePeak(float(places[top]), float(peaks[top]), bool(top >= inside.sum()))


def pooled_peaks(cut: Slices) -> Floats:
    """Fitted peaks (n,) [MPa] of a position's slices, each averaged with its neighbours on the contact line as in
    `line_peak`; NaN where a slice has none that counts."""
    peaks = np.full(len(cut.peak), np.nan)
    for tooth in np.unique(cut.tooth):
        line = np.flatnonzero((cut.tooth == tooth) & counts(cut))
        line = line[np.argsort(cut.roll_distance[line])]
        if len(line) == 0:
            continue
        peaks[line] = _over_hertz(cut, line) * cut.hertz[line]
    return peaks


def _over_hertz(cut: Slices, fitted: Ints) -> Floats:
    """Fitted peaks (m,) of the slices along a line over Hertz' peaks for their line loads, averaged over neighbouring
    slices with weights 1, 2, 1.

    The line load of a slice is accurate, its fitted width less so: it depends on how the contact lies in the cells,
    which changes from slice to slice as the line crosses them. The squared widths (second moments) are averaged: where
    the contact is 1.7 elements wide they are alternately 8 % too large and too small, and a maximum would select these
    errors. Of narrow contacts (`Slices.narrow`) Hertz' peak is taken.
    """
    square = np.where(cut.narrow[fitted], 1.0, (cut.hertz[fitted] / cut.peak[fitted]) ** 2)
    summed, parts = (np.convolve(np.pad(each, 1), (1.0, 2.0, 1.0), "valid") for each in (square, np.ones_like(square)))
    return np.asarray(np.sqrt(parts / summed))


def _limits_reached(cut: Slices, line: Ints, inner: tuple[float, float]) -> Floats:
    """The limits of the tip-edge zones [mm] that a contact line reaches. line: its slices in order."""
    half, ends = 0.5 * np.max(np.diff(cut.roll_distance[line])), cut.roll_distance[line[[0, -1]]]
    return np.array([limit for limit in inner if ends[0] - half <= limit <= ends[1] + half])


def zone_end_peaks(pair: GearPair, cut: Slices, inner: tuple[float, float]) -> list[LinePeak]:
    """The peaks of a spur pair at the limits of its tip-edge zones, between two positions; none where no edge bears.

    cut: the slices of all positions, which at each height form one line along the path of contact; inner: the limits,
    as roll distances [mm].
    """
    lines = _lines(cut)
    return [max(peaks, key=lambda peak: peak.pressure) for x in inner if (peaks := _peaks_at(x, pair, cut, lines))]


def _lines(cut: Slices) -> list[Ints]:
    """The slices of all positions of a spur pair at each height, along the path of contact."""
    heights = [np.flatnonzero(cut.z == z) for z in np.unique(cut.z)]
    return [line[np.argsort(cut.roll_distance[line])] for line in heights]


def _peaks_at(x: float, pair: GearPair, cut: Slices, lines: list[Ints]) -> list[LinePeak]:
    """The peaks at the roll distance x [mm], one a height at which an edge bears beyond it."""
    peaks = []
    for line in lines:
        ξ = cut.roll_distance[line]
        beyond = cut.edge[line] & (np.abs(ξ) >= abs(x)) & (ξ * x > 0.0)
        fitted = line[counts(cut)[line]]
        if len(fitted) and beyond.any():
            at = np.array([x])
            over = np.interp(at, cut.roll_distance[fitted], _over_hertz(cut, fitted))
            peaks.append(LinePeak(x, float((_hertz_at(at, pair, cut, line) * over)[0]), True))
    return peaks


def relief_zone_peaks(pair: GearPair, cut: Slices, inner: tuple[float, float]) -> list[LinePeak]:
    """The peaks of a spur pair where its contact begins to cover the start of a linear relief or ceases to, between two
    positions: Hertz' for the load there, see `relief_starts`. cut, inner: see `zone_end_peaks`. Those within `AT_LIMIT`
    of a slice are left out."""
    peaks = []
    for line in _lines(cut):
        loaded, counting = line[cut.hertz[line] > 0.0], line[counts(cut)[line]]
        if len(counting) == 0:
            continue
        places = cut.roll_distance[counting]
        for x in zone_limits(pair, cut.of(loaded).contact_width):
            if between(np.array([x]), inner).all() and np.abs(places - x).min() > AT_LIMIT:
                peaks.append(LinePeak(x, float(_hertz_at(np.array([x]), pair, cut, loaded)[0]), False))
    return peaks


def has_peak(cut: Slices) -> Bools:
    """Whether a slice carries load and has a fitted peak, (n,) bool."""
    return np.asarray(np.isfinite(cut.peak) & (cut.hertz > 0.0))


def hertz_between(x: float, pair: GearPair, cut: Slices) -> float:
    """Largest of Hertz' peak pressures [MPa] at the roll distance x [mm], interpolated between the positions of a spur
    pair, over all heights; 0 where x is beyond the positions. cut: see `zone_end_peaks`."""
    lines = [line[cut.hertz[line] > 0.0] for line in _lines(cut)]
    within = [line for line in lines if counts(cut)[line].any() and np.ptp(np.sign(cut.roll_distance[line] - x)) > 1.0]
    return max((float(_hertz_at(np.array([x]), pair, cut, line)[0]) for line in within), default=0.0)


def counts(cut: Slices) -> Bools:
    """Whether a slice has a fitted peak and its contact covers no start of a linear relief, (n,) bool."""
    return has_peak(cut) & ~cut.kink


def between(ξ: Floats, inner: tuple[float, float]) -> Bools:
    """Whether slices at the roll distances ξ (n,) [mm] lie between the tip-edge zones with the limits `inner`: (n,)
    bool. A slice at a limit bears on the edge."""
    return np.asarray((ξ > inner[0] + AT_LIMIT) & (ξ < inner[1] - AT_LIMIT))


def _hertz_at(x: Floats, pair: GearPair, cut: Slices, load: Ints) -> Floats:
    """Hertz' peak pressure [MPa] for the line load at roll distances x (m,) [mm] of a contact line. load: its slices in
    order, some with a fitted peak. Line loads are known on tip edges too, where no peak can be fitted; extrapolating
    the peaks themselves would multiply their scatter. p0√R depends on the line load alone."""
    even = np.interp(x, cut.roll_distance[load], cut.hertz[load] * np.sqrt(cut.radius[load]))
    return np.asarray(even / np.sqrt(_radius_at(x, pair, cut, load[has_peak(cut)[load]])))


def _radius_at(x: Floats, pair: GearPair, cut: Slices, fitted: Ints) -> Floats:
    """Relative radius of curvature [mm] where the contact lies, at roll distances x (m,) [mm] of a contact line: over
    that on the nominal line as at the slices beside. fitted: the line's slices with a fitted peak, in order; a slice on
    a tip edge does not tell where the contact lies."""
    ξ = cut.roll_distance[fitted]
    return nominal_radius(pair, x) * np.interp(x, ξ, cut.radius[fitted] / nominal_radius(pair, ξ))


def line_mean(cut: Slices, tooth: int, inner: tuple[float, float]) -> float:
    """Mean of the fitted peak pressures [MPa] along a tooth's contact line between the tip-edge zones and away from
    relief starts; NaN where no slice with a fitted peak is left. inner: see `line_peak`."""
    here = (cut.tooth == tooth) & counts(cut) & between(cut.roll_distance, inner)
    return float(np.average(cut.peak[here], weights=cut.width[here])) if here.any() else float("nan")
