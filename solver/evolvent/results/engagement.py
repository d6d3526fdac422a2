"""Curves over the whole engagement of one tooth, assembled from the positions of one pitch.

At pinion rotation φ + 2π/z_1 tooth pair i stands where pair i + 1 stood at φ. Pair i at φ therefore represents one
tooth pair at its rotation φ + 2πi/z_1, which is 0 where the flanks meet at the pitch point of the mid-face section. The
three or four pairs in contact over a pitch make one curve over the whole engagement, with each rotation once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import (
    NO_PEAK,
    LinePeak,
    line_mean,
    line_peak,
    relief_zone_peaks,
    zone_end_peaks,
)
from evolvent.gears.pressure.pitch_pressure import PitchPressure
from evolvent.gears.pressure.relief_starts import relief_starts
from evolvent.gears.pressure.tip_zones import AT_LIMIT
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent_meshes.arrays import Bools, Floats, Ints

BESIDE = 3.0 * AT_LIMIT
"""A position of a spur pair within this roll distance [mm] of a tip-edge zone's limit lies at the limit."""


@dataclass(frozen=True)
class EngagementPeak:
    """A peak pressure on the curve of an engagement."""

    angle: float
    """Pinion rotation of the tooth [rad]; 0 at the pitch point."""
    pressure: float
    """Peak pressure [MPa]."""
    at_zone_end: bool
    """Whether the peak lies at the limit of a tip-edge zone, beyond which the pressure may rise further."""
    tooth: int
    """Index of the tooth pair, within the pitch, on which the peak occurs."""


UNKNOWN_PEAK = EngagementPeak(float("nan"), float("nan"), False, 0)


@dataclass(frozen=True)
class Engagement:
    """The engagement of one tooth at one friction coefficient, sampled at n rotations in ascending order."""

    friction: float
    """Friction coefficient μ."""
    angle: Floats
    """(n,) pinion rotation of the tooth [rad]; 0 at the pitch point."""
    position: Ints
    """(n,) index of the position of the pitch at which the entry was computed."""
    tooth: Ints
    """(n,) index of the tooth pair, within the pitch, for which the entry was computed."""
    force: Floats
    """(n,) normal force [N]."""
    share: Floats
    """(n,) share of the normal force of all teeth in contact."""
    max_pressure: Floats
    """(n,) largest peak pressure along the contact line [MPa], see `line_peak`; NaN where no part of the line lies
    between the tip-edge zones, and where the contact of a spur pair covers the start of a linear relief."""
    kink_pressure: Floats
    """(n,) largest peak pressure over the start of a linear relief [MPa]; NaN where the contact covers none, and in
    line contact, which has none there."""
    at_zone_end: Bools
    """(n,) bool, whether the largest peak pressure lies at the limit of a tip-edge zone."""
    mean_pressure: Floats
    """(n,) mean peak pressure along the contact line [MPa], see `line_mean`; NaN as `max_pressure`."""
    contact_length: Floats
    """(n,) length of the contact line [mm]."""
    zone_ends: tuple[EngagementPeak, ...] = field(default=(), kw_only=True)
    """Peaks of a spur pair between two positions: at the limits of its tip-edge zones, and where its contact begins to
    cover the start of a linear relief or ceases to."""
    relief_starts: tuple[float, ...] = field(default=(), kw_only=True)
    """Rotations [rad] at which the nominal contact of a spur pair passes the starts of linear reliefs."""

    @property
    def peak(self) -> EngagementPeak:
        """The largest pressure of the engagement; `UNKNOWN_PEAK` where no pressure is known."""
        return self._largest(np.flatnonzero(np.isfinite(self.max_pressure)), self.zone_ends)

    def tooth_peak(self, tooth: int) -> EngagementPeak:
        """The largest pressure on one tooth pair of the pitch; `UNKNOWN_PEAK` where no pressure is known."""
        entries = np.flatnonzero(np.isfinite(self.max_pressure) & (self.tooth == tooth))
        return self._largest(entries, [end for end in self.zone_ends if end.tooth == tooth])

    def _largest(self, entries: Ints, ends: Iterable[EngagementPeak]) -> EngagementPeak:
        """The largest pressure among the given entries and peaks at zone limits."""
        sampled = [
            EngagementPeak(
                float(self.angle[k]), float(self.max_pressure[k]), bool(self.at_zone_end[k]), int(self.tooth[k])
            )
            for k in entries
        ]
        return max([*sampled, *ends], key=lambda peak: peak.pressure, default=UNKNOWN_PEAK)

    @property
    def whole_mean(self) -> float:
        """Mean of `mean_pressure` over the rotations at which it is known [MPa]; NaN where it is known at none."""
        known = self.mean_pressure[np.isfinite(self.mean_pressure)]
        return float(np.mean(known)) if len(known) else float("nan")

    @property
    def pressure_curve(self) -> tuple[Floats, Floats]:
        """Rotations (m,) [rad], ascending, and largest pressures (m,) [MPa], with those at `zone_ends`; NaN at
        `relief_starts`."""
        angle = np.concatenate([self.angle, [end.angle for end in self.zone_ends], self.relief_starts])
        gaps = np.full(len(self.relief_starts), np.nan)
        order = np.argsort(angle, kind="stable")
        return angle[order], np.concatenate([self.max_pressure, [end.pressure for end in self.zone_ends], gaps])[order]

    @property
    def ends(self) -> tuple[float, float]:
        """Rotations [rad] at which the tooth takes up load and sheds it.

        The force is extrapolated by the parabola through its last three values, because the gap at a tip opens
        quadratically, and by at most one step, because the tooth carries no load at the next position.
        """
        step = float(np.diff(self.angle).min(initial=np.inf))
        if not np.isfinite(step):
            return float(self.angle[0]), float(self.angle[-1])
        before, after = _steps_to_zero(self.force[:3]), _steps_to_zero(self.force[:-4:-1])
        return float(self.angle[0]) - step * before, float(self.angle[-1]) + step * after


def _steps_to_zero(force: Floats) -> float:
    """Steps, at most one, after which an extrapolated force is zero. force: its last values (2 or 3,), the last first.
    Extrapolation is parabolic where the force falls ever faster, else linear."""
    slope = float(force[1] - force[0])
    bend = max(0.0, float(2.0 * force[1] - force[0] - force[-1])) if len(force) > 2 else 0.0
    fall = slope + 0.5 * bend  # F(x) = F_0 − fall·x − bend·x²/2 through x = 0, −1, −2
    full = fall + np.sqrt(fall**2 + 2.0 * bend * force[0])
    return min(1.0, float(2.0 * force[0] / full)) if full > 0.0 else 1.0


def engagement(run: RunData, index: int, inner: tuple[float, float] | None = None) -> Engagement:
    """The engagement at the friction coefficient with this index. inner: roll distances [mm] between which pressures
    are evaluated, by default those of the run (`RunData.inner_path`)."""
    inner = inner or run.inner_path
    rows = [row for k, each in enumerate(run.positions) for row in _rows(run, k, each[index], inner)]
    columns = [np.array(column) for column in zip(*sorted(rows))]
    angle, position, tooth, *values = columns
    radius, limits = run.pair.pinion.base_radius, _zone_ends(run, index, inner)
    tip_limits = [peak for peak in limits if peak.at_zone_end]
    curve = Engagement(run.frictions[index], angle, position, tooth, *values)
    at_limit = [np.abs(radius * angle - peak.roll_distance) <= BESIDE for peak in tip_limits]
    return replace(
        curve,
        at_zone_end=np.any([curve.at_zone_end.astype(bool), *at_limit], axis=0),
        zone_ends=tuple(
            EngagementPeak(angle, peak.pressure, peak.at_zone_end, int((angle - run.angles[0]) // run.pitch))
            for peak in limits for angle in [peak.roll_distance / radius]
        ),
        relief_starts=tuple(start.roll_distance / radius for start in relief_starts(run.pair)),
    )


def _zone_ends(run: RunData, index: int, inner: tuple[float, float]) -> list[LinePeak]:
    """Peaks of a spur pair at the limits of its tip-edge zones and of the zones about relief starts. A helical pair has
    none between positions: the slices of its contact line enter the zones one by one, see `line_peak`."""
    if run.pair.pinion.base_helix_angle != 0.0:
        return []
    cut = Slices.joined([each[index].cut for each in run.positions])
    return [*zone_end_peaks(run.pair, cut, inner), *relief_zone_peaks(run.pair, cut, inner)]


def engagements(run: RunData, inner: tuple[float, float] | None = None) -> list[Engagement]:
    """The engagement at each friction coefficient, in the order of the run. inner: see `engagement`."""
    return [engagement(run, index, inner) for index in range(len(run.frictions))]


def _rows(run: RunData, k: int, solved: SolvedPosition, inner: tuple[float, float]) -> list[tuple[float, ...]]:
    """Entries of `Engagement` after `friction`, one a tooth pair in contact at position k."""
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
            np.nan if run.is_line else tooth.kink_pressure or np.nan,
            peak.at_zone_end,
            line_mean(solved.cut, tooth.tooth, inner),
            tooth.contact_length * run.width,
        )
        for tooth, peak in zip(solved.teeth, peaks)
    ]


def with_hertz(run: RunData) -> RunData:
    """The run with Hertz' peak pressure for each slice's line load in place of the fitted peak."""
    return _with_cuts(run, Slices.of_hertz)


def with_line_loads(run: RunData) -> RunData:
    """The run with peak pressures that depend on the line loads alone, see `Slices.of_line_loads`."""
    return _with_cuts(run, lambda cut: cut.of_line_loads(run.pair))


def _with_cuts(run: RunData, changed: Callable[[Slices], Slices]) -> RunData:
    """The run with other slices at all positions."""
    return replace(
        run,
        positions=tuple(tuple(replace(solved, cut=changed(solved.cut)) for solved in each) for each in run.positions),
    )


def largest_peak(run: RunData, index: int) -> LinePeak:
    """The largest pressure of all positions and teeth at the friction coefficient with this index; on a spur pair also
    at the limits of zones between positions. `NO_PEAK` where no pressure is known."""
    radius = run.pair.pinion.base_radius
    if run.pair.pinion.base_helix_angle == 0.0:
        curve = engagement(run, index)
        if not np.isfinite(curve.max_pressure).any():
            return NO_PEAK
        return LinePeak(radius * curve.peak.angle, curve.peak.pressure, curve.peak.at_zone_end)
    return PitchPressure(run.pair, tuple(each[index].cut for each in run.positions), run.inner_path).peak


def sign_changes(x: Floats, y: Floats) -> Floats:
    """Places (m,) at which the curve y (n,) over x (n,) crosses zero, by linear interpolation; NaN in y is skipped."""
    known = np.isfinite(y)
    x, y = x[known], y[known]
    positive = y >= 0.0
    k = np.flatnonzero(positive[:-1] != positive[1:])
    return np.asarray(x[k] - y[k] * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def crossing(low: Engagement, high: Engagement) -> float:
    """Rotation of the tooth [rad] at which the curves of maximum pressure at two friction coefficients cross: the
    crossing nearest to the pitch point, NaN where there is none."""
    angle, first, second = np.intersect1d(np.round(low.angle, 9), np.round(high.angle, 9), return_indices=True)
    crossings = sign_changes(angle, high.max_pressure[second] - low.max_pressure[first])
    return float(crossings[np.argmin(np.abs(crossings))]) if len(crossings) else float("nan")
