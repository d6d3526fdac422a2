"""The tables of `evolvent transient`, read again from its folder."""

from __future__ import annotations

import csv
import json
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from evolvent.dynamics.results.transient.beginning import TRANSIENT_START, StartRow
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS, TransientFacts
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH, TransientRow, TransientToothRow
from evolvent.results.archive.store import ArchiveError

PICTURE, START_PICTURE, SCENE = "transient.png", "transient_start.png", "transient.toml"
T = TypeVar("T", TransientRow, TransientToothRow, StartRow, TransientFacts)


@dataclass(frozen=True)
class KeptTables:
    """Of all cases."""

    title: str
    """Of the scene."""
    rows: Sequence[TransientRow]
    """Over the mesh period."""
    teeth: Sequence[TransientToothRow]
    """Over the engagement of a tooth."""
    facts: Sequence[TransientFacts]
    """Of each case."""
    started: Sequence[StartRow] = ()
    """Over time, of motions from rest."""

    @staticmethod
    def read(folder: Path) -> KeptTables:
        """From OUT. Raises ArchiveError for a table that is missing, cut off or of another version."""
        start = folder / TRANSIENT_START
        return KeptTables(
            _title(folder / SCENE), _table(folder / TRANSIENT, TransientRow),
            _table(folder / TRANSIENT_TEETH, TransientToothRow), _facts(folder / TRANSIENT_FACTS),
            _table(start, StartRow) if start.exists() else (),
        )


def _title(path: Path) -> str:
    try:
        return str(tomllib.loads(path.read_text(encoding="utf-8"))["title"])
    except (OSError, ValueError, KeyError) as error:
        raise _unreadable(path, str(error)) from error


def _table(path: Path, kind: type[T]) -> list[T]:
    """A row a line; all columns are numbers."""
    try:
        with open(path, encoding="utf-8", newline="") as stream:
            lines = [{name: float(value) for name, value in line.items()} for line in csv.DictReader(stream)]
    except (OSError, ValueError, TypeError) as error:
        raise _unreadable(path, str(error)) from error
    return _made(path, lines, kind)


def _facts(path: Path) -> list[TransientFacts]:
    """null is a number that is not known."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
        known = [{key: float("nan") if value is None else value for key, value in entry.items()} for entry in entries]
    except (OSError, ValueError, AttributeError, TypeError) as error:
        raise _unreadable(path, str(error)) from error
    return _made(path, known, TransientFacts)


def _made(path: Path, entries: Sequence[dict[str, Any]], kind: type[T]) -> list[T]:
    wanted = [each.name for each in fields(kind)]
    if not entries or any(list(entry) != wanted for entry in entries):
        raise _unreadable(path, f"wanted lines with {', '.join(wanted)}")
    return [kind(**entry) for entry in entries]


def _unreadable(path: Path, why: str) -> ArchiveError:
    return ArchiveError(
        f"{path}: not a file of this version of Evolvent ({why}); `evolvent transient SCENE --out {path.parent} "
        "--overwrite` writes it anew"
    )
