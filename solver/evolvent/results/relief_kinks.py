"""Pressure where a linear tip or root relief begins, a kink of the flank at which it exceeds Hertz' pressure.

The whole contact line of a spur pair passes the kink at once, possibly between two positions. The largest fitted peak
(`contact_slices.fitted_peak`) during that passage is known in closed form. It occurs with the kink in the middle of the
contact: the gap is then x²/2R + α|x|, 2α the angle of the kink, as between a cylinder and a blunt wedge. Their
pressures on the same half-width a add up:

    F' = π E* a²/4R + E* α a                                    K. L. Johnson, *Contact Mechanics* (1985), 4.43 and 5.44
    M_2 = a²/4 of the first part + a²/6 of the second            from p = p0 √(1 − x²/a²) and (E* α/π) arcosh(a/|x|)

The half-ellipse with this load and second moment is κ times as high as Hertz' p0, where κ depends on
k = 4αR/πb = 2αE*/πp0 alone. The pressure itself is unbounded at an ideal kink; how far it rises depends on the radius
with which the kink is manufactured.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

from evolvent.fem.material import contact_modulus
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import hertz_between
from evolvent.gears.pressure.relief_starts import relief_starts
from evolvent.results.run_data import RunData
from evolvent.scene.plain_text import signed

AWAY = "away from relief starts"
"""Which largest pressure is meant where the contact of a spur pair passes kinks."""


@dataclass(frozen=True)
class ReliefKink:
    """Contact pressure where a linear tip or root relief begins."""

    relief: str
    """Kind of the relief: tip or root."""
    roll_distance: float
    """Roll distance ξ of the kink from the pitch point [mm]."""
    hertz: float
    """Hertz' peak pressure for the line load at the kink, the largest of all heights [MPa]."""
    pressure: float
    """Largest fitted peak pressure while the contact passes the kink [MPa]."""


def wedge_factor(k: float) -> float:
    """Ratio κ ≥ 1 of the fitted peak pressure, with a kink in the middle of a line contact, to Hertz' peak pressure for
    the same load. k: 2αE*/πp0."""
    a = sqrt(1.0 + 0.25 * k**2) - 0.5 * k  # half-width over Hertz': a² + ka = 1
    return 1.0 / (a * sqrt(1.0 - a * k / 3.0))


def relief_kinks(run: RunData, index: int) -> list[ReliefKink]:
    """The kinks of a spur pair between its tip-edge zones, at the friction coefficient with this index. Empty for a
    helical pair, whose contact line crosses the kink at every position."""
    modulus = contact_modulus(*run.scene.materials())
    cut = Slices.joined([each[index].cut for each in run.positions])
    kinks = []
    for start in relief_starts(run.pair):
        p0 = hertz_between(start.roll_distance, run.pair, cut)
        if run.inner_path[0] < start.roll_distance < run.inner_path[1] and p0 > 0.0:
            pressure = p0 * wedge_factor(start.angle * modulus / (pi * p0))
            kinks.append(ReliefKink(start.relief, start.roll_distance, p0, pressure))
    return kinks


def largest_kink(run: RunData, index: int) -> ReliefKink | None:
    """The kink with the largest pressure, at the friction coefficient with this index; None where there is no kink."""
    return max(relief_kinks(run, index), key=lambda kink: kink.pressure, default=None)


def kink_notes(run: RunData, index: int) -> list[str]:
    """Footnote of a picture of pressures at the friction coefficient with this index: the pressure over the start of a
    linear relief, and what computed ones there are worth; none where there is no such start."""
    kink = largest_kink(run, index)
    if kink is None:
        return []
    drawn = not run.is_line and any(tooth.kink_pressure > 0.0 for each in run.positions for tooth in each[index].teeth)
    return [
        f"The largest pressure is that away from the starts of linear reliefs: where {kink.relief} begins, ξ = "
        f"{signed(kink.roll_distance, 2)} mm, a sharp kink has about {kink.pressure:.0f} MPa (closed form).",
        *(["Crosses, over these starts, scatter with the mesh, which rounds the kinks."] if drawn else []),
    ]
