"""`python -m evidence.pages.papers.yang_picture`: the picture of docs/yang2022.md that compares with the paper.

It is drawn from the figures that `yang_figures` has kept of a run at level standard.
"""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.checkout import DOCS
from evidence.pages.papers.yang_estimate import PRINTED, estimates
from evidence.pages.papers.yang_figures import level_figures
from evolvent.results.drawing.style import INK, PINION, png, sheet, styled
from evolvent.results.figures.hertz import HERTZ, WHITE

PICTURE = "yang2022/beside_paper.png"
PRINTED_CHANGES = {"A": 595.7, "B": 11.65, "C": 758.35, "D": 1134.24}
"""Point -> change of the pressure from the lowest to the highest friction coefficient, Table 5 of the paper [MPa]."""
PAPER = "#b9bec7"


def beside_paper(docs: Path) -> Figure:
    """Figure of contact stresses at the pitch point and of changes with friction, in the paper and here."""
    kept = level_figures(docs, "standard")
    low, high = kept["low_friction"], kept["high_friction"]
    subtitle = f"Level standard; stresses at μ = {low:g}, changes from there to μ = {high:g}."
    figure = sheet("Yang et al. 2022 and Evolvent", subtitle, (11.4, 4.6))
    stresses, changes = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    _stresses(stresses, kept)
    _changes(changes, kept)
    return figure


def _stresses(axes: Axes, kept: dict[str, float]) -> None:
    """Bars of estimates and of computed pressures."""
    known = estimates()
    bars = (
        ("Eq. 4 with its load factors", known["eq_4_MPa"], PAPER),
        ("Eq. 4 without", known["eq_4_without_factors_MPa"], PAPER),
        ("Hertz, mean line length", known["hertz_mean_MPa"], HERTZ),
        ("Hertz, shortest line", known["hertz_shortest_MPa"], HERTZ),
        ("computed at B", kept["point_B_MPa"], PINION),
        ("computed, largest", kept["largest_MPa"], PINION),
    )
    places = range(len(bars))[::-1]
    axes.barh(places, [value for _, value, _ in bars], color=[colour for *_, colour in bars], height=0.6)
    for place, (_, value, _) in zip(places, bars):
        beside = {"xytext": (6, 0), "textcoords": "offset points", "bbox": WHITE}
        axes.annotate(f"{value:.0f}", (value, place), va="center", fontsize=9, **beside)
    axes.axvline(PRINTED, color=INK, linestyle="--", linewidth=1.0, label=f"{PRINTED:.0f} MPa, as the paper prints it")
    axes.set_yticks(places, [name for name, *_ in bars], fontsize=9)
    axes.set(xlabel="contact stress [MPa]", xlim=(0.0, 1.15 * max(value for _, value, _ in bars)))
    axes.grid(axis="y", visible=False)
    axes.legend(loc="center right")


def _changes(axes: Axes, kept: dict[str, float]) -> None:
    """Bars of the change with friction at the points A to D."""
    for shift, name, values, colour in (
        (-0.2, "paper, Table 5", list(PRINTED_CHANGES.values()), PAPER),
        (0.2, "computed", [kept[f"point_{point}_change_MPa"] for point in PRINTED_CHANGES], PINION),
    ):
        axes.bar([place + shift for place in range(len(values))], values, width=0.4, color=colour, label=name)
    axes.axhline(0.0, color=INK, linewidth=1.0)
    axes.set_xticks(range(len(PRINTED_CHANGES)), list(PRINTED_CHANGES))
    axes.set(xlabel="point of the paper's Fig. 11", ylabel="change of the pressure with friction [MPa]")
    axes.legend(loc="upper center")


if __name__ == "__main__":
    with styled():
        (DOCS / PICTURE).write_bytes(png(beside_paper(DOCS)))
