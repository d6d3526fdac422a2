"""Errors of a curve and of its figures, estimated from the same curve on elements of twice the size.

Figures on two meshes may agree by chance where their curves do not. The difference D of a figure is therefore the
larger of |Q_1 − Q_2| and of |Q_1| times the relative root mean square difference of the curves. Its error is a factor
times D: 1/(2^p − 1) with the convergence rate p, Richardson's estimate. Other pairs of curves, in other time steps or
by Hertz, have factors of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from evolvent_meshes.arrays import Floats

Reduction = Callable[[Floats], float]
"""Function from the values (n,) of a curve to a figure."""

STIFFNESS: Mapping[int, float] = {1: 2.0, 2: 0.5}
"""Order of the cells -> 1/(2^p − 1) for deflections: transmission error and stiffness; p = 0.6 and 1.6."""
SHARING: Mapping[int, float] = {1: 2.0, 2: 1.0}
"""Order of the cells -> 1/(2^p − 1) for results that depend on load sharing between teeth and slices and on when teeth
come into contact: loads, pressures by them, loss, mesh force, peak-to-peak values and harmonics; p = 0.6 and 1. With 1
at order 1, 3 of 24 bars of pressures were too small, by 2 %; with 0.5 at order 2, a quarter of those of He's pair that
vary over the pitch."""
ROOT_STRESS: Mapping[int, float] = {1: 2.0, 2: 1.0 / 3.0}
"""Order of the cells -> 1/(2^p − 1) for stress at roots of twelve elements around a fillet and more; p = 0.6 and 2. How
many bars hold: docs/strength.md."""
DIGITS = 9
"""Decimals of a rotation [rad] that count as the same point of two curves."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve from which figures are computed."""

    angle: Floats
    """(n,) rotation of the pinion or of a tooth [rad]."""
    values: Floats
    """(n,) values in the figure's unit; NaN where unknown."""

    @property
    def sizes(self) -> Floats:
        """(n,) amounts of the values, at least their root mean square; NaN where no value is known."""
        known = self.values[np.isfinite(self.values)]
        whole = float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")
        return np.asarray(np.maximum(np.abs(self.values), whole))

    @property
    def varying(self) -> Curve:
        """The curve without its mean."""
        return replace(self, values=self.values - np.mean(self.values))

    def at(self, angle: Floats, missing: float = np.nan) -> Curve:
        """The curve at rotations (m,) [rad]. missing: value at rotations where the curve has none."""
        known = by_rotation(self, self.values)
        return Curve(angle, np.array([known.get(key, missing) for key in keys(angle)]))


@dataclass(frozen=True, eq=False)
class Compared:
    """A curve beside the same curve of another solution."""

    own: Curve
    """Curve (n,) whose errors are wanted."""
    other: Curve
    """Curve of the other solution, at some of these rotations."""
    factor: float = 1.0
    """Error over the difference D."""

    def of_figure(self, figure: Reduction) -> float:
        """Error of a figure of the curve; NaN where no rotation is common to both."""
        return self.of_value(float(figure(self.own.values)), float(figure(self.other.values)))

    def of_varying(self, figure: Reduction) -> float:
        """Error of a figure that does not depend on the mean of the curve."""
        return replace(self, own=self.own.varying, other=self.other.varying).of_figure(figure)

    def of_value(self, own: float, other: float) -> float:
        """Error of a value that both solutions have of these curves."""
        return self.factor * max(abs(own - other), abs(own) * relative_difference(self.own, self.other))

    def of_each(self, sizes: Floats | None = None) -> Floats:
        """Errors (n,) of the values; where the other curve has none, by the root mean square of the whole curves.

        sizes: (n,) what the relative difference of the curves is multiplied by; None: `Curve.sizes`, because a force
        that vanishes as teeth part is not known better than others.
        """
        beside = np.abs(self.own.values - self.other.at(self.own.angle).values)
        whole = (self.own.sizes if sizes is None else sizes) * relative_difference(self.own, self.other)
        return np.asarray(self.factor * np.fmax(beside, whole))


def relative_difference(first: Curve, second: Curve) -> float:
    """Root mean square difference of two curves over that of the first, at their common rotations; NaN without any."""
    _, i, j = np.intersect1d(np.round(first.angle, DIGITS), np.round(second.angle, DIGITS), return_indices=True)
    one, other = first.values[i], second.values[j]
    known = np.isfinite(one) & np.isfinite(other)
    if not known.any():
        return float("nan")
    size = np.linalg.norm(one[known])
    return float(np.linalg.norm(one[known] - other[known]) / size) if size > 0.0 else 0.0


def by_rotation(curve: Curve, values: Floats) -> dict[float, float]:
    """Rotation [rad] -> value, of values (n,) at the places of a curve."""
    return dict(zip(keys(curve.angle), values.tolist()))


def keys(angle: Floats | Iterable[float]) -> list[float]:
    """Rotations [rad], rounded as the keys of `by_rotation`."""
    rounded: list[float] = (np.round(np.asarray(angle, dtype=float), DIGITS) + 0.0).tolist()  # no -0.0
    return rounded
