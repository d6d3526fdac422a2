"""Picture of a pair's transient contact: transmission error and contact pressure of a tooth, beside statics."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.results.transient.facts import TransientFacts
from evolvent.dynamics.results.transient.rows import TransientRow, TransientToothRow
from evolvent.results.drawing.style import FAINT, INK, foot, friction_colours, note, png, sheet, styled
from evolvent_meshes.arrays import Floats

Colour = tuple[float, ...]
LONG = 5
"""Entries of a legend in one column, at most one less."""
BAND, BANDS = 0.15, 2
"""Opacity of error bars, and friction coefficients up to which they are drawn: more bands hide each other."""
ROOM = 0.18
"""Above the curves, of the height of a panel."""
STATIC = {"ls": "--", "lw": 1.0}
SUBTITLE = "The last mesh period, repeated. Solid: with inertia. Dashed: without, at the same positions."


def transient_picture(
    title: str, rows: Sequence[TransientRow], teeth: Sequence[TransientToothRow], facts: Sequence[TransientFacts]
) -> bytes:
    """PNG of `transient_figure`."""
    with styled():
        return png(transient_figure(title, rows, teeth, facts))


def transient_figure(
    title: str, rows: Sequence[TransientRow], teeth: Sequence[TransientToothRow], facts: Sequence[TransientFacts]
) -> Figure:
    """A line of panels for each speed: transmission error over a pitch, pressure of a tooth over its engagement."""
    speeds = sorted({fact.speed_rpm for fact in facts})
    figure = sheet(f"{title}: contact with inertia", SUBTITLE, (11.0, 1.4 + 3.0 * len(speeds)))
    grid = figure.subplots(len(speeds), 2, squeeze=False, width_ratios=(1.0, 1.3))
    frictions = sorted({fact.friction for fact in facts})
    banded = len(frictions) <= BANDS and any(np.isfinite(row.transmission_error_um_error) for row in rows)
    for (errors, pressures), speed in zip(grid, speeds):
        for friction, colour in zip(frictions, friction_colours(frictions)):
            _errors(errors, [row for row in rows if (row.speed_rpm, row.friction) == (speed, friction)], colour, banded)
            own = [row for row in teeth if (row.speed_rpm, row.friction) == (speed, friction)]
            _pressures(pressures, own, colour, friction, banded)
        errors.set_ylabel("transmission error [µm]")
        pressures.set_ylabel("peak pressure [MPa]")
        for axes in (errors, pressures):
            note(axes, f"{speed:g} r/min")
    for axes in grid.flat:  # room for notes and legend
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + ROOM * (high - low))
    grid[0][1].legend(loc="upper right", ncols=1 if len(frictions) < LONG else 2)
    grid[-1][0].set_xlabel("rotation of the pinion [°]")
    grid[-1][1].set_xlabel("rotation of the pinion since the tooth met at the pitch point [°]")
    unsteady = [fact for fact in facts if not fact.steady]
    foot(
        figure,
        "Pressure: largest of the fitted half-ellipses along the contact line, between the tip-edge zones."
        + (" Bands: error bars." if banded else "")
        + (f" Not steady yet: {len(unsteady)} of {len(facts)} motions." if unsteady else ""),
    )
    return figure


def _errors(axes: Axes, rows: Sequence[TransientRow], colour: Colour, banded: bool) -> None:
    """Over two pitches."""
    angle = np.array([row.pinion_angle_deg for row in rows])
    pitch = len(angle) * float(np.diff(angle).mean())
    over = np.concatenate([angle, angle + pitch])
    bars = [(row.transmission_error_um, row.transmission_error_um_error) for row in rows]
    if banded:
        _band(axes, over, np.tile(bars, (2, 1)), colour)
    for values, style in (
        ([row.transmission_error_um for row in rows], {}),
        ([row.static_transmission_error_um for row in rows], STATIC),
    ):
        axes.plot(over, np.tile(values, 2), color=colour, **style)
    axes.set_xlim(0.0, 2.0 * pitch)
    axes.axvline(pitch, color=FAINT, lw=0.8, zorder=0)
    axes.text(pitch, 0.02, " one pitch", color=INK, fontsize=7, va="bottom", transform=axes.get_xaxis_transform())


def _pressures(
    axes: Axes, rows: Sequence[TransientToothRow], colour: Colour, friction: float, banded: bool
) -> None:
    """Over the engagement, with gaps where no pressure is known."""
    angle = np.array([row.tooth_angle_deg for row in rows])
    if not len(angle):
        return
    step = min((b - a for a, b in pairwise(np.unique(np.round(angle, 9)))), default=1.0)
    breaks = np.flatnonzero(np.diff(angle) > 1.5 * step) + 1
    bars = np.array([(row.max_pressure_MPa, row.max_pressure_MPa_error) for row in rows])
    if banded:
        _band(axes, np.insert(angle, breaks, np.nan), np.insert(bars, breaks, np.nan, axis=0), colour)
    for values, style in (
        ([row.max_pressure_MPa for row in rows], {"label": f"μ = {friction:g}"}),
        ([row.static_max_pressure_MPa for row in rows], STATIC),
    ):
        axes.plot(np.insert(angle, breaks, np.nan), np.insert(values, breaks, np.nan), color=colour, **style)


def _band(axes: Axes, angle: Floats, bars: Floats, colour: Colour) -> None:
    """Between the error bars (n, 2) of a curve: its values, and their errors; none where these are not known."""
    value, error = bars.T
    axes.fill_between(angle, value - error, value + error, color=colour, alpha=BAND, lw=0.0)
