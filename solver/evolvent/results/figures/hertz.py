"""Comparison of peak pressures with Hertz for the same loads, and with estimates."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from evolvent.gears.pressure.contact_cells import FEWEST_CELLS
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import between
from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.results.drawing.style import (
    AT_ZONE_END,
    FAINT,
    HOLLOW,
    INK,
    OVER_KINK,
    PINION,
    dot_size,
    foot,
    sheet,
)
from evolvent.results.engagement import largest_peak
from evolvent.results.mesh_facts import cells_across, few_cells_across
from evolvent.results.relief_kinks import AWAY, kink_notes, largest_kink, relief_kinks
from evolvent.results.run_data import RunData
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Floats

HERTZ = "#c98a1b"
KINK: dict[str, Any] = {"marker": "D", "markersize": 6.0, "markerfacecolor": "white", "linestyle": "", "color": HERTZ}
"""Marker of the pressure over a sharp kink."""
WHITE = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}


def hertz_comparison(run: RunData, index: int = 0) -> Figure:
    """Figure of the peak pressures of all slices with Hertz for their line loads, and with estimates."""
    cut = Slices.joined([each[index].cut for each in run.positions])
    ξ, peak, hertz = cut.roll_distance, cut.peak, cut.hertz
    start, end = run.pair.path_of_contact
    fitted = np.isfinite(peak) & (ξ > start) & (ξ < end)
    within = fitted & between(ξ, run.inner_path)
    inside, kink = within & ~cut.kink, within & cut.kink
    ratio = peak[inside] / hertz[inside] - 1.0
    middle, most = signed(100 * float(np.median(ratio))), 100 * np.quantile(np.abs(ratio), 0.9)
    subtitle = f"Difference from Hertz for a slice's own line load: median {middle} %"
    subtitle += f", at most {most:.1f} % in nine slices of ten (μ = {run.frictions[index]:g})."
    if few_cells_across(run):
        few = f"{cells_across(run):.1f} elements across the contact, fewer than {FEWEST_CELLS:g}"
        subtitle += f" For orientation only: {few}."
    figure = sheet("Contact stress compared with Hertz", subtitle, (11.4, 6.2))
    along, bars = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    along.plot(
        ξ[inside],
        peak[inside],
        ".",
        color=PINION,
        markersize=dot_size(len(ξ)),
        alpha=0.5,
        label="computed, every slice",
    )
    along.plot(
        ξ[inside],
        hertz[inside],
        ".",
        color=HERTZ,
        markersize=dot_size(len(ξ)) - 1,
        alpha=0.5,
        label="Hertz, the slice's line load",
    )
    if (beyond := fitted & ~within).any():
        size = dot_size(len(ξ)) - 1
        along.plot(ξ[beyond], peak[beyond], ".", color=FAINT, markersize=size, alpha=0.5, label="in a tip-edge zone")
    if kink.any():
        along.plot(ξ[kink], peak[kink], "x", color=FAINT, markersize=4.0, label=f"computed, {OVER_KINK}")
    for number, each in enumerate(relief_kinks(run, index)):
        name = None if number else f"closed form, {OVER_KINK}"
        along.plot(each.roll_distance, each.pressure, label=name, **KINK)
    estimate, line = run.scene.hertz_estimate(), np.linspace(start, end, 200)
    uniform = "Hertz, uniform load on the mean line length"
    along.plot(line, estimate.peak_pressure(line), color=INK, linewidth=1.3, label=uniform)
    _largest(along, run, index)
    along.axvline(0.0, color=FAINT, linestyle=":", linewidth=1.0)
    along.set(xlabel="roll distance ξ from the pitch point [mm]", ylabel="peak pressure [MPa]")
    along.set_ylim(bottom=0.0)
    along.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    _estimates(bars, run, index, ξ, peak)
    pooled = "The reported maximum is averaged with neighbouring slices (1:2:1); single slices scatter about it."
    foot(figure, *([] if run.plane else [pooled]), *kink_notes(run, index))
    return figure


def _largest_named(run: RunData, index: int) -> str:
    """Name of the largest pressure that the run reports."""
    return f"computed, largest {AWAY}" if largest_kink(run, index) else "computed, largest"


def _largest(axes: Axes, run: RunData, index: int) -> None:
    """Marker of the largest pressure that the run reports, with its error bar; it may lie between two positions."""
    top, bar = largest_peak(run, index), run.errors.bar("max_pressure_MPa", index)
    face = {"markerfacecolor": "white" if top.at_zone_end else INK}
    label = _largest_named(run, index) + (f": {AT_ZONE_END}" if top.at_zone_end else "")
    size = bar if np.isfinite(bar) else None
    line = {"color": INK, "capsize": 4.0, "linewidth": 1.2}
    axes.errorbar(top.roll_distance, top.pressure, yerr=size, label=label, **(line | HOLLOW | face))


def _estimates(axes: Axes, run: RunData, index: int, ξ: Floats, peak: Floats) -> None:
    """Bars of Hertz at the pitch point and of computed pressures."""
    estimate, kink = run.scene.hertz_estimate(), largest_kink(run, index)
    near = np.isfinite(peak) & (np.abs(ξ) < 0.25 * run.pair.pinion.normal_module)
    shortest = float(estimate.peak_pressure(0.0, estimate.line_lengths[0]))
    rows = [
        ("Hertz at the pitch point,\nmean line length", float(estimate.peak_pressure(0.0)), HERTZ),
        ("Hertz at the pitch point,\nshortest line", shortest, HERTZ),
        *([("computed near the\npitch line, median", float(np.median(peak[near])), PINION)] if near.any() else ()),
        *([("sharp relief start,\nclosed form", kink.pressure, HERTZ)] if kink else ()),
        (_largest_named(run, index).replace(" away", "\naway"), largest_peak(run, index).pressure, PINION),
    ]
    bar = run.errors.bar("max_pressure_MPa", index)
    places = np.arange(len(rows))[::-1]
    axes.barh(places, [row[1] for row in rows], color=[row[2] for row in rows], height=0.6)
    known = [*[0.0] * (len(rows) - 1), bar if np.isfinite(bar) else 0.0]
    for place, (_, value, _), more in zip(places, rows, known):
        beside = {"xytext": (6, 0), "textcoords": "offset points"}
        axes.annotate(plus_minus(value, more, 0), (value + more, place), va="center", fontsize=9, bbox=WHITE, **beside)
    if known[-1]:
        axes.errorbar(rows[-1][1], places[-1], xerr=known[-1], color=INK, capsize=4.0, linewidth=1.2)
    axes.set_yticks(places, [row[0] for row in rows], fontsize=9)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.set(xlabel="contact stress [MPa]", xlim=(0.0, 1.3 * max(row[1] + more for row, more in zip(rows, known))))
    axes.grid(axis="y", visible=False)
