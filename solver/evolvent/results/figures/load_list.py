"""Transmission error, contact pressure and mesh stiffness against the torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.results.drawing.style import foot, friction_colours, sheet, torque_colours
from evolvent.results.tables.load_table import ERROR, LoadResult

PANELS = (
    ("transmission_error_peak_to_peak_um", "peak-to-peak transmission error [µm]"),
    ("max_pressure_MPa", "largest contact pressure [MPa]"),
    ("mesh_stiffness_N_per_mm_um", "mean tangent mesh stiffness [N/(mm·µm)]"),
)
"""Key of each figure and label of its axis."""
LONGEST = 12
"""Largest number of letters of a load case's name for which there is room beside the curves."""


def loads_figure(results: Sequence[LoadResult]) -> Figure:
    """Figure of the transmission error over the pitch under each load, and of three figures over the torque, a line
    per friction coefficient. results: the lightest torque first, as of `load_results`."""
    frictions = sorted({each.row.friction for each in results})
    torques = sorted({each.row.torque_Nm for each in results})
    figure = sheet(
        "Transmission error, contact pressure and mesh stiffness against the torque",
        f"{len({each.row.case for each in results})} loads from {torques[0]:.4g} to {torques[-1]:.4g} N·m on the same "
        "condensed gears; where the flanks have levels, each torque takes as many as it needs.",
        (11.0, 7.6),
    )
    grid = figure.subplots(2, 2)
    _draw_curves(grid[0, 0], [each for each in results if each.row.friction == frictions[0]])
    for axes, (key, label) in zip((grid[0, 1], grid[1, 0], grid[1, 1]), PANELS):
        for friction, colour in zip(frictions, friction_colours(frictions)):
            own = [each.row for each in results if each.row.friction == friction]
            torque, values, bars = ([getattr(row, name) for row in own] for name in ("torque_Nm", key, key + ERROR))
            known = np.array([np.nan if bar is None else bar for bar in bars], dtype=float)
            drawn = known if np.isfinite(known).any() else None  # matplotlib takes no list without a single number
            axes.errorbar(torque, values, drawn, color=colour, capsize=3.0, label=f"μ = {friction:g}")
            fills = ["white" if row.tip_edge_positions else colour for row in own]
            for row, value, fill in zip(own, values, fills):
                at_end = key == "max_pressure_MPa" and row.max_pressure_at_zone_end
                marker = {"marker": "s" if at_end else "o", "markerfacecolor": fill, "markeredgecolor": colour}
                axes.plot(row.torque_Nm, value, markersize=4.5, linestyle="", zorder=3, **marker)
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(0.0, 1.05 * torques[-1])
        axes.set_xlabel("torque [N·m]")
        axes.set_ylabel(label)
    kinks = _draw_kinks(grid[1, 0], results, frictions)
    if len(frictions) > 1:
        grid[0, 1].legend(loc="best")
    foot(
        figure,
        "Bars: estimated error, of mesh and spacing of positions. Hollow: a tip edge bears at some positions.",
        "Pressure: between tip-edge zones; square: at the end of such a zone, where it varies beyond its bar.",
        *(["Pressure: away from the starts of linear reliefs; dotted: over them, for an ideal kink."] if kinks else []),
    )
    return figure


def _draw_kinks(axes: Axes, results: Sequence[LoadResult], frictions: Sequence[float]) -> bool:
    """Draws dotted lines of the pressure over the starts of linear reliefs; returns whether there are any."""
    for friction, colour in zip(frictions, friction_colours(frictions)):
        own = [each.row for each in results if each.row.friction == friction]
        axes.plot([row.torque_Nm for row in own], [row.kink_pressure_MPa for row in own], ":", color=colour)
    return bool(np.isfinite([each.row.kink_pressure_MPa for each in results]).any())


def _draw_curves(axes: Axes, results: Sequence[LoadResult]) -> None:
    """Transmission error over the pitch, minus its mean, under each load."""
    for each, colour in zip(results, torque_colours(len(results))):
        varying = np.array(each.transmission_error)
        name = each.row.case if len(each.row.case) <= LONGEST else f"{each.row.case[:LONGEST]}…"
        label = f"{name}, {each.row.torque_Nm:.4g} N·m"
        axes.plot(each.angle, varying - varying.mean(), color=colour, marker=".", label=label)
    axes.set_xlabel("pinion rotation [°]")
    axes.set_ylabel("transmission error minus its mean [µm]")
    title = f"μ = {results[0].row.friction:g}"
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8.0, title=title, title_fontsize=8.0)
