"""Measured rows as CSV files, and back."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")
_READ: dict[str, Any] = {"float": float, "int": int, "str": str}


def write_rows(path: Path, rows: Sequence[Any]) -> None:
    """Rows of one dataclass of numbers and texts, with a header. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    names = [field.name for field in fields(rows[0])]
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([_shown(getattr(row, name)) for name in names] for row in rows)


def _shown(value: object) -> object:
    return f"{value:.6g}" if isinstance(value, float) else value


def read_rows(path: Path, kind: type[T]) -> list[T]:
    """The rows of a file that `write_rows` wrote; none where there is no file."""
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return [_made(kind, row) for row in csv.DictReader(file)]


def _made(kind: type[T], row: dict[str, str]) -> T:
    return kind(**{f.name: _READ[str(f.type)](row[f.name]) for f in fields(kind)})  # type: ignore[arg-type]
