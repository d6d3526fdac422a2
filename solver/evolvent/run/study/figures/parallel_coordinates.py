"""Scenes of a study over more than two parameters: a line a scene through its parameters and figures."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.style import FAINT, FRICTION_MAP, INK, foot, sheet
from evolvent.run.study.figures.study_values import StudyValues, figure_label
from evolvent_meshes.arrays import Floats

MOST_FIGURES = 5
"""Largest number of figures beside the parameters."""
MOST_TICKS = 8
WIDTH = 20
"""Largest number of characters in a line of a label."""


def parallel_figure(values: StudyValues, names: Sequence[str]) -> Figure:
    """Figure of parallel axes, each from its lowest value to its highest; lines are coloured by the first figure."""
    shown = list(names[:MOST_FIGURES])
    heads = [*(axis.label for axis in values.axes), *(figure_label(name) for name in shown)]
    columns = [axis.places[values.points(k)] for k, axis in enumerate(values.axes)]
    columns += [values.of(name) for name in shown]
    complete = np.isfinite(np.array(columns)).all(axis=0)
    figure = sheet(values.title, f"{int(complete.sum())} scenes, coloured by {figure_label(shown[0])}.",
                   (max(9.6, 1.7 * len(heads)), 5.8))
    axes = figure.subplots()
    axes.grid(visible=False)
    places = np.arange(len(columns), dtype=float)
    scaled = np.array([_scaled(column, column[complete]) for column in columns])[:, complete]
    colour = values.of(shown[0])[complete]
    order = np.argsort(colour)
    norm = Normalize(float(colour.min()), float(colour.max()))
    lines = LineCollection(
        [np.column_stack([places, line]) for line in scaled.T[order]], array=colour[order], norm=norm,
        cmap=FRICTION_MAP.reversed(), linewidths=1.2, alpha=0.75,
    )
    axes.add_collection(lines)
    for k, column in enumerate(columns):
        _axis(axes, k, column[complete], values.axes[k].texts if k < len(values.axes) else None)
    axes.set_xlim(-0.3, len(columns) - 0.7)
    axes.set_ylim(-0.06, 1.06)
    axes.set_xticks(places, [fill(head, WIDTH) for head in heads], fontsize=8.5)
    axes.set_yticks([])
    for side in axes.spines.values():
        side.set_visible(False)
    figure.colorbar(lines, ax=axes, pad=0.015, label=figure_label(shown[0]))
    left = ", ".join(figure_label(name) for name in names[MOST_FIGURES:])
    foot(figure, *([f"Not drawn: {left}."] if left else []), *values.foot)
    return figure


def _scaled(column: Floats, known: Floats) -> Floats:
    """Values scaled from 0 at the lowest to 1 at the highest; a half where all are alike."""
    low, size = float(known.min()), float(np.ptp(known))
    return (column - low) / size if size > 0.0 else np.full(len(column), 0.5)


def _axis(axes: Axes, place: int, known: Floats, texts: Sequence[str] | None) -> None:
    """Draws an upright axis with some of its values. texts: of the different values, None for those of a figure."""
    axes.axvline(place, color=FAINT, lw=0.9, zorder=0.5)
    different = np.unique(known)
    if texts is not None and len(different) == len(texts) and len(texts) <= MOST_TICKS:
        ticks = list(zip(_scaled(different, known), texts))
    else:
        marks = np.linspace(float(known.min()), float(known.max()), 5 if len(different) > 1 else 1)
        ticks = [(float(at), f"{value:.4g}") for at, value in zip(_scaled(marks, known), marks)]
    for at, text in ticks:
        axes.text(place + 0.03, at, text, fontsize=7.5, color=INK, va="center",
                  bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.5})
