"""Tables of `evolvent check` as text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple


class Row(NamedTuple):
    """A line of a table: name, symbol, unit, and one or two formatted values."""

    name: str
    symbol: str
    unit: str
    values: tuple[str, ...]


def table(title: str, rows: Iterable[Row], heads: tuple[str, ...] = ("",)) -> str:
    """A table with aligned columns: name, symbol, unit, values."""
    lines = [f"{title:<62}" + "".join(f"{head:>13}" for head in heads)]
    for row in rows:
        lines.append(f"  {row.name:<42}{row.symbol:<8}{row.unit:<10}" + "".join(f" {text:>12}" for text in row.values))
    return "\n".join(line.rstrip() for line in lines)
