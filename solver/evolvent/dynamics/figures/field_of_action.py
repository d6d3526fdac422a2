"""Animation of a pair's transient contact: contact lines in the field of action with their pressure, and mesh force."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.dynamics.results.transient.cases import CasePressures
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import pooled_peaks
from evolvent.results.drawing.animations import frame, gif
from evolvent.results.drawing.style import ABOVE, FAINT, INK, PINION, PRESSURE_MAP, foot, sheet, styled
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

NO_ZONE = 1e-6
"""Tip-edge zones no longer than this [mm] are ignored."""


@dataclass(frozen=True)
class FieldOfAction:
    """Field of action at one speed and friction coefficient, over the last mesh period."""

    title: str
    """Title of the scene."""
    pair: GearPair
    """Geometry of the gear pair."""
    pressures: CasePressures
    """Fitted pressures at this speed and friction coefficient."""

    @cached_property
    def force(self) -> Floats:
        """(n,) mesh force over the load."""
        case = self.pressures.case
        return np.array([moment.mesh_force for moment in case.found.moments]) / case.load

    @cached_property
    def top(self) -> float:
        """End of the pressure scale [MPa]: the largest away from tip edges."""
        peaks = np.concatenate([pooled_peaks(cut) for cut in self.pressures.moving.cuts])
        return float(np.nanmax(peaks, initial=1.0))

    @cached_property
    def zones(self) -> list[tuple[float, float]]:
        """Tip-edge zones, from and to [mm] on the path of contact; none where tips are relieved."""
        (start, end), inner = self.pair.path_of_contact, self.pressures.moving.inner_path
        return [(low, high) for low, high in ((start, inner[0]), (inner[1], end)) if high - low > NO_ZONE]

    @cached_property
    def is_above(self) -> bool:
        """Whether a colour lies above the pressure scale, which only what is not fitted can."""
        return any(np.any(_shown(cut) > self.top) for cut in self.pressures.moving.cuts)

    def animation(self) -> bytes:
        """GIF of a mesh period; it repeats without a seam once the motion is steady."""
        with styled():
            return gif([frame(self.figure(k)) for k in range(len(self.force))])

    def figure(self, k: int) -> Figure:
        """Frame of the animation at position k."""
        case = self.pressures.case
        angle = np.degrees(case.results[k].stand.angle)
        subtitle = f"{case.name}; rotation of the pinion {angle:.2f}°"
        figure = sheet(f"{self.title}: contact with inertia", subtitle, (10.0, 4.8))
        field, force = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
        self._lines(field, self.pressures.moving.cuts[k])
        scale = ScalarMappable(Normalize(0.0, self.top), PRESSURE_MAP)
        extend = "max" if self.is_above else "neither"
        figure.colorbar(scale, ax=field, label="peak pressure [MPa]", extend=extend)
        self._force(force, k)
        grey, blue = ["tip-edge zones are grey"] * bool(self.zones), [ABOVE] * self.is_above
        foot(figure, "; ".join(["Left: field of action; contact lines move to the right", *grey, *blue]) + ".")
        return figure

    def _lines(self, axes: Axes, cut: Slices) -> None:
        """Draws slices at their roll distances, as wide as their layer."""
        start, end = self.pair.path_of_contact
        half = 0.5 * self.pair.face_width
        for low, high in self.zones:
            axes.axvspan(low, high, color=FAINT, alpha=0.25, lw=0.0)
        axes.axvline(0.0, color=FAINT, lw=0.8, ls="--")
        widths = cut.width if len(np.unique(cut.z)) > 1 else np.full(len(cut.z), 2.0 * half)
        slope = self.pair.pinion.hand * np.tan(self.pair.pinion.base_helix_angle)
        ends = [
            [(ξ - 0.5 * slope * w, z - 0.5 * w), (ξ + 0.5 * slope * w, z + 0.5 * w)]
            for ξ, z, w in zip(cut.roll_distance, cut.z, widths)
        ]
        lines = LineCollection(ends, array=_shown(cut), cmap=PRESSURE_MAP, norm=Normalize(0.0, self.top), lw=7.0)
        lines.set_capstyle("butt")
        axes.add_collection(lines)
        axes.set(xlim=(start, end), ylim=(-half, half), xlabel="path of contact from the pitch point [mm]",
                 ylabel="face [mm]")

    def _force(self, axes: Axes, k: int) -> None:
        """Draws the mesh force over the mesh period, with a dot at this position."""
        angle = np.degrees([result.stand.angle for result in self.pressures.case.results])
        axes.plot(angle, self.force, color=PINION)
        axes.plot(angle[k], self.force[k], "o", color=PINION, markersize=8.0)
        axes.axhline(1.0, color=INK, lw=0.8, ls="--")
        axes.set(xlabel="rotation of the pinion [°]", ylabel="mesh force over load")
        axes.set_ylim(min(0.0, float(self.force.min())), 1.1 * max(1.0, float(self.force.max())))


def _shown(cut: Slices) -> Floats:
    """Pressures (n,) by which slices are coloured [MPa]: fitted peaks, the largest ones where none could be fitted."""
    return np.where(np.isfinite(peaks := pooled_peaks(cut)), peaks, cut.largest)
