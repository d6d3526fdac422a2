"""Rows of the tables that a command writes, with all their digits, and columns of files that results write."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evolvent.commands.app import main
from evolvent.results.tables.table import Table


def tables_of(command: str, scene: Path, out: Path, *settings: str) -> dict[str, list[Any]]:
    """Name of each table that `evolvent COMMAND` writes -> its rows, before they are rounded to nine digits."""
    known: dict[str, list[Any]] = {}
    write = Table.write

    def recorded(table: Table[Any], folder: Any, rows: Iterable[Any]) -> None:
        known[table.name] = list(rows)
        write(table, folder, known[table.name])

    words = [word for setting in settings for word in ("--set", setting)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Table, "write", recorded)
        assert main([command, str(scene), "--out", str(out), "--quiet", *words]) == 0
    return known


def columns_of(path: Path) -> Any:
    """Columns of a CSV file by name, as plain NumPy reads them."""
    return np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")


def assert_same_rows(found: list[Any], wanted: list[Any], tolerance: float = 1e-9) -> None:
    """Fails unless rows of one dataclass are equal: numbers to `tolerance`, of each column's largest amount or of
    themselves, texts and truth values exactly. NaN is equal to NaN."""
    assert len(found) == len(wanted) > 0
    for name in (field.name for field in fields(wanted[0])):
        one, other = ([getattr(row, name) for row in rows] for rows in (found, wanted))
        if not isinstance(other[0], float):
            assert one == other, name
            continue
        size = float(np.nanmax(np.abs(other))) if np.isfinite(other).any() else 0.0
        np.testing.assert_allclose(one, other, rtol=tolerance, atol=tolerance * size, err_msg=name)
