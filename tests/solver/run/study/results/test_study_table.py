"""The table of a study."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.study.results.study_table import (
    PARQUET,
    TABLE,
    TableRow,
    figure_columns,
    parquet,
    warned_scenes,
    write_table,
)

ROWS = [
    TableRow({"load.torque_Nm": 1.0, "contact.friction": [0.0, 0.1]}, {"a": 2.0}, "done", "", "scenes/x", 3.0, 0),
    TableRow({"load.torque_Nm": 2.0, "contact.friction": [0.2]}, {"a": 4.0, "b": 5.0}, "done", "", "scenes/y", 3.0, 2),
    TableRow({"load.torque_Nm": -1.0, "contact.friction": [0.2]}, {}, "refused", "found -1, too little", "", None),
]


def test_rows_have_the_same_columns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures that only some scenes have are NaN elsewhere; lists stand as in TOML; without pandas and pyarrow there is
    no Parquet file."""
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    columns = figure_columns(ROWS, [])
    write_table(RunFolder(tmp_path), ROWS, columns)
    assert (tmp_path / TABLE).read_text().splitlines() == [
        "load.torque_Nm,contact.friction,a,b,status,reason,folder,seconds,warnings",
        '1,"[0.0, 0.1]",2,nan,done,,scenes/x,3,0',
        "2,[0.2],4,5,done,,scenes/y,3,2",
        '-1,[0.2],nan,nan,refused,"found -1, too little",,,',
    ]
    assert not (tmp_path / PARQUET).exists()


def test_scenes_with_warnings_are_counted() -> None:
    """One of the two scenes that are done has warnings: their count, and where to read them. None without."""
    (said,) = warned_scenes(ROWS)
    assert said.startswith("1 of 2 scenes have warnings") and "scenes/y/study_scene.json" in said
    assert warned_scenes([ROWS[0], ROWS[2]]) == []


def test_parquet(tmp_path: Path) -> None:
    """The same values, where pandas and pyarrow are installed."""
    pytest.importorskip("pyarrow")
    pandas = pytest.importorskip("pandas")
    path = tmp_path / PARQUET
    path.write_bytes(parquet([row.flat(["a", "b"]) for row in ROWS]))
    assert list(pandas.read_parquet(path)["load.torque_Nm"]) == [1.0, 2.0, -1.0]
