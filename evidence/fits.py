"""What several measurements fit to a pressure, and how they compare it with an exact one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats

INNER = 0.7
"""Share of the half-width of contact that is fitted: single points scatter more, most at the edge."""


@dataclass(frozen=True)
class HalfEllipse:
    """p² = top + slope x²: Hertz' pressure over the distance from the middle."""

    top: float
    """[MPa²]."""
    slope: float
    """[MPa²/mm²]."""

    @property
    def peak(self) -> float:
        """p0 [MPa]."""
        return float(np.sqrt(max(0.0, self.top)))

    @property
    def half_width(self) -> float:
        """[mm]."""
        return float(np.sqrt(-self.top / self.slope))


def half_ellipse(x: Floats, pressure: Floats, half_width: float) -> HalfEllipse:
    """The best fit to pressures (n,) [MPa] at distances x (n,) [mm] within INNER of a half-width of contact."""
    inner = np.abs(x) < INNER * half_width
    slope, top = np.polyfit(x[inner] ** 2, pressure[inner] * np.abs(pressure[inner]), 1)
    return HalfEllipse(float(top), float(slope))


def relative_l2(weights: Floats, computed: Floats, exact: Floats) -> float:
    """Relative L2 error of a field (n, ...) at points with quadrature weights (n,)."""
    off, whole = (np.square(field).reshape(len(weights), -1).sum(axis=1) for field in (computed - exact, exact))
    return float(np.sqrt(weights @ off / (weights @ whole)))


def order_of(counts: Sequence[int], errors: Floats) -> float:
    """Order of convergence: slope of the logarithm of errors (n,) over that of numbers of steps or cells (n,)."""
    return float(-np.polyfit(np.log(counts), np.log(errors), 1)[0])
