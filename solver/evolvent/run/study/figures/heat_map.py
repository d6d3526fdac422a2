"""A figure of a study over its two parameters."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.labels import heading, label
from evolvent.results.drawing.style import FAINT, INK, PRESSURE_MAP, foot, sheet
from evolvent.run.study.figures.study_values import StudyValues, bare_name, figure_label
from evolvent_meshes.arrays import Floats

MOST_NUMBERS = 150
"""Largest number of cells into which their values are written."""
DARK = 0.55
"""Part of the colour scale from which numbers are white."""
MOST_TICKS = 20
SIZES = (5, 12.0), (10, 9.5)
"""Most cells in a row, and the size of the numbers in them, on a slide as large as the labels of the axes."""
LEAST_PART = 0.01
"""Smallest value over the largest one for which all are written with the same decimals."""


def map_figure(values: StudyValues, name: str) -> Figure:
    """Figure with an equally large cell for each scene that shows its value; cells of scenes without one are hatched.
    """
    grid, (first, second) = grid_of(values, name), values.axes
    figure = sheet(heading(figure_label(name)), f"{values.title}. {_range(values, grid)}", (9.6, 6.6))
    axes = figure.subplots()
    axes.grid(visible=False)
    axes.set_facecolor("#f4f4f4")
    norm = Normalize(float(np.nanmin(grid)), float(np.nanmax(grid)))
    drawn = axes.pcolormesh(np.ma.masked_invalid(grid), cmap=PRESSURE_MAP, norm=norm, edgecolors="white", linewidth=0.6)
    for j, i in np.argwhere(~np.isfinite(grid)):
        axes.fill([i, i + 1, i + 1, i], [j, j, j + 1, j + 1], facecolor="none", edgecolor=FAINT, hatch="///", lw=0.0)
    if grid.size <= MOST_NUMBERS:
        _numbers(axes, grid, norm)
    for ticks, texts in ((axes.set_xticks, first.texts), (axes.set_yticks, second.texts)):
        step = -(-len(texts) // MOST_TICKS)
        ticks(np.arange(len(texts))[::step] + 0.5, texts[::step])
    axes.set_xlabel(first.label)
    axes.set_ylabel(second.label)
    figure.colorbar(drawn, ax=axes, pad=0.015, label=label(bare_name(name)))
    foot(figure, *values.foot)
    return figure


def grid_of(values: StudyValues, name: str) -> Floats:
    """(n, m) a figure over the second and the first axis; NaN where a scene has none."""
    first, second = values.axes
    grid = np.full((len(second.values), len(first.values)), np.nan)
    grid[values.points(1), values.points(0)] = values.of(name)
    return grid


def cell_texts(grid: Floats) -> list[list[str]]:
    """(n, m) texts of the values, with as many decimals as give the largest one three digits; empty where there is
    none. Where the smallest values have no digit left, all have three digits."""
    known = np.abs(grid[np.isfinite(grid)])
    form = ".3g"
    if np.all(known == np.round(known)):
        form = ".0f"
    elif known.min() >= LEAST_PART * known.max():
        form = f".{max(0, 2 - math.floor(math.log10(known.max())))}f"
    return [[f"{value:{form}}".replace("-", "−") if np.isfinite(value) else "" for value in row] for row in grid]


def _numbers(axes: Axes, grid: Floats, norm: Normalize) -> None:
    """Writes the values into their cells."""
    size = next((size for most, size in SIZES if grid.shape[1] <= most), 7.0)
    for (j, i), text in np.ndenumerate(cell_texts(grid)):
        if text:
            colour = "white" if norm(grid[j, i]) > DARK else INK
            axes.text(i + 0.5, j + 0.5, text, ha="center", va="center", fontsize=size, color=colour)


def _range(values: StudyValues, grid: Floats) -> str:
    """Sentence on the smallest and largest value of the figure, and at which parameters."""
    said, texts = [], cell_texts(grid)
    for word, place in (("least", np.nanargmin(grid)), ("largest", np.nanargmax(grid))):
        j, i = np.unravel_index(int(place), grid.shape)
        first, second = values.axes
        said.append(f"{word} {texts[j][i]} at {first.said(int(i))} and {second.said(int(j))}")
    return f"{heading(said[0])}, {said[1]}."
