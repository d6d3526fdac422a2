"""A sheet of the matrix: every combination of two settings solved, drawn as heat maps and written as CSV."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import nan
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from evidence.tables import write_csv
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError

LEAST_ERROR = 1e-16


@dataclass(frozen=True)
class Cell:
    """One combination, solved or refused."""

    iterations: float = nan
    """Of Newton's method, a position."""
    error: float = nan
    """Relative."""
    refused: str = ""
    """Why."""


@dataclass(frozen=True)
class Sheet:
    """Two settings and the cells of all their combinations."""

    name: str
    title: str
    error: str
    """What the cells' error is."""
    row_label: str
    column_label: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    cells: tuple[tuple[Cell, ...], ...]
    """By row, then column."""

    def values(self, field: str) -> Floats:
        """(rows, columns) of the cells' iterations or errors."""
        return np.array([[getattr(cell, field) for cell in row] for row in self.cells])

    @property
    def refused(self) -> list[tuple[str, str, str]]:
        """(row, column, message) of what was refused."""
        return [
            (row, column, cell.refused)
            for row, cells in zip(self.rows, self.cells, strict=True)
            for column, cell in zip(self.columns, cells, strict=True)
            if cell.refused
        ]


def attempt(solve: Callable[[], Cell]) -> Cell:
    """The cell, or the refusal that a user would be told. Anything else that is raised is a crash, and is."""
    try:
        return solve()
    except EvolventError as error:
        return Cell(refused=f"{type(error).__name__}: {error}")


def sheet_of(
    names: tuple[str, str, str], rows: tuple[str, Sequence[object]], columns: tuple[str, Sequence[object]],
    solve: Callable[[int, int], Cell],
) -> Sheet:
    """All combinations.

    names: name, title, meaning of the error.
    rows, columns: what varies, and its values.
    solve: the cell of a row and a column.
    """
    cells = tuple(
        tuple(attempt(partial(solve, i, j)) for j in range(len(columns[1])))
        for i in range(len(rows[1]))
    )
    return Sheet(*names, rows[0], columns[0], _texts(rows[1]), _texts(columns[1]), cells)


def _texts(values: Sequence[object]) -> tuple[str, ...]:
    return tuple(f"{value:g}" if isinstance(value, float) else str(value) for value in values)


def write_sheet(sheet: Sheet, path: Path) -> None:
    """A CSV file, one line a cell. Raises OSError."""
    head = [sheet.row_label, sheet.column_label, "iterations", "error", "refused"]
    write_csv(path, head, [
        [row, column, f"{cell.iterations:g}", f"{cell.error:.3g}", cell.refused]
        for row, cells in zip(sheet.rows, sheet.cells, strict=True)
        for column, cell in zip(sheet.columns, cells, strict=True)
    ])


def draw(sheet: Sheet) -> Figure:
    """Iterations on the left, errors on the right; what was refused is hatched."""
    width = 3.2 + 0.62 * len(sheet.columns)
    figure = Figure(figsize=(2 * width, 1.9 + 0.42 * len(sheet.rows)), layout="constrained")
    figure.suptitle(sheet.title, fontsize=11)
    left, right = figure.subplots(1, 2)
    iterations, errors = sheet.values("iterations"), np.maximum(sheet.values("error"), LEAST_ERROR)
    most = max(10.0, float(np.nanmax(iterations, initial=10.0)))
    _map(left, sheet, iterations, Normalize(0.0, most), "{:.0f}", "Newton iterations a position")
    low, high = np.nanmin(errors, initial=1e-3), np.nanmax(errors, initial=1e-2)
    _map(right, sheet, errors, LogNorm(min(low, 1e-3), max(high, 1e-2)), "{:.1e}", sheet.error)
    return figure


def _map(axis: Axes, sheet: Sheet, values: Floats, norm: Normalize, pattern: str, title: str) -> None:
    axis.set_facecolor("0.92")
    axis.imshow(values, cmap="YlOrRd", norm=norm, aspect="auto")
    for (i, j), value in np.ndenumerate(values):
        text = "refused" if np.isnan(value) else pattern.format(value)
        dark = not np.isnan(value) and norm(value) > 0.65
        axis.text(j, i, text, ha="center", va="center", fontsize=7, color="white" if dark else "0.1")
    axis.set_xticks(range(len(sheet.columns)), sheet.columns, fontsize=8)
    if max(map(len, sheet.columns)) > 6:  # words would run into one another
        axis.tick_params(axis="x", labelrotation=35.0)
        for label in axis.get_xticklabels():
            label.set_horizontalalignment("right")
    axis.set_yticks(range(len(sheet.rows)), sheet.rows, fontsize=8)
    axis.set(xlabel=sheet.column_label, ylabel=sheet.row_label)
    axis.set_title(title, fontsize=9)
