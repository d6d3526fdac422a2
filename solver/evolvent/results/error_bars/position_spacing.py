"""How far a run's figures may be off because its positions are so far apart: the part of the error bars that is known
without another mesh.

Curves over the pitch are smooth but for kinks and jumps, where a tooth enters or leaves, where a relief begins. Of any
figure, the *thinned* one, of every other position, is off by more than that of all; how much more is one estimate. Of
an odd number two neighbours are kept, and means weight each position with its share of the closed pitch. The estimate
misses what lies between two positions, so the larger one is taken of it and

- of an extreme: how much further the curve may reach between two positions if it goes on straight from both sides.
  Where these lines meet there is a kink, or a smooth top, which is a quarter as high: as far as the curve bends as much
  before and after. Where one lies above the other all over, the curve jumps, as pressures nearly do, in the middle on
  average. All pairs of positions are looked at: a peak may be narrower than their distance.
- of a mean: what kinks or jumps change at an unknown place between two positions. A jump by J changes the mean of n by
  at most J/2n; a kink that bends the curve by J from one position to the next by J/12n on average, and the step that
  it lies in shows about half of J. Those of all positions are independent of each other.

The largest pressure is read from a tooth's engagement, which ends where it enters a tip-edge zone: if the curve rises
up to there, then by how much it does in one step more. Where a linear tip relief begins, the largest pressure over that
kink is known without a position there (`relief_kinks`): the bar goes up to it, and what is reached on it is no more.
Pressures scatter from position to position as the contact lies in the cells: of so many the largest is twice the
scatter above what fewer show.

With friction, what a position remembers of those before it also depends on how far apart they are. That is in none of
these estimates: in a helical pair at μ = 0.2 it is 0.1 % of the secant stiffness at 20 positions.

evidence/benchmarks/accuracy/spacing.py compares these estimates with many positions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace

import numpy as np

from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.engagement import Engagement, TurnPeak, engagement
from evolvent.results.position_figures import loss_percent, mesh_stiffness, secant_stiffness, transmission_error_um
from evolvent.results.relief_kinks import ReliefKink, relief_kinks
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent_meshes.arrays import Floats, Ints

JUMP, KINK = 0.5, 1.0 / 6.0
"""Share of a step's bend by which its mean moves with the place of a jump or a kink in it."""
SMOOTH = 0.75
"""Share of what lies below two lines that meet which a parabola with the same slopes at the samples does not reach."""
SCATTERS = 2.0
"""Standard deviations: the largest of a hundred values of a pressure's scatter over the largest of ten."""
DEVIATIONS = 0.6745
"""The median of the absolute value of a normal distribution, in standard deviations."""

OfPosition = Callable[[RunData, SolvedPosition], float]
Curve = tuple[Floats, Floats]
"""Places and values."""


def spacing_errors(run: RunData, index: int) -> FigureErrors:
    """Of the figures at friction coefficient number `index`; NaN where a run has a single position."""
    run = replace(run, positions=run.positions[: run.scene.sweep.positions])  # of one pitch, where more were swept
    if len(run.positions) < 2:
        return FigureErrors(*[float("nan")] * len(fields(FigureErrors)))
    count = len(run.positions)
    whole, halves = engagement(run, index), [every_other(count, first) for first in (0, 1)]
    thin = [engagement(replace(run, positions=tuple(run.positions[k] for k in kept)), index) for kept in halves]
    error, tangent, secant, loss = (
        _values(run, index, value) for value in (transmission_error_um, mesh_stiffness, secant_stiffness, loss_percent)
    )
    largest = _apart(_largest(whole), [_largest(curve) for curve in thin])
    mean = [_mean(curve.mean_pressure, shares(kept, count)[curve.position]) for curve, kept in zip(thin, halves)]
    scattered, higher = SCATTERS * scatter(whole.max_pressure), _higher(run, whole, relief_kinks(run, index))
    return FigureErrors(
        max_pressure_MPa=_larger(largest, higher, scattered),
        mean_pressure_MPa=_larger(_apart(_mean(whole.mean_pressure), mean), _mean_bends(whole)),
        transmission_error_peak_to_peak_um=_larger(
            _apart(float(np.ptp(error)), [float(np.ptp(error[kept])) for kept in halves]), missed_peaks(error)
        ),
        mesh_stiffness_N_per_mm_um=_larger(thinned_mean(tangent), JUMP * _pitch_bends(tangent)),
        secant_stiffness_N_per_mm_um=_larger(thinned_mean(secant), KINK * _pitch_bends(secant)),
        loss_percent=_larger(thinned_mean(loss), KINK * _pitch_bends(loss)),
    )


def every_other(count: int, first: int) -> Ints:
    """Numbers of every other position of a closed pitch of `count`, ascending, from the `first` on; of an odd count the
    last one is a neighbour of the first."""
    return np.sort((first + 2 * np.arange((count + 1) // 2)) % count)


def shares(kept: Ints, count: int) -> Floats:
    """What part (k,) of a closed pitch of `count` even steps belongs to each of the positions `kept` (k,), ascending:
    half the way between its two neighbours, as the trapezoidal rule has it."""
    gaps = np.diff(np.append(kept, kept[0] + count))
    return np.asarray((gaps + np.roll(gaps, 1)) / (2.0 * count))


def thinned_mean(values: Floats) -> float:
    """How far the mean of a periodic curve, even samples (n,), moves on average where every other one is left out: of
    an odd number it depends on which."""
    count = len(values)
    sets = [every_other(count, first) for first in range(count)]
    return _apart(float(np.mean(values)), [float(values[kept] @ shares(kept, count)) for kept in sets])


def missed_peaks(values: Floats) -> float:
    """By how much the peak-to-peak value of a continuous, periodic curve may exceed that of its even samples (n,)."""
    if len(values) < 5:
        return 0.0
    x, y = np.arange(len(values) + 5.0), np.concatenate([values[-2:], values, values[:3]])
    return float(sum(max(0.0, tops((x, own), jumps=False)[1:-1].max() - own.max()) for own in (y, -y)))


def reach(curve: Curve, jumps: bool) -> float:
    """The highest that a curve may be at its samples and between them, see `tops`; NaN are passed over."""
    return float(np.nanmax(np.append(tops(curve, jumps), curve[1])))


def tops(curve: Curve, jumps: bool) -> Floats:
    """The highest that a curve (n,) may be between each two of its samples, (n − 3,) without the first and the last
    two, if it goes on straight from both sides, see above, each line by no more than the step that it comes from; NaN
    where one is not known. jumps: whether it may jump between them."""
    x, y = curve
    if len(y) < 4:
        return np.zeros(0)
    step, slope = np.diff(x), np.diff(y) / np.diff(x)
    left, right = y[1:-2], y[2:-1]  # of each two samples, with one more on either side
    onward = left + slope[:-2] * np.minimum(step[1:-1], step[:-2])
    back = right - slope[2:] * np.minimum(step[1:-1], step[2:])
    below, above = back - left, onward - right  # how far the line from the left lies below the other one, then above
    ends = np.maximum(left, right)
    with np.errstate(divide="ignore", invalid="ignore"):
        meet = left + (onward - left) * below / (below + above)
    top = np.where((below > 0.0) & (above > 0.0), ends + (1.0 - SMOOTH * roundness(slope)) * (meet - ends), ends)
    if jumps:
        top = np.where(below * above < 0.0, 0.5 * (ends + np.fmax(ends, np.fmax(onward, back))), top)
    return top


def roundness(slope: Floats) -> Floats:
    """How much of a kink between each two samples of a curve, (n − 3,), its neighbours show to be an even bend, from 0
    to 1: twice the lesser bend at the samples before and after over those at both; 0 where there is none. slope:
    (n − 1,) between all samples."""
    bend = np.concatenate([[0.0], np.maximum(-np.diff(slope), 0.0), [0.0]])  # (n,) with those at the ends unknown
    own, beside = bend[1:-2] + bend[2:-1], 2.0 * np.fmin(bend[:-3], bend[3:])
    return np.where(own > 0.0, np.minimum(1.0, beside / np.where(own > 0.0, own, 1.0)), 0.0)


def bends(values: Floats) -> Floats:
    """By how much a step of a curve (n,) differs from the more even one of its neighbours, (n − 3,): little where it is
    smooth, a jump's height where it jumps."""
    step = np.diff(values)
    before, after = step[:-2], step[2:]
    return np.abs(step[1:-1] - np.where(np.abs(before) < np.abs(after), before, after))


def scatter(values: Floats) -> float:
    """Standard deviation of what a curve (n,) has at random from sample to sample: of its third differences, in which
    nothing is left of a parabola, and of those the median, for the sake of kinks; NaN are left out."""
    known = values[np.isfinite(values)]
    if len(known) < 8:
        return 0.0
    return float(np.median(np.abs(np.diff(known, 3)))) / DEVIATIONS / np.sqrt(20.0)


def _higher(run: RunData, curve: Engagement, kinks: Sequence[ReliefKink]) -> float:
    """By how much the largest pressure may exceed the one that was found: between positions, on kinks, and where the
    curve enters a tip-edge zone."""
    step = run.pitch / len(run.positions)
    ends = [end.pressure + step * _rise(curve, end) for end in curve.zone_ends]
    angle, pressure = curve.pressure_curve
    top = known_on_kinks(run.pair.pinion.base_radius * angle, tops((angle, pressure), jumps=True), kinks)
    largest = _largest(curve)
    return float(np.nanmax([largest, *top, *ends, *(kink.pressure for kink in kinks)])) - largest


def known_on_kinks(ξ: Floats, top: Floats, kinks: Sequence[ReliefKink]) -> Floats:
    """What may be reached between samples at the roll distances ξ (n,) [mm], (n − 3,) [MPa], no more than the pressure
    over a kink where the contact lies on it."""
    most = np.full(len(top), -np.inf)
    for kink in kinks:
        on = (ξ[1:-2] < kink.ξ + kink.way) & (ξ[2:-1] > kink.ξ - kink.way)
        most[on] = np.maximum(most[on], kink.pressure)
    return np.where(np.isfinite(most), np.minimum(top, most), top)


def _rise(curve: Engagement, end: TurnPeak) -> float:
    """The slope [MPa/rad], not negative, with which the curve goes into the end of a tip-edge zone: from the last
    position but one to the last, or to the end."""
    known = np.flatnonzero(np.isfinite(curve.max_pressure))
    last, *before = known[np.argsort(np.abs(curve.angle[known] - end.angle), kind="stable")[:2]]
    rise = [0.0]
    for one in before:
        for angle, pressure in ((end.angle, end.pressure), (curve.angle[last], curve.max_pressure[last])):
            rise.append((pressure - curve.max_pressure[one]) / abs(angle - curve.angle[one]))
    return float(max(rise))


def _mean_bends(curve: Engagement) -> float:
    """Of the mean pressure [MPa]: the engagement also begins and ends anywhere between two positions."""
    known = curve.mean_pressure[np.isfinite(curve.mean_pressure)]
    if len(known) < 4:
        return 0.0
    ends = known[[0, -1]] - np.mean(known)
    return float(np.hypot(JUMP * np.linalg.norm(bends(known)), np.linalg.norm(ends))) / len(known)


def _pitch_bends(values: Floats) -> float:
    """Of all steps of a pitch (n,), which are independent of each other, in their mean: one before the first and two
    after the last make the steps' neighbours."""
    return float(np.linalg.norm(bends(np.concatenate([values[-1:], values, values[:2]])))) / len(values)


def _values(run: RunData, index: int, value: OfPosition) -> Floats:
    return np.array([value(run, each[index]) for each in run.positions])


def _apart(whole: float, thinned: Sequence[float]) -> float:
    """How far these are from the first on average."""
    return float(np.mean([abs(each - whole) for each in thinned]))


def _larger(*estimates: float) -> float:
    """NaN where there is none."""
    return float(np.fmax.reduce(estimates))


def _largest(curve: Engagement) -> float:
    """NaN where there is none."""
    return curve.peak.pressure if np.isfinite(curve.max_pressure).any() else float("nan")


def _mean(values: Floats, weights: Floats | None = None) -> float:
    """Of those that are known; NaN where there is none."""
    known = np.isfinite(values)
    own = None if weights is None else weights[known]
    return float(np.average(values[known], weights=own)) if known.any() else float("nan")
