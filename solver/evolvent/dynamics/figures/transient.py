"""Picture of a pair's transient contact: transmission error, mesh force and pressure of a tooth, beside statics."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from evolvent.dynamics.results.transient.facts import TransientFacts
from evolvent.dynamics.results.transient.rows import TransientRow, TransientToothRow
from evolvent.results.drawing.style import FAINT, INK, foot, friction_colours, note, sheet
from evolvent_meshes.arrays import Floats

Colour = tuple[float, ...]
BAND, BANDS = 0.15, 2
"""Opacity of error bars, and friction coefficients up to which they are drawn: more bands hide each other."""
ROOM = 0.12
"""Free height above the curves, over the height of a panel."""
WIDTH, HEADER, ROW = 15.0, 1.4, 3.0
"""Width of the sheet, height of its titles with the foot, and height of a line of panels [inch]."""
STATIC = {"ls": "--", "lw": 1.0}
SUBTITLE = "The last mesh period, repeated, at each speed of the pinion, beside the same positions without inertia"


def transient_figure(
    title: str, rows: Sequence[TransientRow], teeth: Sequence[TransientToothRow], facts: Sequence[TransientFacts]
) -> Figure:
    """A line of panels for each speed: transmission error and mesh force over two pitches, pressure of a tooth over its
    engagement. rows, facts: of the cases in the same order; of rows numbers have nine digits."""
    cases = dict(zip(dict.fromkeys((row.speed_rpm, row.friction) for row in rows), facts))
    speeds, frictions = (sorted(set(each)) for each in zip(*cases))
    figure = sheet(f"{title}: contact with inertia", SUBTITLE, (WIDTH, HEADER + ROW * len(speeds)))
    grid = figure.subplots(len(speeds), 3, squeeze=False, width_ratios=(1.0, 1.0, 1.2))
    banded = len(frictions) <= BANDS and any(np.isfinite(row.transmission_error_um_error) for row in rows)
    colours = friction_colours(frictions)
    for panels, speed in zip(grid, speeds):
        for friction, colour in zip(frictions, colours):
            case = (speed, friction)
            own = [row for row in rows if (row.speed_rpm, row.friction) == case]
            _errors(panels[0], own, colour, banded)
            _forces(panels[1], own, cases[case].load_N, colour, banded)
            _pressures(panels[2], [row for row in teeth if (row.speed_rpm, row.friction) == case], colour, banded)
        for axes, quantity in zip(panels, ("transmission error [µm]", "mesh force [N]", "peak pressure [MPa]")):
            axes.set_ylabel(quantity)
            note(axes, f"{speed:g} r/min")
        panels[1].set_ylim(bottom=0.0)
        panels[2].set_ylim(bottom=max(0.0, panels[2].get_ylim()[0]))
    for axes in grid.flat:  # room for notes
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + ROOM * (high - low))
    for axes in grid[-1][:2]:
        axes.set_xlabel("rotation of the pinion [°]")
    grid[-1][2].set_xlabel("rotation of the pinion since the tooth met at the pitch point [°]")
    _legend(figure, frictions, colours)
    unsteady = [fact for fact in facts if not fact.steady]
    foot(
        figure,
        "Mesh force: along the line of action. Pressure: largest of the fitted half-ellipses along the contact line, "
        "between the tip-edge zones."
        + (" Bands: error bars." if banded else "")
        + (f" Not steady yet: {len(unsteady)} of {len(facts)} motions." if unsteady else ""),
    )
    return figure


def _legend(figure: Figure, frictions: Sequence[float], colours: Sequence[Colour]) -> None:
    """Draws the legend beside the titles, where it hides no curve."""
    lines = [Line2D([], [], color=colour, label=f"μ = {μ:g}") for μ, colour in zip(frictions, colours)]
    lines += [Line2D([], [], color=INK, label="with inertia"), Line2D([], [], color=INK, label="without", **STATIC)]
    width, height = figure.get_size_inches()
    figure.legend(
        handles=lines, loc="upper right", ncols=(len(lines) + 1) // 2, borderaxespad=0.0,
        bbox_to_anchor=(1.0 - 0.14 / width, 1.0 - 0.1 / height),
    )


def _errors(axes: Axes, rows: Sequence[TransientRow], colour: Colour, banded: bool) -> None:
    over = _pitches(axes, rows)
    bars = np.array([(row.transmission_error_um, row.transmission_error_um_error) for row in rows])
    if banded:
        _band(axes, over, _twice(bars), colour)
    axes.plot(over, _twice(bars[:, 0]), color=colour)
    axes.plot(over, _twice(np.array([row.static_transmission_error_um for row in rows])), color=colour, **STATIC)


def _forces(axes: Axes, rows: Sequence[TransientRow], load: float, colour: Colour, banded: bool) -> None:
    """Draws the mesh force over two pitches. load: the mesh force without inertia [N]."""
    over = _pitches(axes, rows)
    bars = np.array([(row.mesh_force_N, row.mesh_force_N_error) for row in rows])
    if banded:
        _band(axes, over, _twice(bars), colour, least=0.0)
    axes.plot(over, _twice(bars[:, 0]), color=colour)
    axes.axhline(load, color=colour, **STATIC)


def _pitches(axes: Axes, rows: Sequence[TransientRow]) -> Floats:
    """Rotations of two pitches with the end of the second (2n + 1,) [°], over which the panel is drawn."""
    angle = np.array([row.pinion_angle_deg for row in rows])
    pitch = len(angle) * float(np.diff(angle).mean())
    axes.set_xlim(0.0, 2.0 * pitch)
    axes.axvline(pitch, color=FAINT, lw=0.8, zorder=0)
    axes.text(pitch, 0.02, " one pitch", color=INK, fontsize=8, va="bottom", transform=axes.get_xaxis_transform())
    return np.concatenate([angle, angle + pitch, angle[:1] + 2.0 * pitch])


def _twice(values: Floats) -> Floats:
    """Values of a mesh period (n, ...), repeated, with that of the beginning at the end (2n + 1, ...)."""
    return np.concatenate([values, values, values[:1]])


def _pressures(axes: Axes, rows: Sequence[TransientToothRow], colour: Colour, banded: bool) -> None:
    """Draws the pressure of a tooth over its engagement, with gaps where no pressure is known."""
    angle = np.array([row.tooth_angle_deg for row in rows])
    if not len(angle):
        return
    step = min((b - a for a, b in pairwise(np.unique(np.round(angle, 9)))), default=1.0)
    breaks = np.flatnonzero(np.diff(angle) > 1.5 * step) + 1
    bars = np.array([(row.max_pressure_MPa, row.max_pressure_MPa_error) for row in rows])
    if banded:
        _band(axes, np.insert(angle, breaks, np.nan), np.insert(bars, breaks, np.nan, axis=0), colour, 0.0)
    for values, style in (
        ([row.max_pressure_MPa for row in rows], {}),
        ([row.static_max_pressure_MPa for row in rows], STATIC),
    ):
        axes.plot(np.insert(angle, breaks, np.nan), np.insert(values, breaks, np.nan), color=colour, **style)


def _band(axes: Axes, angle: Floats, bars: Floats, colour: Colour, least: float = -np.inf) -> None:
    """Draws a band between the error bars (n, 2) of a curve: its values, and their errors; none where these are not
    known. least: below which the quantity cannot be."""
    value, error = bars.T
    axes.fill_between(angle, np.maximum(value - error, least), value + error, color=colour, alpha=BAND, lw=0.0)
