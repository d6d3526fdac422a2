"""How well figures repeat: what is compared of two runs."""

from __future__ import annotations

import json
import math
from pathlib import Path

from evidence.robustness.repeats import differences, figures, is_bar


def run_folder(folder: Path, force: float) -> Path:
    """A folder as a command leaves it, with one figure in a table and one in a summary."""
    folder.mkdir()
    (folder / "teeth.csv").write_text(f"tooth,force_N,seconds\nleft,100.0,1.5\nright,{force!r},2.5\n")
    summary = {"frictions": [{"load": 8.0, "load_error": 0.5}, {"load": force, "load_error": 0.5}], "title": "pair",
               "teeth": 17}
    (folder / "summary.json").write_text(json.dumps(summary))
    return folder


def test_numbers_of_tables_and_summaries_are_figures(tmp_path: Path) -> None:
    """A column and a key of a list have all their values; words, whole numbers and the clock are no figures."""
    assert figures(run_folder(tmp_path / "one", 50.0)) == {
        "teeth.csv: force_N": [100.0, 50.0], "summary.json: frictions.load": [8.0, 50.0],
        "summary.json: frictions.load_error": [0.5, 0.5],
    }


def test_difference_is_relative_to_the_largest_value(tmp_path: Path) -> None:
    """Forces of 50 and 51 N beside one of 100 N: a hundredth; loads of 50 and 51 beside 8: a fiftieth. A table with a
    row less cannot be compared."""
    one, other = (figures(run_folder(tmp_path / str(force), force)) for force in (50.0, 51.0))
    found = differences([one, other])
    assert found["teeth.csv: force_N"] == 0.01 and found["summary.json: frictions.load"] == 0.02
    assert found["summary.json: frictions.load_error"] == 0.0
    assert differences([one, {**other, "teeth.csv: force_N": [1.0]}])["teeth.csv: force_N"] == math.inf


def test_error_bars_are_told_from_transmission_errors() -> None:
    """Both have `error` in their names."""
    assert is_bar("summary.json: frictions.estimated_error.loss_percent")
    assert is_bar("a.csv: transmission_error_um_error") and not is_bar("a.csv: static_transmission_error_um")
