"""The figures of the benchmark."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from evidence.benchmark.gear_rows import GearRow
from evidence.benchmark.pitches import PitchRow
from evidence.benchmark.precision import Row
from evidence.benchmark.programs import EVOLVENT
from evidence.benchmark.scaling import SizeRow, exponent
from evolvent.results.drawing import style
from evolvent_meshes.arrays import Floats

COLOURS = {
    EVOLVENT.name: "#c0392b", "GetFEM": "#1f5fa8", "CalculiX": "#3b7a57", "CalculiX mortar": "#c98a1b",
    "Kratos": "#8a5a9e",
}  # fmt: skip
PLURAL = {"quadrilateral": "quadrilaterals", "triangle": "triangles", "hexahedron": "hexahedra",
          "tetrahedron": "tetrahedra"}  # fmt: skip
FAMILIES = {
    ("hexahedron", 1, 1): "o--", ("tetrahedron", 1, 1): "^--", ("hexahedron", 2, 1): "s-", ("tetrahedron", 2, 1): "v-",
    ("hexahedron", 2, 2): "D:",
}  # fmt: skip
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
            own = [row for row in rows if row.program == name and row.order == order]
            if own:
                error, seconds = 100 * column(own, "profile_error"), column(own, "cpu")
                axes.loglog(error, seconds, marks, color=colour, ms=4, label=f"{name}, order {order}")
    axes.set_xlabel("error of the pressure profile (L2) [%]")
    axes.set_title(PLURAL[rows[0].shape] if rows else "", fontsize=10)
    _plain_ticks(axes)


def _plain_ticks(axes: Axes) -> None:
    """1, 2, 5 of every decade, as plain numbers."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:,g}")
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


def pitches(rows: Sequence[PitchRow]) -> Figure:
    """Seconds over the error of the transmission error, log-log: of one position, and of the pitch."""
    kept = [row for row in rows if not row.note]
    with style.styled():
        see = "Down and left is better. A pitch costs little more than one position: the gears are condensed once."
        figure = style.sheet("The gear pair: run time against error", see, (11.0, 5.2))
        axes = figure.subplots(1, 2, sharex=True, sharey=True)
        for panel, name, title in zip(axes, ("one", "pitch"), ("one position", f"a pitch of {kept[0].positions}")):
            for (shape, order, ranks), marks in FAMILIES.items():
                own = [r for r in kept if (r.shape, r.order, r.ranks) == (shape, order, ranks)]
                label = f"{PLURAL[shape]}, order {order}" + (", two ranks" if ranks > 1 else "")
                panel.loglog(100 * np.abs(column(own, "error")), column(own, name), marks, ms=5, label=label)
            panel.set_xlabel("error of the mean transmission error [%]")
            panel.set_title(title, fontsize=10)
            _plain_ticks(panel)
        axes[0].set_ylabel("wall time of all but meshing [s]")
        axes[0].legend(fontsize=8)
    return figure


def sizes(rows: Sequence[SizeRow]) -> Figure:
    """Memory, condensing and one more position over the size, with their exponents."""
    dofs = column(rows, "dofs")
    with style.styled():
        see = "Left: what a pitch needs at most. Right: what is done once, and what each further position adds."
        figure = style.sheet("A pitch of the gear pair, over its size", see, (10.4, 4.8))
        memory, time = figure.subplots(1, 2)
        _line(memory, dofs, column(rows, "memory_MB") / 1024.0, "memory", "#1f5fa8")
        memory.set_ylabel("largest memory [GiB]")
        _line(time, dofs, column(rows, "condense"), "condensing both gears, once", "#1f5fa8")
        _line(time, dofs, column(rows, "position"), "one more position", "#c0392b")
        time.set_ylabel("wall time [s]")
        for axes in (memory, time):
            axes.set_xlabel("degrees of freedom of both sectors")
            _plain_ticks(axes)
            axes.legend()
    return figure


def _line(axes: Axes, x: Floats, y: Floats, label: str, colour: str) -> None:
    power = f" ~ dofs$^{{{exponent(x, y):.2f}}}$" if len(x) > 1 else ""
    axes.loglog(x, y, "o-", color=colour, ms=4, label=label + power)
