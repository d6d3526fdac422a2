"""Tables of two folders, compared."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

LEFT_OUT = "seconds", "timings_s", "peak_memory_MB", "ranks", "newton_iterations", "stable"
"""Keys of values that say how a result was found, and of the stability of steady states, which at a fold, where it
changes, is one of rounding."""


def same_tables(one: Path, other: Path, relative: float = 1e-6) -> bool:
    """Whether both folders have the same tables, texts as they are and numbers but for the last digits: products of
    matrices round by where these lie in memory. relative: largest difference of numbers; those below 1e-7 count as
    zero."""
    names = [{path.name for pattern in ("*.csv", "*.json") for path in folder.glob(pattern)} for folder in (one, other)]
    return names[0] == names[1] and all(same_table(one / name, other / name, relative) for name in names[0])


def same_table(one: Path, other: Path, relative: float = 1e-6) -> bool:
    """Whether two CSV or JSON files are the same, as of `same_tables`."""
    return _same(values(one), values(other), relative)


def values(path: Path) -> dict[str, str | float]:
    """Cells of a table by their place; numbers that are not known as texts."""
    text = path.read_text(encoding="utf-8")
    content = list(csv.DictReader(text.splitlines())) if path.suffix == ".csv" else json.loads(text)
    return dict(_flat(content, ""))


def _flat(content: Any, place: str) -> Iterator[tuple[str, str | float]]:
    if isinstance(content, dict):
        for name, value in content.items():
            if name not in LEFT_OUT:
                yield from _flat(value, f"{place}/{name}")
    elif isinstance(content, list):
        for number, value in enumerate(content):
            yield from _flat(value, f"{place}/{number}")
    else:
        yield place, _number(content)


def _number(cell: Any) -> str | float:
    try:
        value = float(cell)
    except (TypeError, ValueError):
        return str(cell)
    return value if value == value else "nan"


def _same(one: dict[str, str | float], other: dict[str, str | float], relative: float) -> bool:
    return one.keys() == other.keys() and all(
        one[place] == other[place] if isinstance(one[place], str) or isinstance(other[place], str)
        else one[place] == pytest.approx(other[place], rel=relative, abs=1e-7) for place in one
    )
