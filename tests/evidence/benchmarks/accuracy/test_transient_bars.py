"""Bars against true errors of transient contact, from tables that are made up."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from evidence.benchmarks.accuracy.transient_bars import COLUMNS, FIGURES, hit_rows, total
from evidence.tables import write_csv
from evolvent_meshes.arrays import Floats

PLACES = np.arange(4.0)


def made(folder: Path, places: Floats, off: Floats, bar: float) -> Path:
    """All figures and values are 10, and off by so much."""
    folder.mkdir()
    fact = {"speed_rpm": 100.0, "separated": 0.25}
    for figure in FIGURES:
        fact |= {figure: 10.0 + off[0], f"{figure}_error": bar}
    (folder / "transient.json").write_text(json.dumps([fact]))
    for name, place, columns in COLUMNS:
        head = ["speed_rpm", place, *(each for column in columns for each in (column, f"{column}_error"))]
        lines = [[100.0, at, *[10.0 + error, bar] * len(columns)] for at, error in zip(places, off)]
        write_csv(folder / name, head, lines)
    return folder


def test_bars_are_held_against_the_same_places(tmp_path: Path) -> None:
    """Off by 0.1, 0.3, 0.1 and 0.3 with bars of 0.2, the last place not in the reference: figures are inside, of each
    column two of three values."""
    tried = made(tmp_path / "tried", PLACES, np.array([0.1, 0.3, 0.1, 0.3]), 0.2)
    best = made(tmp_path / "best", np.array([0.0, 0.5, 1.0, 2.0]), np.zeros(4), float("nan"))
    rows = list(hit_rows("", tried, best))
    assert [(row.inside, row.count) for row in rows] == [(1, 1)] * 3 + [(2, 3)] * 5
    assert {row.separated for row in rows} == {0.25}
    assert rows[-1].median_error == pytest.approx(0.1 / (10.0 + 0.5 / 3.0))
    assert total(rows) == "figures: 3 of 3 inside; values of columns: 10 of 15 inside"


def test_a_bar_that_is_not_known_holds_nothing(tmp_path: Path) -> None:
    """NaN beside a value that both have."""
    tried = made(tmp_path / "tried", PLACES, np.zeros(4), float("nan"))
    rows = list(hit_rows("", tried, made(tmp_path / "best", PLACES, np.zeros(4), float("nan"))))
    assert {row.inside for row in rows} == {0}
