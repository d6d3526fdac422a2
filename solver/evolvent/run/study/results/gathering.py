"""Figures that a study gathers: a value of a table that each scene leaves in its folder."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean
from typing import Any

from evolvent.results.tables.table import csv_rows
from evolvent_meshes.text_files import UnreadableText, read_text

ERROR = "_error"
"""End of the name of a column with the estimated error of a figure."""
STATISTICS: Mapping[str, Callable[[Sequence[float]], float]] = {
    "max": max, "min": min, "mean": fmean, "last": lambda values: values[-1],
    "peak_to_peak": lambda values: max(values) - min(values),
}
"""Name of a statistic -> function that reduces the values of several rows to one."""
ONLY = "only"
MEGABYTES = 200
"""Size of the largest table that is read [MB]."""
Row = Mapping[str, Any]


@dataclass(frozen=True)
class Figure:
    """A figure of a study: its column, and the file, rows and column that it is read from."""

    name: str
    """Name of the column in the study's table."""
    file: str
    """CSV or JSON file in a scene's folder."""
    column: str
    """Column of the CSV file, or key of the JSON file; dotted where it lies deeper."""
    rows: str = ""
    """Key of the list in a JSON file whose entries are the rows; empty: the file itself is this list or the only
    row."""
    where: Mapping[str, str | int | float] = field(default_factory=dict)
    """Column -> value, by which the rows are selected."""
    statistic: str = ONLY
    """Key of `STATISTICS` for several rows; "only": there is one row."""
    error: str = ""
    """Column of the estimated error; empty where there is none."""


class Gathering:
    """The tables of one scene, each read once. folder: of the scene."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._tables: dict[tuple[str, str], list[Row]] = {}

    def columns(self, figures: Sequence[Figure]) -> dict[str, float]:
        """Column of the study's table -> value, NaN where there is none. A scene with several friction coefficients has
        a column for each."""
        found: dict[str, float] = {}
        for figure in figures:
            groups = self._by_friction(figure)
            for friction, rows in groups.items():
                behind = f" (μ = {friction})" if len(groups) > 1 else ""
                found[figure.name + behind] = _value(rows, figure.column, figure.statistic)
                if figure.error:
                    found[f"{figure.name}{ERROR}{behind}"] = _value(rows, figure.error, figure.statistic)
        return found

    def has_rows(self, figure: Figure) -> bool:
        """Whether the figure's table can be read."""
        return bool(self._rows(figure.file, figure.rows))

    def why_missing(self, figure: Figure) -> str:
        """Reason why a figure has no value here; empty where the computation leaves its cell empty."""
        read = self._rows(figure.file, figure.rows)
        rows = [row for group in self._by_friction(figure).values() for row in group]
        if not read:
            return f"{figure.file} is not there, or has no {f'list {figure.rows!r}' if figure.rows else 'rows'}"
        if not rows:
            wanted = ", ".join(f"{name} = {value!r}" for name, value in figure.where.items())
            return f"no row of {figure.file} has {wanted}"
        if not any(_has(row, figure.column) for row in rows):
            return f"{figure.file} has no {figure.column!r}"
        if figure.statistic == ONLY and len(_numbers(rows, figure.column)) > 1:
            return f"{figure.file} has several rows of it: name one by where, or take a statistic of them"
        return ""

    def _by_friction(self, figure: Figure) -> dict[str, list[Row]]:
        """Rows of a figure in groups, one for each friction coefficient; at least one group."""
        groups: dict[str, list[Row]] = {}
        for row in self._rows(figure.file, figure.rows):
            if all(_same(_deep(row, name), value) for name, value in figure.where.items()):
                groups.setdefault(_friction(row), []).append(row)
        return groups or {"": []}

    def _rows(self, file: str, rows: str) -> list[Row]:
        if (file, rows) not in self._tables:
            self._tables[file, rows] = list(_read(self._folder, file, rows))
        return self._tables[file, rows]


def _read(folder: Path, name: str, rows: str) -> list[Row]:
    """Rows of a table; none where it cannot be read, or lies behind a link elsewhere."""
    path = folder / name
    try:
        if not path.resolve().is_relative_to(folder.resolve()):
            return []
        text = read_text(path, "table", MEGABYTES)
        if path.suffix == ".csv":
            return list[Row](csv_rows(text))
        content = json.loads(text)
    except (UnreadableText, OSError, ValueError, csv.Error, RecursionError):
        return []
    listed = _deep(content, rows) if rows else content if isinstance(content, list) else [content]
    return [row for row in listed if isinstance(row, Mapping)] if isinstance(listed, list) else []


def _deep(row: Any, dotted: str) -> Any:
    """Value of a dotted key in a row; None where it is missing."""
    if isinstance(row, Mapping) and dotted in row:
        return row[dotted]
    for part in dotted.split("."):
        row = row.get(part) if isinstance(row, Mapping) else None
    return row


def _has(row: Row, dotted: str) -> bool:
    """Whether a row has a dotted key, with or without a value."""
    *parents, last = dotted.split(".")
    inner = _deep(row, ".".join(parents)) if parents else row
    return dotted in row or (isinstance(inner, Mapping) and last in inner)


def _friction(row: Row) -> str:
    """The friction coefficient of a row as text; empty where it has none."""
    number = _number(row.get("friction"))
    return "" if math.isnan(number) else f"{number:g}"


def _same(found: Any, wanted: str | int | float) -> bool:
    if isinstance(wanted, str):
        return str(found) == wanted
    return math.isclose(_number(found), wanted, rel_tol=1e-8, abs_tol=1e-12)


def _number(value: Any) -> float:
    """A value as a number; NaN where it is no finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan
    return number if math.isfinite(number) else math.nan


def _numbers(rows: Sequence[Row], column: str) -> list[float]:
    """Numbers (k,) of a column, of the rows that have one."""
    return [number for row in rows if not math.isnan(number := _number(_deep(row, column)))]


def _value(rows: Sequence[Row], column: str, statistic: str) -> float:
    """Value of a column over the rows; NaN where no row has a number, or several have where only one is wanted."""
    numbers = _numbers(rows, column)
    if not numbers or (statistic == ONLY and len(numbers) > 1):
        return math.nan
    return numbers[0] if statistic == ONLY else STATISTICS[statistic](numbers)
