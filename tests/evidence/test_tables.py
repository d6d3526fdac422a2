"""Tables as Markdown and as CSV files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from evidence.tables import Column, Table, markdown, read_rows, write_rows


@dataclass(frozen=True)
class Run:
    """A row."""

    program: str
    order: int
    seconds: float = float("nan")
    error: float = float("nan")
    note: str = ""


RUNS = Table(
    Run,
    (
        Column("program", "program", words=True),
        Column("order", "order"),
        Column("s", "seconds", ".3g"),
        Column("error %", "error", "+.1%"),
        Column("faster", lambda run: run.seconds < 2.0),
    ),
)


def test_markdown_table() -> None:
    """Markdown of one row; a bar inside a cell is escaped; a row that is too short is refused."""
    assert markdown(("a", "b"), [("|x|", "1")], right=(1,)) == "| a | b |\n| --- | ---: |\n| \\|x\\| | 1 |"
    with pytest.raises(ValueError, match="rows of 2 columns"):
        markdown(("a", "b"), [("1",)])


def test_table_shows_rows_by_its_columns() -> None:
    """A percentage without its sign; a value that is not there is empty; a note takes its place, nothing follows it."""
    rows = [Run("a", 1, 1.2345, 0.01), Run("b", 2, 3.0), Run("c", 2, note="killed")]
    assert RUNS.markdown(rows).splitlines() == [
        "| program | order | s | error % | faster |",
        "| --- | ---: | ---: | ---: | ---: |",
        "| a | 1 | 1.23 | +1.0 | True |",
        "| b | 2 | 3 |  | False |",
        "| c | 2 | killed |  |  |",
    ]


def test_rows_survive_their_file(tmp_path: Path) -> None:
    """Six digits of every number, a comma in a text, and NaN; no rows where there is no file."""
    rows = [Run("a, b", 1, 1.23456789, 0.5), Run("c", 2)]
    write_rows(tmp_path / "below" / "runs.csv", rows)
    first, second = read_rows(tmp_path / "below" / "runs.csv", Run)
    assert first == Run("a, b", 1, 1.23457, 0.5)
    assert (second.program, str(second.seconds)) == ("c", "nan")
    assert RUNS.read(tmp_path / "none.csv") == []
