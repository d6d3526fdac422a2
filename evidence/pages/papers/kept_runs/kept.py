"""Figures of runs, kept as files of names and values, from which pages are written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from evidence.tables import read_rows, write_rows


@dataclass(frozen=True)
class NamedFigure:
    """A figure of a run; its name ends in its unit."""

    name: str
    value: float


Named = Iterator[tuple[str, float]]


def keep(path: Path, figures: Iterable[tuple[str, float]]) -> Path:
    """Writes (name, value) of each figure. Raises OSError."""
    write_rows(path, [NamedFigure(name, value) for name, value in figures])
    return path


def kept(path: Path, command: str) -> dict[str, float]:
    """What was kept. command: that keeps it. Raises ValueError where nothing was."""
    values = {row.name: row.value for row in read_rows(path, NamedFigure)}
    if not values:
        raise ValueError(f"{path.parent}: wanted {path.name}, found none; `{command}` writes it")
    return values
