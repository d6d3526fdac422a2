"""How high a curve may be between its samples, from the straight lines through two samples on either side.

`tops` estimates it in every interval, for the error bars of a run. Where the two lines intersect there is a kink, or a
smooth top a quarter as high; the curve counts as smooth in proportion to its bends at the neighbouring samples. Where
the lines do not intersect the curve jumps, as pressures nearly do, on average in the middle.

`peak_bounds` bounds it beside the largest sample, where further positions are solved until nothing is left. Root
stress over the rotation has kinks where a neighbour takes over load or gives it up, and little curvature between them:
it is at most where both lines cross, which of a concave curve is a bound. Under a light load a neighbour takes over
within a small part of an interval: the stress rises slowly and then falls in a jump, and the steep line says nothing of
where. There the curve is at most as high as the gentle line reaches at the far end of the interval.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats

SMOOTH = 0.75
"""Part of the height of the intersection of two lines above the samples by which a parabola with these slopes stays
below it."""
INNER = 0.2
"""Smallest distance of a peak from the ends of its interval, over the interval."""
STEEP = 4.0
"""Ratio of the slopes on both sides from which on the steeper one is that of a jump."""
ROUNDING = 1e-9
"""Tolerance of an intersection over the length of the interval: lines that intersect at a point of the curve count as
doing so inside, on whichever side rounding puts it."""
Samples = tuple[Floats, Floats]
"""Places (n,), ascending, and values (n,) of a sampled curve."""


@dataclass(frozen=True)
class PossiblePeak:
    """A peak that a curve may have between two of its points."""

    angle: float
    """Abscissa of the peak, between two points."""
    height: float
    """Largest value that the curve may have there."""
    width: float
    """Distance of the two points."""


def tops(curve: Samples, jumps: bool) -> Floats:
    """Largest value (n − 3,) that a curve (n,) may have between two samples, for each interval but the first and last.

    The curve is extrapolated linearly from both sides, by no more than the length of the step that gives the slope.
    NaN where a sample is unknown. jumps: whether the curve may jump between samples.
    """
    x, y = curve
    if len(y) < 4:
        return np.zeros(0)
    step, slope = np.diff(x), np.diff(y) / np.diff(x)
    left, right = y[1:-2], y[2:-1]  # samples at both ends of each interval
    onward = left + slope[:-2] * np.minimum(step[1:-1], step[:-2])
    back = right - slope[2:] * np.minimum(step[1:-1], step[2:])
    below, above = back - left, onward - right  # the line from the left relative to that from the right, at both ends
    ends = np.maximum(left, right)
    with np.errstate(divide="ignore", invalid="ignore"):
        meet = left + (onward - left) * below / (below + above)
    top = np.where((below > 0.0) & (above > 0.0), ends + (1.0 - SMOOTH * roundness(slope)) * (meet - ends), ends)
    if jumps:
        top = np.where(below * above < 0.0, 0.5 * (ends + np.fmax(ends, np.fmax(onward, back))), top)
    return top


def roundness(slope: Floats) -> Floats:
    """Degree (n − 3,), from 0 for a kink to 1 for a smooth bend, to which a curve bends evenly around each interval.

    It is twice the smaller bend at the samples before and after the interval, over the sum of the bends at its ends; 0
    where these are zero. slope: (n − 1,), slopes between all samples.
    """
    bend = np.concatenate([[0.0], np.maximum(-np.diff(slope), 0.0), [0.0]])  # (n,), 0 at the ends, where it is unknown
    within, beside = bend[1:-2] + bend[2:-1], 2.0 * np.fmin(bend[:-3], bend[3:])
    return np.where(within > 0.0, np.minimum(1.0, beside / np.where(within > 0.0, within, 1.0)), 0.0)


def peak_bounds(x: Floats, y: Floats) -> Iterator[PossiblePeak]:
    """Possible peaks between the largest of the points (k,) and its neighbours, as far as two points lie on either
    side. x: ascending."""
    largest = int(np.argmax(y))
    for i in (largest - 1, largest):
        if 1 <= i < len(y) - 2:
            yield _crossing(x[i - 1 : i + 3], y[i - 1 : i + 3])


def _crossing(x: Floats, y: Floats) -> PossiblePeak:
    """Possible peak between the middle ones of four points, at the intersection of the lines through the outer pairs.
    Where the lines do not intersect there, or one of them is that of a jump: in the middle, as high as the line through
    the higher point reaches at the other one."""
    left, right, width = (y[1] - y[0]) / (x[1] - x[0]), (y[3] - y[2]) / (x[3] - x[2]), float(x[2] - x[1])
    part = ((y[2] - y[1]) / width - right) / (left - right) if left > right else np.inf
    crosses = -ROUNDING <= part <= 1.0 + ROUNDING
    gentle, steep = (left, -right) if y[1] > y[2] else (-right, left)  # rises into the interval
    if crosses and steep <= STEEP * gentle:
        inner = min(max(part, INNER), 1.0 - INNER)
        return PossiblePeak(float(x[1] + inner * width), float(y[1] + left * part * width), width)
    missed = abs(abs(y[2] - y[1]) - steep * width)  # by the line through the lower point: at a kink it meets the other
    rise = min(max(gentle, 0.0) * width, missed)
    return PossiblePeak(float(x[1] + 0.5 * width), float(max(y[1], y[2]) + rise), width)
