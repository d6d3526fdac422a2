"""Errors of a curve of a case, from the same curve of both motions of its companion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.results.error_bars.compared import Compared, Curve, Reduction, relative_difference
from evolvent_meshes.arrays import Floats

FINER = 4
"""Time steps of the companion in one time step of the case: a power of two."""
STEP_FACTOR = FINER / (FINER - 1.0)
"""Error of the time steps over the difference to steps of a quarter: first order."""


@dataclass(frozen=True, eq=False)
class ComparedMotion:
    """A curve over the rotation of the pinion or of a tooth, of a case and of both motions of its companion."""

    factor: float
    """Error by the mesh over the difference between case and companion in the same time steps."""
    own: Curve
    """Curve of the case (n,)."""
    same: Curve
    """Curve on elements of twice the size, in the same time steps."""
    finer: Curve
    """Curve on elements of twice the size, in shorter time steps."""

    def of_each(self) -> Floats:
        """Errors (n,) of the case's values. Where the companion has none, its steps count with the case's sizes."""
        beside = Compared(self.same.at(self.own.angle), self.finer, STEP_FACTOR).of_each()
        whole = STEP_FACTOR * self.own.sizes * relative_difference(self.same, self.finer)
        return self._mesh.of_each() + np.asarray(np.fmax(beside, whole))

    def of_figure(self, figure: Reduction) -> float:
        """Error of a figure of the curve."""
        return self._mesh.of_figure(figure) + self._steps.of_figure(figure)

    def of_varying(self, figure: Reduction) -> float:
        """Error of a figure that does not depend on the mean of the curve."""
        return self._mesh.of_varying(figure) + self._steps.of_varying(figure)

    @property
    def _mesh(self) -> Compared:
        """Comparison for the error by the mesh and the modes."""
        return Compared(self.own, self.same, self.factor)

    @property
    def _steps(self) -> Compared:
        """Comparison for the error by the length of the time steps."""
        return Compared(self.same, self.finer, STEP_FACTOR)
