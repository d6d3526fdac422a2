"""An earlier commit beside this one: the order of the runs, what the cache holds before each, and the verdict."""

from __future__ import annotations

import json
import subprocess
from dataclasses import asdict, replace
from math import nan
from pathlib import Path

import pytest

from evidence.benchmarks.gears.checkouts import Checkout
from evidence.benchmarks.gears.earlier import CASES, EarlierRow, pitch_rows, rows
from evidence.benchmarks.gears.pitch import LEVELS, PitchFacts
from evidence.processes import Cost

ROW = EarlierRow("a", "standard", 1, "abc", "def", 300.0, 5e3, 100.0, 2.9e3, 50.0, 1e3, 2.0, 0.0, 3.0, 3e3, 5.9)


@pytest.mark.parametrize(
    ("row", "met"),
    [
        (ROW, True),
        (replace(ROW, empty_seconds=101.0), False),
        (replace(ROW, filled_seconds=51.0), False),
        (replace(ROW, empty_MB=3.1e3), False),
        (replace(ROW, filled_MB=3.1e3), False),
        (replace(ROW, filled_seconds=99.0, filled_MB=9e3, least_filled_ratio=nan, memory_bar_MB=nan), True),
    ],
)
def test_bars(row: EarlierRow, met: bool) -> None:
    """300 s over 100 s and 50 s are ratios of 3 and 6; bars of nan are none."""
    assert row.met is met


def test_each_scene_is_run_before_on_an_empty_cache_and_on_a_filled_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first run of this commit keeps an entry, which is there in its second run and gone before the next scene;
    compiled forms stay. Transmission errors of 2.5 µm before and 2 µm now are 0.5 µm apart."""
    found: list[tuple[str, int, int]] = []
    checkout = tmp_path / "checkout"

    def run(self: Checkout, log: Path, *words: object, ranks: int) -> Cost:
        entries, forms, out = self.cache / "evolvent" / "condensed", self.cache / "fenics", log.with_suffix("")
        for folder in (entries, forms, out):
            folder.mkdir(parents=True, exist_ok=True)
        found.append((out.name, len(list(entries.iterdir())), len(list(forms.iterdir()))))
        (entries / "entry").touch()
        (forms / "form").touch()
        error = 2.5 if self.root == checkout else 2.0
        told = {"frictions": [{"transmission_error_peak_to_peak_um": error}]}
        (out / "summary.json").write_text(json.dumps(told))
        return Cost(1.0, 1.0, 10.0)

    monkeypatch.setattr(Checkout, "commit", "abc")
    monkeypatch.setattr(Checkout, "run", run)
    measured = list(rows(CASES[:2], checkout, tmp_path))
    assert found[2:] == [
        ("0_before", 1, 1), ("0_empty", 0, 1), ("0_filled", 1, 1),
        ("1_before", 1, 1), ("1_empty", 0, 1), ("1_filled", 1, 1),
    ]
    assert [row.peak_to_peak_off_um for row in measured] == [0.5, 0.5]


def test_pitches_are_measured_against_one_mesh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Mean transmission errors of 10 µm on one mesh, 11 µm before and 9 µm now are off by a tenth."""
    checkout = tmp_path / "checkout"

    def run(self: Checkout, log: Path, module: str, out: Path, *words: object, ranks: int) -> Cost:
        error = 10.0 if LEVELS not in words else 11.0 if self.root == checkout else 9.0
        facts = PitchFacts(10, 1, 1.0, 50.0, 2.0, 3.0, (4.0, 5.0), 2, (3, 3), (error, error), 100.0, 20.0)
        out.write_text(json.dumps(asdict(facts)))
        return Cost(1.0, 1.0, 10.0)

    monkeypatch.setattr(Checkout, "commit", "abc")
    monkeypatch.setattr(Checkout, "run", run)
    (row,) = pitch_rows((0.8,), checkout, tmp_path)
    assert [row.earlier_error, row.error] == pytest.approx([0.1, -0.1])
    assert row.earlier_seconds == row.seconds == 15.0


def test_commit_of_a_checkout(tmp_path: Path) -> None:
    """The abbreviated name that git gives it."""
    author = "-c", "user.name=a", "-c", "user.email=b"
    for words in (("init", "-q"), (*author, "commit", "-q", "--allow-empty", "-m", "c")):
        subprocess.run(("git", *words), cwd=tmp_path, check=True)
    head = subprocess.run(("git", "rev-parse", "HEAD"), cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    name = Checkout.earlier(tmp_path, tmp_path).commit
    assert len(name) >= 4 and head.startswith(name)
