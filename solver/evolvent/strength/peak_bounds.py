"""How high a curve may be between its points, beside the largest of them.

Stress over the rotation has kinks where a neighbour takes over load or gives it up, and little curvature between them.
Between two points it is at most where the line through the two points before and that through the two behind cross; of
a concave curve this is a bound.

Under a light load a neighbour takes over within a small part of an interval: the stress rises slowly and then falls in
a jump, and the steep line says nothing of where. There the curve is at most as high as the gentle line reaches at the
far end of the interval.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats

INNER = 0.2
"""Least part of an interval between a place in it and its ends."""

STEEP = 4.0
"""Ratio of the slopes on both sides from which on the steeper one is that of a jump."""
ROUNDING = 1e-9
"""Of an interval: lines that cross at a point of the curve do so there, on whichever side rounding puts it."""


@dataclass(frozen=True)
class PossiblePeak:
    """Where a curve may be higher than at its points."""

    place: float
    """Between two points."""
    height: float
    """Which it may reach there."""
    width: float
    """Distance of the two points."""


def beside_largest(x: Floats, y: Floats) -> Iterator[PossiblePeak]:
    """Between the largest of the points (k,) and its neighbours, as far as two points lie on either side. x: ascending.
    """
    largest = int(np.argmax(y))
    for i in (largest - 1, largest):
        if 1 <= i < len(y) - 2:
            yield _crossing(x[i - 1 : i + 3], y[i - 1 : i + 3])


def _crossing(x: Floats, y: Floats) -> PossiblePeak:
    """Between the middle ones of four points. Where the lines do not cross there, or one of them is that of a jump: in
    the middle, as high as the line through the higher point reaches at the other one."""
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
