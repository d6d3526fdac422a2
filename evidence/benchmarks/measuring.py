"""Command line of a benchmark: the rows of its table, kept as soon as they are there."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from evidence.checkout import DOCS
from evidence.tables import write_rows

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def keep_rows(
    description: str | None, small: str, name: str, rows: Callable[[bool], Iterable[DataclassInstance]],
    folder: str = "line_contact",
) -> None:
    """Measures the rows of docs/FOLDER/NAME.csv. small: what the option --small measures, in words. rows: of the
    whole table, or of a small part where its argument is true."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--small", action="store_true", help=small)
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    kept: list[DataclassInstance] = []
    for row in rows(given.small):
        kept.append(row)
        print(row, flush=True)
        write_rows(given.out / folder / f"{name}.csv", kept)
