"""Bars against true errors of transient contact, from tables that are made up."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evidence.benchmarks.accuracy.transient_bars import (
    COLUMNS,
    FIGURES,
    KEPT,
    RESONANCE,
    HitRow,
    hit_rows,
    inside,
    said,
)
from evidence.tables import write_csv, write_rows
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
    assert inside(rows) == "13 of 18"


def test_what_is_said(tmp_path: Path) -> None:
    """Figures, values of columns, and forces at the resonance are counted apart; without a table there is an error that
    names the command."""
    with pytest.raises(ValueError, match="transient_bars --out DIR"):
        said(tmp_path)
    row = HitRow("", 100.0, 0.0, "dynamic_factor", 1, 1, 0.1, 0.1)
    rows = [row, replace(row, figure="transient.csv: mesh_force_N", inside=3, count=4)]
    rows.append(replace(rows[1], speed=RESONANCE, inside=1))
    write_rows(tmp_path / KEPT, rows)
    text = said(tmp_path)
    assert "of 1 of 1 figures" in text and "of 4 of 8 values" in text and "resonance, 1 of 4:" in text


def test_a_bar_that_is_not_known_holds_nothing(tmp_path: Path) -> None:
    """NaN beside a value that both have."""
    tried = made(tmp_path / "tried", PLACES, np.zeros(4), float("nan"))
    rows = list(hit_rows("", tried, made(tmp_path / "best", PLACES, np.zeros(4), float("nan"))))
    assert {row.inside for row in rows} == {0}
