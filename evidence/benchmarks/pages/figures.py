"""The figures of docs/benchmark.md."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from evidence.benchmarks.comparison.programs import EVOLVENT
from evidence.benchmarks.comparison.work_precision import Row
from evidence.benchmarks.gears.earlier import EarlierPitchRow
from evidence.benchmarks.gears.pitch_precision import IN_LEVELS, ONE_MESH, PitchRow
from evidence.benchmarks.gears.position_cost import GearRow
from evidence.benchmarks.gears.scaling import SizeRow, exponent
from evidence.benchmarks.gears.wear import WearPrecisionRow
from evolvent.results.drawing import style
from evolvent_meshes.arrays import Floats

COLOURS = {
    EVOLVENT.name: "#c0392b", "GetFEM": "#1f5fa8", "CalculiX": "#3b7a57", "CalculiX mortar": "#c98a1b",
    "Kratos": "#8a5a9e",
}
BLOCK_COLOURS = {"implicit": "#c0392b", "explicit": "#1f5fa8"}
PLURAL = {"quadrilateral": "quadrilaterals", "triangle": "triangles", "hexahedron": "hexahedra",
          "tetrahedron": "tetrahedra"}
FAMILIES = {
    ("hexahedron", 1, 1, ONE_MESH): "o--", ("tetrahedron", 1, 1, ONE_MESH): "^--",
    ("hexahedron", 2, 1, ONE_MESH): "s-", ("tetrahedron", 2, 1, ONE_MESH): "v-",
    ("hexahedron", 2, 2, ONE_MESH): "D:", ("hexahedron", 2, 1, IN_LEVELS): "P-",
}
WRONG = 0.5  # an error of the profile that would squeeze all others into a corner of the figure
SIMPLICES = ("triangle", "tetrahedron")


def column(rows: Sequence[Any], name: str) -> Floats:
    """One field of all rows, (n,)."""
    return np.array([getattr(row, name) for row in rows], dtype=float)


def work_precision(rows: Sequence[Row], title: str) -> Figure:
    """Seconds over the error of the pressure profile, log-log; a panel a family of cells."""
    kept = [row for row in rows if not row.note and row.profile_error < WRONG]
    see = "Down and left is better: less time, smaller error. All programs solve on the same meshes, one thread."
    if len(kept) < len(rows):
        see += f" Answers more than {WRONG:.0%} off are left out."
    with style.styled():
        figure = style.sheet(f"{title}: run time against error", see, (11.0, 5.2))
        axes = figure.subplots(1, 2, sharex=True, sharey=True)
        for panel, simplex in zip(axes, (False, True)):
            _panel(panel, [row for row in kept if (row.shape in SIMPLICES) == simplex])
        axes[0].set_ylabel("CPU time of the process [s]")
        axes[1].legend(*axes[0].get_legend_handles_labels(), fontsize=8, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    return figure


def _panel(axes: Axes, rows: Sequence[Row]) -> None:
    for name, colour in COLOURS.items():
        for order, marks in ((1, "o--"), (2, "s-")):
            shown = [row for row in rows if row.program == name and row.order == order]
            if shown:
                error, seconds = 100 * column(shown, "profile_error"), column(shown, "cpu")
                axes.loglog(error, seconds, marks, color=colour, ms=4, label=f"{name}, order {order}")
    axes.set_xlabel("error of the pressure profile (L2) [%]")
    axes.set_title(PLURAL[rows[0].shape] if rows else "", fontsize=10)
    _plain_ticks(axes)


def _plain_ticks(axes: Axes) -> None:
    """1, 2, 5 of every decade, as plain numbers."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:,.7g}")
        axis.set_minor_formatter("")


def gears(rows: Sequence[GearRow]) -> Figure:
    """Seconds a position of every program, and how many times Evolvent's pitch."""
    kept = sorted((row for row in rows if not row.note), key=lambda row: -row.seconds)
    models = {"whole gears": "whole gears, a pitch", "three teeth": "three teeth"}
    names = [f"{row.program}, {models[row.model]}\norder {row.order}, {row.dofs:,} dofs" for row in kept]
    with style.styled():
        see = "Evolvent condenses the whole gears once for a pitch; the others solve three teeth anew each time."
        figure = style.sheet("A position of the gear pair, all but meshing", see, (9.0, 4.2))
        axes = figure.subplots()
        bars = axes.barh(range(len(kept)), column(kept, "seconds"), 0.6, color=[COLOURS[row.program] for row in kept])
        axes.bar_label(bars, [f"{row.seconds:.3g} s, {row.ratio:.3g} times" for row in kept], padding=4, fontsize=9)
        axes.set_yticks(range(len(kept)), names)
        axes.grid(axis="y", visible=False)
        axes.margins(x=0.2)
        axes.set_xlabel("CPU time a position [s]")
    return figure


def earlier_pitches(rows: Sequence[EarlierPitchRow]) -> Figure:
    """Seconds of a pitch over the error of its mean transmission error, log-log, before and now."""
    with style.styled():
        see = "Down and left is better. Labels: elements across the contact width."
        figure = style.sheet("A pitch on flanks in levels: run time against error", see, (7.5, 5.0))
        axes = figure.subplots()
        before = f"commit {rows[0].commit}", "earlier_error", "earlier_seconds", "o--"
        for label, error, seconds, marks in (before, ("now", "error", "seconds", "s-")):
            x, y = 100 * np.abs(column(rows, error)), column(rows, seconds)
            axes.loglog(x, y, marks, ms=5, label=label)
            for n, *place in zip(column(rows, "elements"), x, y):
                axes.annotate(f"{n:g}", place, (6, 4), textcoords="offset points", fontsize=8)
        axes.set_xlabel("error of the mean transmission error [%]")
        axes.set_ylabel("wall time without meshing [s]")
        _plain_ticks(axes)
        axes.legend()
    return figure


def pitches(rows: Sequence[PitchRow]) -> Figure:
    """Seconds over the error of the transmission error, log-log: of one position, and of the pitch."""
    kept = [row for row in rows if not row.note]
    with style.styled():
        see = "Down and left is better. A pitch costs little more than one position: the gears are condensed once."
        figure = style.sheet("The gear pair: run time against error", see, (11.0, 5.2))
        axes = figure.subplots(1, 2, sharex=True, sharey=True)
        for panel, name, title in zip(axes, ("one", "pitch"), ("one position", f"a pitch of {kept[0].positions}")):
            for family, marks in FAMILIES.items():
                shown = [r for r in kept if (r.shape, r.order, r.ranks, r.flanks) == family]
                shape, order, ranks, flanks = family
                label = f"{PLURAL[shape]}, order {order}" + (", two ranks" if ranks > 1 else "")
                label += ", flanks in levels" if flanks == IN_LEVELS else ""
                panel.loglog(100 * np.abs(column(shown, "error")), column(shown, name), marks, ms=5, label=label)
            panel.set_xlabel("error of the mean transmission error [%]")
            panel.set_title(title, fontsize=10)
            _plain_ticks(panel)
        axes[0].set_ylabel("wall time of all but meshing [s]")
        axes[0].legend(fontsize=8)
    return figure


def level_sizes(rows: Sequence[SizeRow]) -> Figure:
    """The same with levels on the flanks."""
    return sizes(rows, ", with levels on its flanks", "of the equivalent fine meshes of both sectors")


def sizes(rows: Sequence[SizeRow], which: str = "", of: str = "of both sectors") -> Figure:
    """Memory, condensing and one more position over the size, with their exponents. which: gear pair; of: what the size
    is counted."""
    rows = [row for row in rows if not row.note]
    dofs = column(rows, "dofs")
    with style.styled():
        see = "Left: what a pitch needs at most. Right: what is done once, and what each further position adds."
        figure = style.sheet(f"A pitch of the gear pair over its size{which}", see, (10.4, 4.8))
        memory, time = figure.subplots(1, 2)
        _line(memory, dofs, column(rows, "memory_MB") / 1024.0, "memory", "#1f5fa8")
        memory.set_ylabel("largest memory [GiB]")
        _line(time, dofs, column(rows, "condense"), "condensing both gears, once", "#1f5fa8")
        _line(time, dofs, column(rows, "position"), "one more position", "#c0392b")
        time.set_ylabel("wall time [s]")
        for axes in (memory, time):
            axes.set_xlabel(f"degrees of freedom {of}")
            _plain_ticks(axes)
            axes.legend()
    return figure


def wear(rows: Sequence[WearPrecisionRow]) -> Figure:
    """Seconds over the error of the depths, log-log; a point a tolerance."""
    see = "Down and left is better; a point a tolerance. Error: volume worn off in the wrong place, over all of it."
    with style.styled():
        figure = style.sheet("Wear to 1.6 million mesh cycles: run time against error of the blocks", see)
        axes = figure.add_subplot()
        for name, colour in BLOCK_COLOURS.items():
            shown = [row for row in rows if row.method == name]
            x, y = 100.0 * column(shown, "error"), column(shown, "seconds")
            axes.loglog(x, y, "o-", color=colour, label=name)
            for at in np.unique(x.round(2)):  # where stability makes blocks short, all tolerances are one point
                these = np.flatnonzero(x.round(2) == at)
                text = ", ".join(f"{shown[k].tolerance:g}" for k in these)
                place = x[these[0]], y[these].max()
                axes.annotate(text, place, textcoords="offset points", xytext=(4, 6), fontsize=8)
        axes.set(xlabel="error of the depths [%]", ylabel="CPU time of the study [s]")
        axes.legend()
    return figure


def _line(axes: Axes, x: Floats, y: Floats, label: str, colour: str) -> None:
    power = f" ~ dofs$^{{{exponent(x, y):.2f}}}$" if len(x) > 1 else ""
    axes.loglog(x, y, "o-", color=colour, ms=4, label=label + power)
