"""Transmission error, contact pressure and mesh stiffness over the torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.results.drawing.style import FRICTION_MAP, foot, friction_colours, png, sheet, styled
from evolvent.results.tables.load_table import LoadResult

PANELS = (
    ("transmission_error_peak_to_peak_um", "peak-to-peak transmission error [µm]"),
    ("max_pressure_MPa", "largest contact pressure [MPa]"),
    ("mesh_stiffness_N_per_mm_um", "mesh stiffness [N/(mm·µm)]"),
)
"""Key of the figure and label of its axis."""


def loads_picture(results: Sequence[LoadResult]) -> bytes:
    """PNG of `loads_figure`."""
    with styled():
        return png(loads_figure(results))


def loads_figure(results: Sequence[LoadResult]) -> Figure:
    """Figure of the transmission error over the pitch under each torque, and of three figures over the torque, a line
    per friction coefficient."""
    frictions = sorted({each.friction for each in results})
    torques = sorted({each.torque for each in results})
    figure = sheet(
        "Transmission error, contact pressure and mesh stiffness over the load",
        f"{len(torques)} torques from {torques[0]:.4g} to {torques[-1]:.4g} N·m on the same condensed gears.",
        (11.0, 7.6),
    )
    grid = figure.subplots(2, 2)
    _draw_curves(grid[0, 0], [each for each in results if each.friction == frictions[0]])
    for axes, (key, label) in zip((grid[0, 1], grid[1, 0], grid[1, 1]), PANELS):
        for friction, colour in zip(frictions, friction_colours(frictions)):
            own = sorted((each for each in results if each.friction == friction), key=lambda each: each.torque)
            bars = np.nan_to_num([each.errors[key] for each in own])
            values = [each.figures[key] for each in own]
            axes.errorbar(
                [each.torque for each in own], values, bars, color=colour, marker="o", markersize=4.0, capsize=3.0,
                label=f"μ = {friction:g}",
            )  # fmt: skip
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(0.0, 1.05 * torques[-1])
        axes.set_xlabel("torque [N·m]")
        axes.set_ylabel(label)
    if len(frictions) > 1:
        grid[0, 1].legend(loc="best")
    foot(figure, "Bars: estimated error of the mesh, where the runs have one.")
    return figure


def _draw_curves(axes: Axes, results: Sequence[LoadResult]) -> None:
    """Transmission error over the pitch, less its mean, under each torque."""
    ordered = sorted(results, key=lambda each: each.torque)
    for rank, each in enumerate(ordered):
        colour, varying = FRICTION_MAP(rank / max(1, len(ordered) - 1)), np.array(each.transmission_error)
        axes.plot(each.angle, varying - varying.mean(), color=colour, marker=".", label=f"{each.torque:.4g} N·m")
    axes.set_xlabel("pinion rotation [°]")
    axes.set_ylabel("transmission error less its mean [µm]")
    title = f"μ = {ordered[0].friction:g}"
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8.0, title=title, title_fontsize=8.0)
