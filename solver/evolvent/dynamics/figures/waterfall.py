"""Picture of a pair's spectrum while it runs up: frequency over speed, coloured by the amplitude of the mesh force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from evolvent.dynamics.oscillator.response import HIGHEST_ORDER
from evolvent.dynamics.results.response import DriveSummary
from evolvent.dynamics.results.spectrum import SpectrumRow
from evolvent.results.drawing.style import FAINT, INK, PRESSURE_MAP, foot, sheet
from evolvent_meshes.arrays import Floats

LOWEST = 1e-3
"""Least amplitude of the lines that are drawn, over the static force."""
BEYOND_NATURAL = 3.2
"""Highest frequency of the picture, over the natural one."""
WHOLE, PART = 5.5, 3.0
"""Widths of lines of whole orders and of those between them [pt]."""


def waterfall_figure(known: DriveSummary, rows: Sequence[SpectrumRow]) -> Figure:
    """Spectrum of the mesh force while the pair runs up: frequency over speed, coloured by the amplitude."""
    lines = [row for row in rows if row.way == "up"]
    speeds = np.array(list(dict.fromkeys(row.speed_rpm for row in lines)))
    natural, load = 1e-3 * known.natural_frequency_Hz, known.static_force_N
    mesh = natural * speeds / known.natural_speed_rpm
    top = min(HIGHEST_ORDER * float(mesh[-1]), max(BEYOND_NATURAL * natural, 2.2 * float(mesh[-1])))
    figure = sheet("Spectrum of the mesh force while running up", _strongest(lines, load), (11.0, 6.6))
    axes = figure.subplots()
    drawn = _draw_lines(axes, speeds, lines, load)
    axes.axhline(natural, color=INK, lw=1.0, ls="--", zorder=1)
    axes.text(speeds[-1], natural, "natural frequency ", va="bottom", ha="right", fontsize=9, color=INK)
    for speed in known.jumps_up_rpm:
        axes.axvline(speed, color=FAINT, lw=1.0, ls=":", zorder=1)
    axes.set_xlim(speeds[0], speeds[-1])
    axes.set_ylim(0.0, top)
    axes.grid(visible=False)
    _draw_orders(axes, speeds, mesh, top)
    axes.set_xlabel("speed of the pinion [r/min]")
    axes.set_ylabel("frequency [kHz]")
    figure.colorbar(drawn, ax=axes, pad=0.06, label="amplitude of the mesh force [N]")
    foot(
        figure,
        "Numbers: orders of the mesh. Narrow lines between them: a motion that does not repeat with every mesh.",
        f"Of {known.bodies} gear bodies. Dotted: jumps. Thin grey: below {LOWEST * load:.2g} N. All lines, running "
        "down, too: spectrum.csv.",
    )
    return figure


def _strongest(lines: Sequence[SpectrumRow], load: float) -> str:
    """The line with the largest amplitude."""
    row = max(lines, key=lambda row: row.force_N)
    return (
        f"Strongest line: {row.force_N:.0f} N, {100.0 * row.force_N / load:.0f} % of the static force, order "
        f"{row.order:.3g} at {row.speed_rpm:.0f} r/min."
    )


def _draw_lines(axes: Axes, speeds: Floats, lines: Sequence[SpectrumRow], load: float) -> LineCollection:
    """Draws each line as a piece along its order, halfway to the speeds (n,) beside; the strongest on top."""
    middle = 0.5 * (speeds[1:] + speeds[:-1])
    ends = np.column_stack([np.append(speeds[0], middle), np.append(middle, speeds[-1])])
    reach = dict(zip(speeds.tolist(), ends))
    pieces, sizes, widths = [], [], []
    for row in lines:
        if row.force_N >= LOWEST * load:
            end = reach[row.speed_rpm]
            pieces.append(np.column_stack([end, 1e-3 * row.frequency_Hz * end / row.speed_rpm]))
            sizes.append(row.force_N)
            widths.append(WHOLE if row.order == round(row.order) else PART)
    rank = np.argsort(sizes)
    drawn = LineCollection(
        [pieces[i] for i in rank], array=np.array(sizes)[rank], cmap=PRESSURE_MAP, linewidths=np.array(widths)[rank],
        norm=LogNorm(LOWEST * load, max([*sizes, load])), capstyle="projecting", zorder=2,
    )
    axes.add_collection(drawn)
    return drawn


def _draw_orders(axes: Axes, speeds: Floats, mesh: Floats, top: float) -> None:
    """Lines of the orders, and their numbers where these leave the picture, at its right or its upper side."""
    for order in range(1, HIGHEST_ORDER + 1):
        axes.plot(speeds, order * mesh, color=FAINT, lw=0.6, alpha=0.6, zorder=1)
        share = top / (order * float(mesh[-1]))
        if share >= 1.0:
            axes.annotate(
                f"{order}", (speeds[-1], order * mesh[-1]), xytext=(5, 0), textcoords="offset points", va="center"
            )
        elif share * speeds[-1] > speeds[0]:
            axes.annotate(
                f"{order}", (share * speeds[-1], top), xytext=(0, 3), textcoords="offset points", ha="center"
            )
