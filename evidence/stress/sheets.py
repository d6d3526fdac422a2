"""A sheet of the matrix: what became of every combination of two settings, drawn as heat maps and written as CSV."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshError

REFUSALS = (NotConverged, SearchError, MeshError, NotPositiveDefinite)
LEAST_ERROR = 1e-16


@dataclass(frozen=True)
class Cell:
    """One combination solved: Newton iterations a position, relative error, or why it was refused."""

    iterations: float = float("nan")
    error: float = float("nan")
    refused: str = ""


@dataclass(frozen=True)
class Sheet:
    """rows × columns of cells. error: what is meant by it."""

    name: str
    title: str
    error: str
    row_label: str
    column_label: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    cells: tuple[tuple[Cell, ...], ...]

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
    except REFUSALS as error:
        return Cell(refused=f"{type(error).__name__}: {error}")


def sheet_of(
    names: tuple[str, str, str], rows: tuple[str, Sequence[str]], columns: tuple[str, Sequence[str]],
    solve: Callable[[int, int], Cell],
) -> Sheet:  # fmt: skip
    """All combinations. names: (name, title, meaning of the error); rows, columns: (what varies, its values);
    solve: the cell of a row and a column."""
    cells = tuple(
        tuple(attempt(lambda i=i, j=j: solve(i, j)) for j in range(len(columns[1])))  # type: ignore[misc]
        for i in range(len(rows[1]))
    )
    return Sheet(*names, rows[0], columns[0], tuple(rows[1]), tuple(columns[1]), cells)


def write_csv(sheet: Sheet, path: Path) -> None:
    """One line a cell. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow([sheet.row_label, sheet.column_label, "iterations", "error", "refused"])
        for row, cells in zip(sheet.rows, sheet.cells, strict=True):
            for column, cell in zip(sheet.columns, cells, strict=True):
                out.writerow([row, column, f"{cell.iterations:g}", f"{cell.error:.3g}", cell.refused])


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
