"""Mean and maximum contact stress of the teeth over the friction coefficient (Yang et al. 2022, Fig. 10)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from evolvent.results.drawing.style import AT_ZONE_END, FAINT, HOLLOW, INK, TEETH, sheet
from evolvent.results.drawing.teeth import long_name, short_name, shown_teeth
from evolvent.results.engagement import Engagement, engagements
from evolvent.results.run_data import RunData
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Bools, Floats


def friction_trend(run: RunData) -> Figure:
    """Figure of mean and maximum contact stress of the teeth over μ, and of their changes (Fig. 10)."""
    curves = sorted(engagements(run), key=lambda c: c.friction)
    each_tooth, μ = trends(curves, shown_teeth(curves)), [c.friction for c in curves]
    change = [(short_name(t.tooth), 100 * (t.largest[-1] / t.largest[0] - 1)) for t in each_tooth]
    changes = ", ".join(f"{name} by {signed(percent)} %" for name, percent in change)
    subtitle = f"The maximum changes from μ = {μ[0]:g} to {μ[-1]:g}: {changes}."
    figure = sheet("Contact stress over the friction coefficient", subtitle, (10.4, 6.4))
    cells = figure.add_gridspec(3, 2, height_ratios=(1.2, 1.0, 0.2))
    grid, below = cells[:2, :].subgridspec(2, 2, height_ratios=(1.2, 1.0)).subplots(sharex=True), cells[2, :]
    for trend, colour, marker in zip(each_tooth, TEETH, "osD^"):
        for column, values in enumerate((trend.average, trend.largest)):
            grid[0, column].plot(μ, values, color=colour, marker=marker, label=long_name(trend.tooth))
            grid[1, column].plot(μ, 100.0 * (values / values[0] - 1.0), color=colour, marker=marker)
        ends = [(μ[k], trend.largest[k]) for k in np.flatnonzero(trend.at_zone_end)]
        grid[0, 1].plot(*zip(*ends), color=colour, **{**HOLLOW, "marker": marker}) if ends else None
    for column, title in enumerate(("average along the contact line, over the pitch", "maximum over the pitch")):
        grid[0, column].set_title(title, fontsize=10)
        grid[0, column].set_ylim(0.0, 1.15 * max(np.max(t.largest) for t in each_tooth))
        grid[1, column].axhline(0.0, color=FAINT, linewidth=1.0)
        grid[1, column].set_xlabel("friction coefficient μ")
        grid[1, column].set_xlim(-0.03 * μ[-1], 1.05 * μ[-1])
    grid[0, 0].set_ylabel("contact stress [MPa]")
    grid[1, 0].set_ylabel(f"change from μ = {μ[0]:g} [%]")
    handles, _ = grid[0, 1].get_legend_handles_labels()
    at_end = any(trend.at_zone_end.any() for trend in each_tooth)
    hollow = [Line2D([], [], color=INK, label=AT_ZONE_END, **HOLLOW)] if at_end else []
    names = figure.add_subplot(below)
    names.axis("off")
    names.legend(handles=[*handles, *hollow], loc="center", ncols=3)
    return figure


@dataclass(frozen=True)
class Trend:
    """Contact stress of one tooth pair in a pitch, at n friction coefficients in ascending order."""

    tooth: int
    """Index of the tooth pair."""
    average: Floats
    """(n,), mean along the contact line and over the positions [MPa]."""
    largest: Floats
    """(n,), maximum [MPa]."""
    at_zone_end: Bools
    """(n,) bool, whether the maximum lies at the limit of a tip-edge zone."""


def trends(curves: Sequence[Engagement], teeth: Sequence[int]) -> list[Trend]:
    """Trends of these tooth pairs. curves: one per friction coefficient, ascending."""
    return [_trend(curves, tooth) for tooth in teeth]


def _trend(curves: Sequence[Engagement], tooth: int) -> Trend:
    average = [np.nanmean(c.mean_pressure[c.tooth == tooth]) for c in curves]
    peaks = [c.tooth_peak(tooth) for c in curves]
    largest, at_end = [peak.pressure for peak in peaks], [peak.at_zone_end for peak in peaks]
    return Trend(tooth, np.array(average), np.array(largest), np.array(at_end))
