"""A section of docs/benchmark.md: a measured table, its figure, and what is said of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic

from matplotlib.figure import Figure

from evidence.report import picture
from evidence.tables import Row, Table

PICTURES = "pictures/benchmark"


def nothing(_: object) -> list[str]:
    """No paragraphs."""
    return []


@dataclass(frozen=True)
class PageSection(Generic[Row]):
    """A section; left out where nothing of its table was measured."""

    title: str
    """Its heading; without one it belongs to the section above it."""
    name: str
    """Of its table (NAME.csv) and of its picture (NAME.png)."""
    table: Table[Row]
    before: Callable[[Path], list[str]] = nothing
    """Paragraphs above the figure, from the folder of tables."""
    figure: Callable[[Sequence[Row]], Figure] | None = None
    caption: str = ""
    """Of the figure."""
    words: Callable[[Sequence[Row]], list[str]] = nothing
    """Paragraphs above the table."""
    after: Callable[[Sequence[Row]], list[str]] = nothing
    """Paragraphs below it."""

    def rows(self, tables: Path) -> list[Row]:
        """What was measured; none where nothing came out of it."""
        rows = self.table.read(tables / f"{self.name}.csv")
        return rows if any(not getattr(row, "note", "") for row in rows) else []

    def parts(self, tables: Path) -> list[str]:
        """Its paragraphs, from the folder of tables."""
        if not (rows := self.rows(tables)):
            return []
        head = [f"## {self.title}"] if self.title else []
        shown = [f"![{self.caption}]({PICTURES}/{self.name}.png)"] if self.figure else []
        whole = [self.table.markdown(rows)] if self.table.columns else []
        return [*head, *self.before(tables), *shown, *self.words(rows), *whole, *self.after(rows)]

    def draw(self, tables: Path, pictures: Path) -> None:
        """Writes its figure, if it has one. Raises OSError."""
        if self.figure and (rows := self.rows(tables)):
            picture(self.figure(rows), pictures / f"{self.name}.png")


def verdict(met: bool) -> str:
    """Whether a bar is met, in words."""
    return "met" if met else "MISSED"
