"""Tables on disk: rows come back as they were written; what cannot be read is said with its remedy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import pytest

from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.table import Record, SceneValue, Table


@dataclass(frozen=True)
class Part:
    """What both rows have."""

    size: float
    """A size."""


@dataclass(frozen=True)
class Line(Part):
    """A row of numbers and texts."""

    name: str
    """A name."""
    count: int
    """A count."""
    known: bool
    """A truth."""


@dataclass(frozen=True)
class Facts:
    """A row that only JSON can hold."""

    parts: tuple[Part, ...]
    """Rows in a row."""
    errors: tuple[float, ...]
    """Numbers."""
    share: float | None
    """A number, or none."""


LINES = [Line(1.5, "=text", 3, True), Line(math.nan, "'quoted", -1, False), Line(-math.inf, "a, b", 0, True)]
ROWS = Table("rows.csv", Line)
FACTS = Facts((Part(1.0 / 3.0), Part(math.nan)), (math.nan, 2.0), None)


@pytest.mark.parametrize("name", ["rows.csv", "rows.json"])
def test_rows_are_read_as_they_were_written(tmp_path: Path, name: str) -> None:
    """Texts that a spreadsheet would compute, truths, whole numbers, NaN; of JSON files infinity becomes NaN. The
    fields of the class itself come before those that it inherits."""
    table = Table(name, Line)
    table.write(RunFolder(tmp_path), LINES)
    found = table.read(tmp_path)
    assert [row.name for row in found] == [row.name for row in LINES]
    assert [(row.count, row.known) for row in found] == [(3, True), (-1, False), (0, True)]
    assert found[0].size == 1.5 and math.isnan(found[1].size)
    assert found[2].size == -math.inf if name.endswith("csv") else math.isnan(found[2].size)
    assert table.columns == list(table.described()) == ["name", "count", "known", "size"]
    if name.endswith("csv"):
        assert (tmp_path / name).read_text().splitlines()[:2] == ["name,count,known,size", "'=text,3,True,1.5"]


def test_an_object_is_read_as_it_was_written(tmp_path: Path) -> None:
    """Rows in it, numbers to their last digit, null for NaN and for what there is none of."""
    record = Record("facts.json", Facts)
    record.write(RunFolder(tmp_path), FACTS)
    found = record.read(tmp_path)
    assert found.parts[0] == FACTS.parts[0] and math.isnan(found.parts[1].size)
    assert math.isnan(found.errors[0]) and found.errors[1] == 2.0 and found.share is None


def test_no_rows_are_no_file(tmp_path: Path) -> None:
    """A table without rows is not there."""
    ROWS.write(RunFolder(tmp_path), [])
    assert not (tmp_path / "rows.csv").exists()


@pytest.mark.parametrize(("text", "found"), [
    (None, "No such file"),
    ("", "no rows"),
    ("name,count,known,size\n", "no rows"),
    ("name,count,known\nx,1,True\n", "the column or key 'size'"),
    ("name,count,known,size\nx,1,True,1.5\nx,1,Tr\n", "fewer cells"),
    ("name,count,known,size\nx,1,True,1.5,2\n", "more"),
    ("name,count,known,size\nx,1,True,wide\n", "wide"),
    ("name,count,known,size\nx,1.5,True,1\n", "1.5"),
    ("name,count,known,size\nx,1,yes,1\n", "yes"),
    (b"name,count,known,size\n\xff,1,True,1\n", "UTF-8"),
])
def test_what_is_no_table_is_said(tmp_path: Path, text: str | bytes | None, found: str) -> None:
    """A file that is missing, empty, cut off or of another form: file, what is wrong, remedy."""
    if text is not None:
        (tmp_path / "rows.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ArchiveError, match="--overwrite") as error:
        ROWS.read(tmp_path)
    assert "rows.csv: wanted" in str(error.value) and found in str(error.value)


@pytest.mark.parametrize("text", ["[1", "[1]", '{"parts": 1, "errors": [], "share": 1}', '{"parts": []}', "[" * 5000])
def test_what_is_no_object_is_said(tmp_path: Path, text: str) -> None:
    """JSON that is cut off, of another form, or nested without end."""
    (tmp_path / "facts.json").write_text(text)
    with pytest.raises(ArchiveError, match=r"facts\.json: wanted .* --overwrite"):
        Record("facts.json", Facts).read(tmp_path)


def test_a_value_of_a_scene(tmp_path: Path) -> None:
    """Value of a section's key; None where there is none; an error where the file is no TOML."""
    (tmp_path / "scene.toml").write_text('title = "a pair"\n[dynamics]\nstiffness = 2.0\n')
    keys = "title", "dynamics.stiffness", "title.part", "x"
    assert [SceneValue("scene.toml", key).read(tmp_path) for key in keys] == ["a pair", 2.0, None, None]
    (tmp_path / "scene.toml").write_text("title = ")
    with pytest.raises(ArchiveError, match=r"scene\.toml: wanted a scene"):
        SceneValue("scene.toml", "title").read(tmp_path)
