"""Data for the pictures of a study: its axes, and the figures of each scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from evolvent.results.drawing.labels import UNITS, ending, label
from evolvent.run.study.results.gathering import ERROR
from evolvent.run.study.results.study_table import DONE, TableRow, written
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class DrawnAxis:
    """Axis of a picture: a parameter, or several that take their values together, of which the first names it."""

    keys: tuple[str, ...]
    """Keys of the scene."""
    values: tuple[Any, ...]
    """The different values of the first key, numbers ascending."""

    @property
    def label(self) -> str:
        """Name of the axis in words."""
        others = f", {label(self.keys[1], unit=False)}" if len(self.keys) == 2 else ", ..." if self.keys[2:] else ""
        return label(self.keys[0]) + others

    @property
    def is_numeric(self) -> bool:
        """Whether its values are numbers; else they are drawn side by side."""
        return all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in self.values)

    @property
    def places(self) -> Floats:
        """(n,) coordinates at which the values are drawn."""
        return np.array(self.values if self.is_numeric else range(len(self.values)), dtype=float)

    @property
    def texts(self) -> list[str]:
        """Values of the axis as text; a minus is U+2212."""
        shown = [f"{value:.4g}" if isinstance(value, float) else str(value) for value in self.values]
        return [text.replace("-", "−") for text in shown] if self.is_numeric else shown

    def said(self, number: int) -> str:
        """Value of the axis with this index, as part of a sentence: with its unit, or with its name where it has none.
        """
        unit = UNITS.get(ending(self.keys[0]), "")
        text = self.texts[number]
        return f"{text}{'' if unit == '°' else ' '}{unit}" if unit else f"{label(self.keys[0])} {text}"


@dataclass(frozen=True)
class StudyValues:
    """Table of a study for pictures."""

    title: str
    """Title of the study."""
    keys: Sequence[tuple[str, ...]]
    """Keys of each axis."""
    rows: Sequence[TableRow]
    """Rows of the study's table, one for each scene."""
    columns: Sequence[str]
    """Names of the figures and of their error bars."""
    is_sampled: bool = False
    """Whether the scenes are samples, and not all combinations of the axes' values."""

    @cached_property
    def axes(self) -> list[DrawnAxis]:
        """Axes of the parameters; each key of a Latin hypercube is one."""
        return [DrawnAxis(keys, _ascending([row.parameters[keys[0]] for row in self.rows])) for keys in self.keys]

    @property
    def figures(self) -> list[str]:
        """Names of the columns that are no error bars."""
        bars = {_error_name(name) for name in self.columns}
        return [name for name in self.columns if name not in bars]

    @property
    def done(self) -> int:
        """Number of scenes that are done."""
        return sum(row.status == DONE for row in self.rows)

    def has(self, name: str) -> bool:
        """Whether some scene has the figure."""
        return bool(np.isfinite(self.of(name)).any())

    def of(self, name: str) -> Floats:
        """(n,) a column over the scenes; NaN where a scene has none."""
        return np.array([row.figures.get(name, np.nan) for row in self.rows], dtype=float)

    def errors(self, name: str) -> Floats:
        """(n,) the error bars of a figure."""
        return self.of(_error_name(name))

    def points(self, axis: int) -> Ints:
        """(n,) index of the value of an axis that each scene has."""
        known = {repr(written(value)): number for number, value in enumerate(self.axes[axis].values)}
        first = self.axes[axis].keys[0]
        return np.array([known[repr(written(row.parameters[first]))] for row in self.rows])

    @property
    def foot(self) -> list[str]:
        """A footnote where scenes are missing."""
        missing = len(self.rows) - self.done
        return [f"{missing} of {len(self.rows)} scenes are not done: study.csv says why."] if missing else []


def bare_name(name: str) -> str:
    """Name of a figure without the friction coefficient in brackets."""
    return name.partition(" (")[0]


def figure_label(name: str, unit: bool = True) -> str:
    """Name of a figure in words, with the friction coefficient in brackets. unit: with its unit."""
    figure, space, friction = name.partition(" (")
    return label(figure, unit) + space + friction


def _error_name(name: str) -> str:
    """Column of the error bar of a figure."""
    figure, space, friction = name.partition(" (")
    return f"{figure}{ERROR}{space}{friction}"


def _ascending(values: Sequence[Any]) -> tuple[Any, ...]:
    """Distinct values: numbers ascending, others in their order."""
    once = tuple({repr(written(value)): value for value in values}.values())
    numeric = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in once)
    return tuple(sorted(once)) if numeric else tuple(written(value) for value in once)
