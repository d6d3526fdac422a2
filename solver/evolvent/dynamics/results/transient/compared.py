"""A curve of a case beside the same curve of its companion: what it is off by."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from evolvent.results.error_bars.estimation import Curve, Reduction, difference, relative_difference
from evolvent_meshes.arrays import Floats

FINER = 4
"""Time steps of the companion to one of the case: a power of two."""
STEP_FACTOR = FINER / (FINER - 1.0)
"""Error over the difference to steps of a quarter: first order."""
DIGITS = 9
"""Of a rotation [rad] that two curves have in common."""


@dataclass(frozen=True, eq=False)
class Compared:
    """A curve over the rotation of the pinion or of a tooth."""

    factor: float
    """Error by the mesh over the difference of the first two."""
    own: Curve
    """Of the case (n,)."""
    same: Curve
    """On elements of twice the size in the same time steps."""
    finer: Curve
    """There in shorter ones."""

    def of_each(self) -> Floats:
        """Errors (n,) of the case's values."""
        steps = each_apart(at(self.same, self.own.angle), self.finer)
        whole = _sizes(self.own) * relative_difference(self.same, self.finer)
        return self.factor * each_apart(self.own, self.same) + STEP_FACTOR * np.fmax(steps, whole)

    def of_figure(self, figure: Reduction) -> float:
        """Error of a figure of the curve."""
        mesh, steps = difference(figure, self.own, self.same), difference(figure, self.same, self.finer)
        return self.factor * mesh + STEP_FACTOR * steps

    def of_varying(self, figure: Reduction) -> float:
        """The same of a figure that does not depend on the mean of the curve."""
        without = [Curve(each.angle, each.values - np.mean(each.values)) for each in (self.own, self.same, self.finer)]
        return Compared(self.factor, *without).of_figure(figure)


def each_apart(one: Curve, other: Curve) -> Floats:
    """Difference D of each value of a curve (n,), see `results.error_bars.estimation`; where the other one has no
    value, by the root mean square of the whole curves. A force that vanishes as teeth part is not known better than
    others: it counts with the root mean square of all."""
    beside = np.abs(one.values - at(other, one.angle).values)
    return np.asarray(np.fmax(beside, _sizes(one) * relative_difference(one, other)))


def at(curve: Curve, angle: Floats, missing: float = np.nan) -> Curve:
    """Its values at rotations (n,) [rad]. missing: where it has none."""
    known = by_rotation(curve, curve.values)
    return Curve(angle, np.array([known.get(key, missing) for key in keys(angle)]))


def by_rotation(curve: Curve, values: Floats) -> dict[float, float]:
    """Rotation [rad] -> value, of values (n,) at the places of a curve."""
    return dict(zip(keys(curve.angle), values.tolist()))


def keys(angle: Floats | Iterable[float]) -> list[float]:
    """Rotations [rad] as in `by_rotation`."""
    rounded: list[float] = (np.round(np.asarray(angle, dtype=float), DIGITS) + 0.0).tolist()  # no -0.0
    return rounded


def _sizes(curve: Curve) -> Floats:
    """Of the values (n,) of a curve, at least their root mean square; NaN where they are not known."""
    known = curve.values[np.isfinite(curve.values)]
    whole = float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")
    return np.asarray(np.maximum(np.abs(curve.values), whole))
