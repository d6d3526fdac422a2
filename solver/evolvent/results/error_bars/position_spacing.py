"""Errors of the figures due to the spacing of positions: the part of the error bars that needs no second mesh.

Curves over the pitch are smooth except for kinks and jumps, where a tooth enters or leaves contact or a relief begins.
One estimate is by thinning: a figure computed from every other position has a larger error than that from all, and the
difference of the two estimates the error. With an odd number of positions two neighbours are kept, and means weight
each position with its share of the periodic pitch. Thinning misses features between two positions. The error is the
larger of this estimate and of one of the following:

- For an extreme: how far the curve may exceed its samples between two positions, see `peak_bounds.tops`. All intervals
  are examined, since a peak may be narrower than one.
- For a mean: the effect of a kink or jump at an unknown place between two positions. A jump by J changes the mean of n
  values by at most J/2n. A kink that changes the step from one position to the next by J changes it by J/12n on
  average, and the step in which it lies shows about half of J. The contributions of different intervals are
  independent.

Two effects are added for the largest pressure. The curve of an engagement ends at the limits of the tip-edge zones:
where it rises towards a limit, it may rise by one step's growth more. Where the contact of a spur pair covers the start
of a linear relief the curve has a gap (`gears.pressure.relief_starts`), with limits that are interpolated.
Fitted peaks scatter with the place of the contact in the cells: two standard deviations are allowed for the largest of
many values exceeding the largest of few.

With friction, the history of a position depends on the spacing too. None of these estimates holds that error: for a
helical pair at μ = 0.2 and 20 positions it is 0.1 % of the secant stiffness.

evidence/benchmarks/accuracy/spacing.py compares these estimates with runs of many positions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace

import numpy as np

from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.engagement import Engagement, EngagementPeak, engagement
from evolvent.results.error_bars.peak_bounds import tops
from evolvent.results.face_load import FaceLoad, face_load
from evolvent.results.position_figures import loss_percent, mesh_stiffness, secant_stiffness, transmission_error_um
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent_meshes.arrays import Floats, Ints

JUMP, KINK = 0.5, 1.0 / 6.0
"""Error of a step's mean over the bend of the step, for a jump and for a kink at an unknown place in it."""
SCATTERS = 2.0
"""Allowance for the largest of a hundred scattered pressures exceeding the largest of ten, in standard deviations."""
DEVIATIONS = 0.6745
"""Median of the absolute value of a normally distributed quantity, in standard deviations."""

PositionFigure = Callable[[RunData, SolvedPosition], float]
"""A figure of one position, see `position_figures`."""


def spacing_errors(run: RunData, index: int) -> FigureErrors:
    """Errors of the figures at the friction coefficient with this index; NaN for a run with a single position."""
    run = replace(run, positions=run.positions[: run.scene.sweep.positions])  # one pitch only
    if len(run.positions) < 2:
        return FigureErrors(*[float("nan")] * len(fields(FigureErrors)))
    count = len(run.positions)
    whole, halves = engagement(run, index), [every_other(count, first) for first in (0, 1)]
    thin = [engagement(replace(run, positions=tuple(run.positions[k] for k in kept)), index) for kept in halves]
    error, tangent, secant, loss = (
        _values(run, index, value) for value in (transmission_error_um, mesh_stiffness, secant_stiffness, loss_percent)
    )
    largest = _apart(whole.peak.pressure, [curve.peak.pressure for curve in thin])
    mean = [_mean(curve.mean_pressure, shares(kept, count)[curve.position]) for curve, kept in zip(thin, halves)]
    scattered, excess = SCATTERS * scatter(whole.max_pressure), _excess(run, whole)
    return FigureErrors(
        max_pressure_MPa=_larger(largest, excess, scattered),
        mean_pressure_MPa=_larger(_apart(whole.whole_mean, mean), _mean_bends(whole)),
        transmission_error_peak_to_peak_um=_larger(
            _apart(float(np.ptp(error)), [float(np.ptp(error[kept])) for kept in halves]), missed_peaks(error)
        ),
        mesh_stiffness_N_per_mm_um=_larger(thinned_mean(tangent), JUMP * pitch_bends(tangent)),
        secant_stiffness_N_per_mm_um=_larger(thinned_mean(secant), KINK * pitch_bends(secant)),
        loss_percent=_larger(thinned_mean(loss), KINK * pitch_bends(loss)),
        face_load_factor=_of_face(face_load(run, index)),
    )


def every_other(count: int, first: int) -> Ints:
    """Indices of every other position of a periodic pitch, ascending, from `first` on. count: number of positions; if
    it is odd, the last position kept is a neighbour of the first."""
    return np.sort((first + 2 * np.arange((count + 1) // 2)) % count)


def shares(kept: Ints, count: int) -> Floats:
    """Weights (k,) of the trapezoidal rule over a periodic pitch of `count` even steps, for the positions `kept` (k,),
    ascending."""
    gaps = np.diff(np.append(kept, kept[0] + count))
    return np.asarray((gaps + np.roll(gaps, 1)) / (2.0 * count))


def thinned_mean(values: Floats) -> float:
    """Change of the mean of a periodic curve with even samples (n,) if every other sample is left out, averaged over
    all choices of the first."""
    count = len(values)
    sets = [every_other(count, first) for first in range(count)]
    return _apart(float(np.mean(values)), [float(values[kept] @ shares(kept, count)) for kept in sets])


def _of_face(face: FaceLoad) -> float:
    """Error of the face load factor due to the spacing of positions. With few positions the mean load of a helical pair
    ripples along the face; its largest value hardly depends on their number, so that thinning compares all of the
    curve, as between meshes."""
    count, load, whole = len(face.mean), face.relative(), face.factor()
    apart = []
    for kept in (every_other(count, first) for first in range(count)):
        thinned = face.relative(kept, shares(kept, count))
        ripple = float(np.linalg.norm(thinned - load) / np.linalg.norm(load))
        apart.append(max(abs(float(thinned.max()) - whole), whole * ripple))
    excess = (face.load[:, int(np.argmax(load))] - whole * face.mean) / np.mean(face.mean)
    return _larger(float(np.mean(apart)), KINK * pitch_bends(excess))


def missed_peaks(values: Floats) -> float:
    """Possible excess of the peak-to-peak value of a continuous periodic curve over that of its even samples (n,)."""
    if len(values) < 5:
        return 0.0
    x, y = np.arange(len(values) + 5.0), np.concatenate([values[-2:], values, values[:3]])
    return float(sum(max(0.0, tops((x, each), jumps=False)[1:-1].max() - each.max()) for each in (y, -y)))


def bends(values: Floats) -> Floats:
    """Difference (n − 3,) of each step of a curve (n,) from the smaller of its two neighbouring steps: small where the
    curve is smooth, the height of a jump where it jumps."""
    step = np.diff(values)
    before, after = step[:-2], step[2:]
    return np.abs(step[1:-1] - np.where(np.abs(before) < np.abs(after), before, after))


def scatter(values: Floats) -> float:
    """Standard deviation of the random scatter of a curve (n,); NaN are skipped, 0 for fewer than eight values.

    It is estimated from third differences, which vanish for a parabola, by their median, which is robust to kinks.
    """
    known = values[np.isfinite(values)]
    if len(known) < 8:
        return 0.0
    return float(np.median(np.abs(np.diff(known, 3)))) / DEVIATIONS / np.sqrt(20.0)


def _excess(run: RunData, curve: Engagement) -> float:
    """Possible excess of the largest pressure [MPa] over the computed one: between positions, and at the limits of
    tip-edge zones."""
    step = run.pitch / len(run.positions)
    ends = [end.pressure + step * _rise(curve, end) for end in curve.zone_ends if end.at_zone_end]
    largest = curve.peak.pressure
    return float(np.nanmax([largest, *tops(curve.pressure_curve, jumps=True), *ends])) - largest


def _rise(curve: Engagement, end: EngagementPeak) -> float:
    """Slope (≥ 0) [MPa/rad] of the curve towards a limit of a tip-edge zone, from the last position but one to the last
    or to the limit. end: the peak at the limit."""
    known = np.flatnonzero(np.isfinite(curve.max_pressure))
    last, *before = known[np.argsort(np.abs(curve.angle[known] - end.angle), kind="stable")[:2]]
    rise = [0.0]
    for one in before:
        for angle, pressure in ((end.angle, end.pressure), (curve.angle[last], curve.max_pressure[last])):
            rise.append((pressure - curve.max_pressure[one]) / abs(angle - curve.angle[one]))
    return float(max(rise))


def _mean_bends(curve: Engagement) -> float:
    """Error of the mean pressure [MPa] due to jumps; the engagement also begins and ends at unknown places between two
    positions."""
    known = curve.mean_pressure[np.isfinite(curve.mean_pressure)]
    if len(known) < 4:
        return 0.0
    ends = known[[0, -1]] - np.mean(known)
    return float(np.hypot(JUMP * np.linalg.norm(bends(known)), np.linalg.norm(ends))) / len(known)


def pitch_bends(values: Floats) -> float:
    """Root sum of squares of the bends of a periodic curve with even samples (n,), over n: their effect on the mean,
    independent of each other."""
    return float(np.linalg.norm(bends(np.concatenate([values[-1:], values, values[:2]])))) / len(values)


def _values(run: RunData, index: int, value: PositionFigure) -> Floats:
    """A figure at all positions, (positions,)."""
    return np.array([value(run, each[index]) for each in run.positions])


def _apart(whole: float, thinned: Sequence[float]) -> float:
    """Mean absolute difference of thinned values from the value of all positions."""
    return float(np.mean([abs(each - whole) for each in thinned]))


def _larger(*estimates: float) -> float:
    """The largest estimate that is known; NaN where none is."""
    return float(np.fmax.reduce(estimates))


def _mean(values: Floats, weights: Floats) -> float:
    """Weighted mean of the known values; NaN where none is known."""
    known = np.isfinite(values)
    return float(np.average(values[known], weights=weights[known])) if known.any() else float("nan")
