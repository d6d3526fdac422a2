"""What wear costs: a part of the benchmark's page and its figure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from evidence.benchmark.figures import column
from evidence.benchmark.wear import BLOCKS, WearCostRow, WearPrecisionRow
from evidence.report import table
from evolvent.results.drawing import style

BAR = 5.0
COLOURS = {"implicit": "#c0392b", "explicit": "#1f5fa8"}


def wear_section(costs: Sequence[WearCostRow], precisions: Sequence[WearPrecisionRow]) -> list[str]:
    """Cost of blocks, and run time against error over the tolerance."""
    parts = ["## Wear"] if costs or precisions else []
    if costs:
        parts += [_costs_said(costs), _cost_table(costs)]
    if precisions:
        parts += ["![Run time against error of wear](pictures/benchmark/wear.png)", _precision_table(precisions)]
    return parts


def _costs_said(rows: Sequence[WearCostRow]) -> str:
    met = all(row.whole <= BAR for row in rows)
    return (
        f"A study of {BLOCKS} implicit blocks over one sweep of the unworn pair, without friction, CPU seconds; "
        f"*whole* with preparing both gears, on either side, *bare* without. Wanted at most {BAR:g} times: whole "
        f"{'met' if met else 'missed'}, bare {'met' if all(row.bare <= BAR for row in rows) else 'missed'}."
    )


def _cost_table(rows: Sequence[WearCostRow]) -> str:
    head = ("pair", "dofs", "prepare s", "sweep s", f"{BLOCKS} blocks s", "whole", "bare")
    lines = [
        [r.case, f"{r.dofs:,}", f"{r.prepare:.3g}", f"{r.sweep:.3g}", f"{r.study:.3g}", f"**{r.whole:.2f}**",
         f"{r.bare:.2f}"]
        for r in rows
    ]  # fmt: skip
    return table(head, lines, right=range(1, 7))


def _precision_table(rows: Sequence[WearPrecisionRow]) -> str:
    head = ("blocks", "tolerance", "made", "refused", "s", "error of the depths %", "of the volume %")
    lines = [
        [r.method, f"{r.tolerance:g}", str(r.blocks), str(r.refused), f"{r.seconds:.3g}", f"{100 * r.error:.2f}",
         f"{100 * r.volume_error:+.2f}"]
        for r in rows
    ]  # fmt: skip
    return table(head, lines, right=range(1, 7))


def precision(rows: Sequence[WearPrecisionRow]) -> Figure:
    """Seconds over the error of the depths, log-log; a point a tolerance."""
    see = "Down and left is better; a point a tolerance. Error: volume worn off in the wrong place, over all of it."
    with style.styled():
        figure = style.sheet("Wear to 1.6 million meshes: run time against error of the blocks", see)
        axes = figure.add_subplot()
        for name, colour in COLOURS.items():
            own = [row for row in rows if row.method == name]
            x, y = 100.0 * column(own, "error"), column(own, "seconds")
            axes.loglog(x, y, "o-", color=colour, label=name)
            for at in np.unique(x.round(2)):  # where stability makes blocks short, all tolerances are one point
                these = np.flatnonzero(x.round(2) == at)
                text = ", ".join(f"{own[k].tolerance:g}" for k in these)
                place = x[these[0]], y[these].max()
                axes.annotate(text, place, textcoords="offset points", xytext=(4, 6), fontsize=8)
        axes.set(xlabel="error of the depths [%]", ylabel="CPU time of the study [s]")
        axes.legend()
    return figure
