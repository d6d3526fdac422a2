"""Tables of rows of one dataclass: kept as CSV files, shown as Markdown."""

from __future__ import annotations

import csv
from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, fields
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Row = TypeVar("Row")
_READ: dict[str, Callable[[str], object]] = {"float": float, "int": int, "str": str}


@dataclass(frozen=True)
class Column:
    """A column of a Markdown table."""

    head: str
    """Its name and unit; "%" where `form` ends in one."""
    value: str | Callable[[Any], object]
    """A field of the row, or a function of the row."""
    form: str = ""
    """Format specification. The sign of a percentage is left out, for the head has it."""
    words: bool = False
    """Text, aligned to the left; numbers are aligned to the right."""

    def cell(self, row: object) -> str:
        """As text; empty for NaN, which stands for what was not measured."""
        value = getattr(row, self.value) if isinstance(self.value, str) else self.value(row)
        if isinstance(value, float) and isnan(value):
            return ""
        return format(value, self.form).removesuffix("%" if self.form.endswith("%") else "")


@dataclass(frozen=True)
class Table(Generic[Row]):
    """A table: a dataclass of numbers and texts for its rows, and the columns that a page shows."""

    row: type[Row]
    columns: tuple[Column, ...] = ()

    def read(self, path: Path) -> list[Row]:
        """The rows of a CSV file; none where there is no file."""
        return read_rows(path, self.row)

    def markdown(self, rows: Iterable[Row]) -> str:
        """As Markdown. A row with a `note` has it in place of its first missing value, and nothing behind it."""
        right = [index for index, column in enumerate(self.columns) if not column.words]
        return markdown([column.head for column in self.columns], [self._cells(row) for row in rows], right)

    def write(self, path: Path, rows: Iterable[Row]) -> None:
        """The same columns as a CSV file. Raises OSError."""
        write_csv(path, [column.head for column in self.columns], [self._cells(row) for row in rows])

    def _cells(self, row: Row) -> list[str]:
        cells = [column.cell(row) for column in self.columns]
        if note := getattr(row, "note", ""):
            first = cells.index("")
            cells[first:] = [note, *[""] * (len(cells) - first - 1)]
        return cells


def markdown(head: Sequence[str], rows: Sequence[Sequence[str]], right: Container[int] = ()) -> str:
    """A Markdown table. right: the columns of numbers. Raises ValueError for a row of another length."""
    for row in rows:
        if len(row) != len(head):
            raise ValueError(f"table: wanted rows of {len(head)} columns ({', '.join(head)}), found {list(row)}")
    rule = ["---:" if column in right else "---" for column in range(len(head))]
    return "\n".join(_line(row) for row in (head, rule, *rows))


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def write_csv(path: Path, head: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """A CSV file with a header. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


def read_csv(path: Path) -> list[dict[str, str]]:
    """The lines of a CSV file with a header, by its names. Raises OSError."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def write_rows(path: Path, rows: Sequence[DataclassInstance]) -> None:
    """Rows of one dataclass as a CSV file, numbers with six digits. Raises OSError."""
    names = [field.name for field in fields(rows[0])]
    write_csv(path, names, [[_shown(getattr(row, name)) for name in names] for row in rows])


def _shown(value: object) -> object:
    return f"{value:.6g}" if isinstance(value, float) else value


def read_rows(path: Path, kind: type[Row]) -> list[Row]:
    """The rows of a file that `write_rows` wrote; none where there is no file."""
    if not path.exists():
        return []
    readers = [(field.name, _READ[str(field.type)]) for field in fields(kind)]  # type: ignore[arg-type]
    return [kind(**{name: read(line[name]) for name, read in readers}) for line in read_csv(path)]
