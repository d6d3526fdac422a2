"""The whole engagement of one tooth, put together from one pitch.

At pinion rotation φ + 2π/z_1 tooth pair i stands where pair i + 1 stood at φ. So pair i at φ is one tooth pair at
φ + 2πi/z_1, its own rotation: 0 where its flanks meet at the pitch point of the mid-face section. A pitch with the
three or four pairs that touch is then a curve over the whole engagement, each rotation met once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from meshes.data import Floats, Ints
from meshes.parameters import GearPair
from solver.gear_results import Slices
from solver.run_data import RunData, SolvedPosition

AT_THE_END = 0.01
"""Roll distance [mm] within which a slice is at the end of a tip-edge zone. An end is the place of a slice that bears
on the edge; at the same position another mesh or friction coefficient has its own a micrometre beside it, and
round-off must not decide whether that counts."""


@dataclass(frozen=True)
class Engagement:
    """One tooth's way through the mesh at one friction coefficient; entries (n,) ascend with `angle`.

    angle: the tooth's own pinion rotation [rad]. position, tooth: where in the pitch it was computed. force: normal
    [N]. share: of the sum over all teeth [-]. max_pressure, mean_pressure [MPa]: see `line_peak` and `line_mean`, NaN
    where nothing of the line lies between the tip-edge zones. at_zone_end: (n,) bool, the maximum lies where such a
    zone begins. contact_length [mm].
    """

    friction: float
    angle: Floats
    position: Ints
    tooth: Ints
    force: Floats
    share: Floats
    max_pressure: Floats
    at_zone_end: np.ndarray
    mean_pressure: Floats
    contact_length: Floats

    @property
    def ends(self) -> tuple[float, float]:
        """Rotations [rad] at which the tooth takes up its load and has given it up: the force is continued by the
        parabola through its last three values, for a tip leaves its mate's path quadratically, and at most by a step,
        for the next position has none."""
        step = float(np.diff(self.angle).min(initial=np.inf))
        if not np.isfinite(step):
            return float(self.angle[0]), float(self.angle[-1])
        before, after = _steps_to_zero(self.force[:3]), _steps_to_zero(self.force[:-4:-1])
        return float(self.angle[0]) - step * before, float(self.angle[-1]) + step * after


def _steps_to_zero(force: Floats) -> float:
    """In how many steps, at most one, a force is zero whose last values (2 or 3,), the very last one first, rise from
    there; by a parabola where it falls ever faster, else by a straight line."""
    slope = float(force[1] - force[0])
    bend = max(0.0, float(2.0 * force[1] - force[0] - force[-1])) if len(force) > 2 else 0.0
    fall = slope + 0.5 * bend  # F(x) = F_0 − fall·x − bend·x²/2 through x = 0, −1, −2
    full = fall + np.sqrt(fall**2 + 2.0 * bend * force[0])
    return min(1.0, float(2.0 * force[0] / full)) if full > 0.0 else 1.0


def engagement(run: RunData, index: int, inner: tuple[float, float] | None = None) -> Engagement:
    """The engagement at friction coefficient number `index`. inner: roll distances [mm] between which pressures
    are looked at; those of the run itself unless given, see `RunData.inner_path`."""
    inner = inner or run.inner_path
    rows = [row for k, each in enumerate(run.positions) for row in _rows(run, k, each[index], inner)]
    columns = [np.array(column) for column in zip(*sorted(rows))]
    angle, position, tooth, *values = columns
    return Engagement(run.frictions[index], angle, position, tooth, *values)


def engagements(run: RunData, inner: tuple[float, float] | None = None) -> list[Engagement]:
    """One per friction coefficient; inner: see `engagement`."""
    return [engagement(run, index, inner) for index in range(len(run.frictions))]


def _rows(run: RunData, k: int, solved: SolvedPosition, inner: tuple[float, float]) -> list[tuple[float, ...]]:
    total = sum(tooth.force for tooth in solved.teeth)
    peaks = [line_peak(run.pair, solved.cut, tooth.tooth, inner) for tooth in solved.teeth]
    return [
        (
            solved.result.stand.angle + tooth.tooth * run.pitch,
            k,
            tooth.tooth,
            tooth.force * run.width,
            tooth.force / total,
            peak.pressure,
            peak.at_zone_end,
            line_mean(solved.cut, tooth.tooth, inner),
            tooth.contact_length * run.width,
        )
        for tooth, peak in zip(solved.teeth, peaks)
    ]


@dataclass(frozen=True)
class LinePeak:
    """The largest peak pressure [MPa] along a contact line between the tip-edge zones, at the roll distance ξ [mm];
    both NaN where nothing of the line lies there. at_zone_end: it lies where such a zone begins, and pressure may rise
    on."""

    ξ: float
    pressure: float
    at_zone_end: bool


NO_PEAK = LinePeak(float("nan"), float("nan"), False)


def with_hertz(run: RunData, at_edges: bool = False) -> RunData:
    """The run with Hertz's peak pressure for its own line load in place of each slice's fitted one. at_edges: also
    where a slice bears on a tip edge."""

    def exact(solved: SolvedPosition) -> SolvedPosition:
        cut = solved.cut
        peak = cut.hertz if at_edges else np.where(cut.edge, np.nan, cut.hertz)
        return replace(solved, cut=replace(cut, peak=peak))

    return replace(run, positions=tuple(tuple(exact(solved) for solved in each) for each in run.positions))


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
    more = _hertz_at(limits, pair, cut, line, fitted) * np.interp(limits, ξ, over)
    places, peaks = np.concatenate([ξ[inside], limits]), np.concatenate([(over * cut.hertz[fitted])[inside], more])
    if len(peaks) == 0:
        return NO_PEAK
    top = int(np.argmax(peaks))
    return LinePeak(float(places[top]), float(peaks[top]), bool(top >= inside.sum()))


def largest_peak(run: RunData, index: int) -> LinePeak:
    """The largest `line_peak` of all positions and teeth."""
    lines = [(each[index].cut, tooth.tooth) for each in run.positions for tooth in each[index].teeth]
    found = [line_peak(run.pair, cut, tooth, run.inner_path) for cut, tooth in lines]
    return max((peak for peak in found if np.isfinite(peak.pressure)), key=lambda peak: peak.pressure, default=NO_PEAK)


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


def has_peak(cut: Slices) -> np.ndarray:
    """(n,) bool: the slices that carry load and have a fitted peak."""
    return np.asarray(np.isfinite(cut.peak) & (cut.hertz > 0.0))


def between(ξ: Floats, inner: tuple[float, float]) -> np.ndarray:
    """(n,) bool: whether slices at the roll distances ξ [mm] lie between the tip-edge zones, whose ends are `inner`; at
    an end, one bears on the edge."""
    return np.asarray((ξ > inner[0] + AT_THE_END) & (ξ < inner[1] - AT_THE_END))


def _hertz_at(x: Floats, pair: GearPair, cut: Slices, line: Ints, fitted: Ints) -> Floats:
    """Hertz's peak pressure [MPa] for the line load where a contact line has the roll distances x (m,) [mm].

    The loads are known on tip edges too, where no peak can be fitted: continuing the peaks themselves would multiply
    their scatter. A line's first and last slice on a tip edge are loaded over a part of their width: they are left out.
    """
    load = np.union1d(line[1:-1], fitted)
    load = load[np.argsort(cut.ξ[load])]
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


def sign_changes(x: Floats, y: Floats) -> Floats:
    """Where the curve y (n,) over x (n,) crosses zero, by linear interpolation; NaN in y is passed over."""
    known = np.isfinite(y)
    x, y = x[known], y[known]
    positive = y >= 0.0
    k = np.flatnonzero(positive[:-1] != positive[1:])
    return np.asarray(x[k] - y[k] * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def crossing(low: Engagement, high: Engagement) -> float:
    """The tooth's rotation [rad] at which the curves of maximum pressure of two friction coefficients cross, the one
    nearest to the pitch point; NaN where they do not cross."""
    angle, first, second = np.intersect1d(np.round(low.angle, 9), np.round(high.angle, 9), return_indices=True)
    found = sign_changes(angle, high.max_pressure[second] - low.max_pressure[first])
    return float(found[np.argmin(np.abs(found))]) if len(found) else float("nan")
