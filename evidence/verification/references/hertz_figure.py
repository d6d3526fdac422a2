"""The figure of a Hertz contact: its pressure, and the stresses below its middle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.verification.references.subsurface import AxisStress, mises, shear
from evolvent.results.drawing.style import FAINT, INK, TEETH, WHEEL, dot_size
from evolvent_meshes.arrays import Floats

MEASURES = (("von Mises", mises, TEETH[1]), ("largest shear", shear, TEETH[2]))
FARTHEST, DEEPEST = 1.4, 2.0  # half-widths


@dataclass(frozen=True)
class HertzFigure:
    """Computed pressure and stresses of a Hertz contact beside the closed forms.

    place:    (q,), places of the points, in half-widths.
    pressure: (q,), over p0.
    bodies:   stresses of both bodies.
    exact:    stresses of the closed form.
    width:    half-width, by which lengths are divided [mm].
    peak:     p0, by which stresses are divided [MPa].
    across:   name of the axis of places.
    """

    place: Floats
    pressure: Floats
    bodies: tuple[AxisStress, ...]
    exact: AxisStress
    width: float
    peak: float
    across: str

    def draw(self, figure: Figure) -> None:
        """Both panels."""
        left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
        self._pressure(left)
        self._below(right)

    def _pressure(self, axes: Axes) -> None:
        first = -FARTHEST if self.place.min() < -0.5 else 0.0
        x = np.linspace(first, FARTHEST, 1201)
        exact = np.sqrt(np.maximum(0.0, 1 - x**2))
        axes.fill_between(x, exact, color="#e3e6ea")
        axes.plot(x, exact, color=FAINT, lw=1.0, label="Hertz")
        shown = np.abs(self.place) < FARTHEST
        axes.plot(
            self.place[shown], self.pressure[shown], ".", color=WHEEL, ms=dot_size(shown.sum()) - 1, label="found"
        )
        axes.set(xlabel=self.across, ylabel="contact pressure / $p_0$", xlim=(first, FARTHEST), ylim=(0.0, None))
        axes.legend(loc="upper right", markerscale=2)

    def _below(self, axes: Axes) -> None:
        names = ("o", "s")
        for label, measure, colour in MEASURES:
            axes.plot(measure(self.exact.stress) / self.peak, self.exact.depth / self.width, color=colour, label=label)
            for marker, body in zip(names, self.bodies):
                near = body.depth < DEEPEST * self.width
                value = measure(body.stress[near]) / self.peak
                axes.plot(value, body.depth[near] / self.width, marker, color=colour, ms=4, mfc="none")
        for marker, body_name in zip(names, ("found, upper body", "found, block")):
            axes.plot([], [], marker, color=INK, mfc="none", ms=4, label=body_name)
        axes.axhline(0.0, color=FAINT, lw=0.8)
        axes.set(xlabel="stress / $p_0$", ylabel="depth / half-width", xlim=(0.0, 0.85), ylim=(DEEPEST, 0.0))
        axes.legend(loc="lower right")
