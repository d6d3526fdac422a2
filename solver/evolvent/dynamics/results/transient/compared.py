"""A curve of a case beside the same curve of both motions of its companion: what it is off by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.results.error_bars.compared import Compared, Curve, Reduction, relative_difference
from evolvent_meshes.arrays import Floats

FINER = 4
"""Time steps of the companion to one of the case: a power of two."""
STEP_FACTOR = FINER / (FINER - 1.0)
"""Error over the difference to steps of a quarter: first order."""


@dataclass(frozen=True, eq=False)
class ComparedMotion:
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
        """What the mesh and the modes change."""
        return Compared(self.own, self.same, self.factor)

    @property
    def _steps(self) -> Compared:
        """What the length of the time steps changes."""
        return Compared(self.same, self.finer, STEP_FACTOR)
