"""The whole engagement of one tooth, put together from one pitch.

At pinion rotation φ + 2π/z_1 tooth pair i stands where pair i + 1 stood at φ. So pair i at φ is one tooth pair at
φ + 2πi/z_1, its own rotation: 0 where its flanks meet at the pitch point of the mid-face section. A pitch with the
three or four pairs that touch is then a curve over the whole engagement, each rotation met once.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from evolvent.results.contact_slices import Slices
from evolvent.results.line_peaks import NO_PEAK, LinePeak, line_mean, line_peak, zone_end_peaks
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.tip_zones import AT_LIMIT
from evolvent_meshes.arrays import Floats, Ints

BESIDE = 3.0 * AT_LIMIT
"""Roll distance [mm] from the end of a tip-edge zone within which a spur pair's position stands at it."""


@dataclass(frozen=True)
class TurnPeak:
    """A pressure of an engagement."""

    angle: float
    """The tooth's own pinion rotation [rad]."""
    pressure: float
    """[MPa]."""
    at_zone_end: bool
    """It lies where a tip-edge zone begins, and pressure may rise on."""
    tooth: int
    """The tooth pair of the pitch that has it."""


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
    zone_ends: tuple[TurnPeak, ...] = field(default=(), kw_only=True)
    """Where a spur pair enters the tip-edge zones, between two positions."""

    @property
    def peak(self) -> TurnPeak:
        """The largest pressure. Raises ValueError where there is none."""
        return self._largest(np.flatnonzero(np.isfinite(self.max_pressure)), self.zone_ends)

    def peak_of(self, tooth: int) -> TurnPeak:
        """The largest pressure of a tooth pair in the pitch. Raises ValueError where there is none."""
        here = np.flatnonzero(np.isfinite(self.max_pressure) & (self.tooth == tooth))
        return self._largest(here, [end for end in self.zone_ends if end.tooth == tooth])

    def _largest(self, here: Ints, ends: Iterable[TurnPeak]) -> TurnPeak:
        """Of the entries `here` and the ends of zones."""
        top = here[int(np.argmax(self.max_pressure[here]))]
        own = TurnPeak(
            float(self.angle[top]), float(self.max_pressure[top]), bool(self.at_zone_end[top]), int(self.tooth[top])
        )
        return max([own, *ends], key=lambda peak: peak.pressure)

    @property
    def pressure_curve(self) -> tuple[Floats, Floats]:
        """(rotations [rad], largest pressures [MPa]), those at `zone_ends` among them."""
        angle = np.append(self.angle, [end.angle for end in self.zone_ends])
        order = np.argsort(angle, kind="stable")
        return angle[order], np.append(self.max_pressure, [end.pressure for end in self.zone_ends])[order]

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
    radius, entered = run.pair.pinion.base_radius, _zone_ends(run, index, inner)
    curve = Engagement(run.frictions[index], angle, position, tooth, *values)
    there = [np.abs(radius * angle - peak.roll_distance) <= BESIDE for peak in entered]
    return replace(
        curve,
        at_zone_end=np.any([curve.at_zone_end.astype(bool), *there], axis=0),
        zone_ends=tuple(
            TurnPeak(angle, peak.pressure, True, int((angle - run.angles[0]) // run.pitch))
            for peak in entered for angle in [peak.roll_distance / radius]
        ),
    )  # fmt: skip


def _zone_ends(run: RunData, index: int, inner: tuple[float, float]) -> list[LinePeak]:
    """Of a spur pair; a helical line's own slices enter the zones one by one, see `line_peak`."""
    if run.pair.pinion.base_helix_angle != 0.0:
        return []
    return zone_end_peaks(run.pair, Slices.joined([each[index].cut for each in run.positions]), inner)


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


def with_hertz(run: RunData, at_edges: bool = False) -> RunData:
    """The run with Hertz's peak pressure for its own line load in place of each slice's fitted one. at_edges: also
    where a slice bears on a tip edge."""

    def exact(solved: SolvedPosition) -> SolvedPosition:
        cut = solved.cut
        peak = cut.hertz if at_edges else np.where(cut.edge, np.nan, cut.hertz)
        return replace(solved, cut=replace(cut, peak=peak))

    return replace(run, positions=tuple(tuple(exact(solved) for solved in each) for each in run.positions))


def largest_peak(run: RunData, index: int) -> LinePeak:
    """The largest pressure of all positions and teeth, and between positions where a spur pair enters a tip-edge
    zone."""
    radius = run.pair.pinion.base_radius
    if run.pair.pinion.base_helix_angle == 0.0:
        curve = engagement(run, index)
        if not np.isfinite(curve.max_pressure).any():
            return NO_PEAK
        return LinePeak(radius * curve.peak.angle, curve.peak.pressure, curve.peak.at_zone_end)
    lines = [(each[index].cut, tooth.tooth) for each in run.positions for tooth in each[index].teeth]
    found = [line_peak(run.pair, cut, tooth, run.inner_path) for cut, tooth in lines]
    return max((peak for peak in found if np.isfinite(peak.pressure)), key=lambda peak: peak.pressure, default=NO_PEAK)


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
