"""Figures of a study over its one parameter."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from evolvent.results.drawing.labels import UNITS, ending
from evolvent.results.drawing.style import foot, sheet
from evolvent.run.study.figures.study_values import StudyValues, bare_name, figure_label

COLOURS = matplotlib.colormaps["tab10"]
MARKERS = "o", "s", "^", "D", "v", "P", "X", "*"


def curves_figure(values: StudyValues, names: Sequence[str]) -> Figure:
    """Figure with a line for each figure of the study, with error bars where they are known. names: figures of one
    unit."""
    axis, unit = values.axes[0], UNITS.get(ending(bare_name(names[0])), "")
    figure = sheet(values.title, _subtitle(values, names), (9.6, 5.4))
    axes, order = figure.subplots(), np.argsort(values.points(0), kind="stable")
    places = axis.places[values.points(0)][order]
    for number, name in enumerate(names):
        own, bars = values.of(name)[order], values.errors(name)[order]
        style = {"color": COLOURS(number % 10), "marker": MARKERS[number % len(MARKERS)], "markersize": 5.0}
        known = bars if np.isfinite(bars).any() else None
        words = figure_label(name, unit=not unit or len(names) == 1)
        axes.errorbar(places, own, known, capsize=3.0, label=words, **style)
    if not axis.is_numeric:
        axes.set_xticks(axis.places, axis.texts)
    axes.set_xlabel(axis.label)
    axes.set_ylabel(f"[{unit}]" if len(names) > 1 and unit else figure_label(names[0]))
    if len(names) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    has_bars = any(np.isfinite(values.errors(name)).any() for name in names)
    foot(figure, *(["Bars: estimated error."] if has_bars else []), *values.foot)
    return figure


def _subtitle(values: StudyValues, names: Sequence[str]) -> str:
    """Sentence on the smallest and largest value of the first figure."""
    axis, own = values.axes[0], values.of(names[0])
    known = np.flatnonzero(np.isfinite(own))
    low, high = known[np.argmin(own[known])], known[np.argmax(own[known])]
    texts = [axis.texts[point] for point in values.points(0)]
    said = f"{figure_label(names[0])} from {own[low]:.4g} at {texts[low]} to {own[high]:.4g} at {texts[high]}"
    return f"{said}. {values.done} scenes."
