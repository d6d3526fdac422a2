"""Tables of results on disk: rows of a dataclass, whose fields are the columns of a CSV or the keys of a JSON file."""

from __future__ import annotations

import csv
import io
import json
import math
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from pathlib import Path
from types import UnionType
from typing import Any, Generic, TypeVar, get_args, get_origin, get_type_hints

from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.field_texts import field_texts
from evolvent_meshes.text_files import UnreadableText, read_text

Row = TypeVar("Row")
MEGABYTES = 1000
"""Size of the largest file that is read [MB]."""
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r", "'")
"""Beginnings of cells that spreadsheets take for formulas, and the apostrophe that marks such a cell as text."""
TRUTHS = {True: True, False: False, "True": True, "False": False}
"""Truth value as in JSON, or cell of a CSV file -> truth value."""


@dataclass(frozen=True)
class Filled:
    """A file whose content is known and not written yet."""

    name: str
    """Name of the file."""
    write: Callable[[RunFolder], None]
    """Function that writes it into a folder. Raises WriteError, FolderError."""


@dataclass(frozen=True)
class Table(Generic[Row]):
    """A file of rows: a line each of a CSV file, or an entry each of a JSON list. The entries of a field that is a
    mapping are columns of the CSV file, by their keys."""

    name: str
    """Name of the file; its ending gives the format."""
    row: type[Row]
    """Dataclass of the rows."""

    def of(self, rows: Iterable[Row]) -> Filled:
        """The table with its rows, to be written."""
        return Filled(self.name, lambda folder: self.write(folder, rows))

    def write(self, folder: RunFolder, rows: Iterable[Row]) -> None:
        """Writes the file; none where there are no rows. Raises WriteError, FolderError."""
        lines = [asdict(row) for row in rows]  # type: ignore[call-overload]  # a dataclass
        if lines and self.name.endswith(".csv"):
            ordered = [{name: line[name] for name in self.columns} for line in lines]
            folder.write_text(self.name, csv_text([_spread(line) for line in ordered]))
        elif lines:
            folder.write_text(self.name, json_text(lines))

    def read(self, folder: Path) -> list[Row]:
        """The rows, numbers of CSV files to nine digits. Raises ArchiveError for a file that is missing, is cut off,
        lacks a column, or has a cell of another type."""
        return _read(folder / self.name, self.row)

    def described(self) -> dict[str, str]:
        """Column -> meaning."""
        return field_texts(self.row)

    @property
    def columns(self) -> list[str]:
        """The fields of the class itself, then those that it inherits."""
        own = get_type_hints(self.row)
        inherited = [field.name for base in self.row.__bases__ if is_dataclass(base) for field in fields(base)]
        return [*(name for name in own if name not in inherited), *inherited]


@dataclass(frozen=True)
class Record(Generic[Row]):
    """A JSON file of one object."""

    name: str
    """Name of the file."""
    row: type[Row]
    """Dataclass of the content."""

    def of(self, content: Row) -> Filled:
        """The file with its content, to be written."""
        return Filled(self.name, lambda folder: self.write(folder, content))

    def write(self, folder: RunFolder, content: Row) -> None:
        """Writes the file. Raises WriteError, FolderError."""
        folder.write_text(self.name, json_text(asdict(content)))  # type: ignore[call-overload]  # a dataclass

    def read(self, folder: Path) -> Row:
        """The object. Raises ArchiveError as `Table.read`."""
        return _read(folder / self.name, self.row)[0]

    def described(self) -> dict[str, str]:
        """Key -> meaning."""
        return field_texts(self.row)


@dataclass(frozen=True)
class SceneValue:
    """A value of a scene that lies beside the tables."""

    name: str
    """Name of the scene's file."""
    key: str
    """Dotted key of the scene."""

    def read(self, folder: Path) -> Any:
        """The value; None where the scene has none. Raises ArchiveError for a file that is no TOML."""
        path = folder / self.name
        try:
            value: Any = tomllib.loads(read_text(path, "TOML", MEGABYTES))
        except (UnreadableText, ValueError) as error:
            raise unusable(path, "a scene", str(error)) from error
        for part in self.key.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        return value


SCENE_TITLE = SceneValue("scene.toml", "title")
"""Title of the scene that was computed."""


def unusable(path: Path, wanted: str, found: str) -> ArchiveError:
    """The error of a file that cannot be used. wanted, found: phrases without a full stop."""
    return ArchiveError(
        f"{path}: wanted {wanted} of this version of Evolvent, found {found}; the command that wrote it writes it anew "
        "with --overwrite"
    )


def csv_text(rows: Sequence[Mapping[str, object]], columns: Sequence[str] = ()) -> str:
    """Text of a CSV file. rows: at least one, all with the same keys; columns: these keys in another order."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, fieldnames=columns or list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _cell(value) for key, value in row.items()} for row in rows)
    return stream.getvalue()


def csv_rows(text: str) -> list[dict[str, str]]:
    """The lines of a CSV file by its header, texts as they were before `csv_text` quoted them. Raises csv.Error;
    ValueError for a line of another length."""
    lines = list(csv.DictReader(io.StringIO(text, newline="")))
    if any(None in line or None in line.values() for line in lines):
        raise ValueError("a line with more or fewer cells than the header")
    return [{name: cell_text(cell) for name, cell in line.items()} for line in lines]


def json_text(value: object) -> str:
    """Text of a JSON file."""
    return json.dumps(without_nan(value), ensure_ascii=False, indent=1, allow_nan=False) + "\n"


def _spread(line: Mapping[str, object]) -> dict[str, object]:
    """A line with the entries of its mappings, each a cell by its key, in their place."""
    parts = (value if isinstance(value, Mapping) else {name: value} for name, value in line.items())
    return {name: value for part in parts for name, value in part.items()}


def _cell(value: object) -> object:
    """Text of a value in a cell: a number with nine digits, enough for reading and for comparing two runs; behind an
    apostrophe a text that a spreadsheet would compute, or that begins with an apostrophe itself."""
    if isinstance(value, float):
        return f"{value:.9g}"
    is_formula = isinstance(value, str) and value.startswith(FORMULA_STARTS) and not _is_number(value)
    return f"'{value}" if is_formula else value


def cell_text(cell: str) -> str:
    """The text of a cell that `csv_text` has written."""
    return cell[1:] if cell.startswith("'") and cell[1:].startswith(FORMULA_STARTS) else cell


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def without_nan(value: object) -> object:
    """The value with null in place of numbers that are not finite, which JSON does not have."""
    if isinstance(value, Mapping):
        return {str(key): without_nan(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _read(path: Path, kind: type[Row]) -> list[Row]:
    """Rows of a file, at least one. Raises ArchiveError."""
    try:
        text = read_text(path, path.suffix[1:].upper(), MEGABYTES)
        content = csv_rows(text) if path.suffix == ".csv" else json.loads(text)
        rows = _reader(tuple[kind, ...])(content if isinstance(content, list) else [content])  # type: ignore[valid-type]
    except KeyError as error:
        raise unusable(path, f"the column or key {error.args[0]!r}", "none of this name") from error
    except (UnreadableText, csv.Error, ValueError, TypeError, RecursionError) as error:
        raise unusable(path, "a table", str(error)) from error
    if not rows:
        raise unusable(path, "a table", "no rows")
    return list(rows)


def _reader(hint: Any) -> Callable[[Any], Any]:
    """Function that makes a field of this type of a CSV cell or of a JSON value. It raises KeyError for a missing
    column, ValueError and TypeError for a value of another type."""
    if is_dataclass(hint):
        readers = {name: _reader(each) for name, each in get_type_hints(hint).items()}
        spread = [name for name, each in get_type_hints(hint).items() if get_origin(each) is dict]

        def row(value: Any) -> Any:
            mappings = [name for name in spread if name not in value]
            others = {name: cell for name, cell in value.items() if name not in readers} if mappings else {}
            given = {**value, **dict.fromkeys(mappings, others)} if mappings else value
            return hint(**{name: read(given[name]) for name, read in readers.items()})  # type: ignore[operator]

        return row
    inner, origin = get_args(hint), get_origin(hint)
    if origin is tuple:
        each = _reader(inner[0])
        return lambda value: tuple(map(each, value))
    if origin is dict:
        item = _reader(inner[1])
        return lambda value: {name: item(each) for name, each in value.items()}
    if origin is UnionType:  # of a type and None
        known = _reader(inner[0])
        return lambda value: None if value is None else known(value)
    if hint is float:
        return lambda value: math.nan if value is None else float(value)
    return _truth if hint is bool else hint  # type: ignore[no-any-return]


def _truth(value: Any) -> bool:
    if value not in TRUTHS:
        raise ValueError(f"{value!r} instead of a truth value")
    return TRUTHS[value]
