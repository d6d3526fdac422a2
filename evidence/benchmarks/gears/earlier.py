"""`python -m evidence.benchmarks.gears.earlier CHECKOUT [--case NAME] [--out DIR]`: whole runs of an earlier commit
beside those of this one, for docs/benchmark.md.

CHECKOUT holds the earlier commit, with an environment of its own (`make setup`). Each scene is run three times, one
after the other: by the earlier commit, by this one with an empty cache of condensed gears, and with the filled one.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

from evidence.benchmarks.gears.whole_runs import FIRST, HELICAL, LIGHT, ONE, RANKS, SLENDER, YANG
from evidence.checkout import DOCS, ROOT, python_path
from evidence.processes import Command, Cost, run, run_arguments
from evidence.scenes import PLAIN, QUIET
from evidence.tables import Column, Table, write_rows

TIME_LIMIT = 3600.0  # s
COMPILED = "mesh.elements_per_contact_width=0.5", "sweep.positions=2", ONE
"""Settings of a small run, after which the forms of all runs are compiled."""


@dataclass(frozen=True)
class EarlierCase:
    """A scene that both commits run, and what is wanted of this one."""

    name: str
    scene: str
    level: str
    settings: tuple[str, ...]
    least_ratio: float
    """Seconds of the earlier commit over those with an empty cache."""
    memory_bar_MB: float = nan
    """Of all ranks at once; NaN where there is none."""
    least_filled_ratio: float = nan
    """Seconds of the earlier commit over those with a filled cache; NaN where none is wanted."""


CASES = (
    EarlierCase(f"{YANG}, error bars", HELICAL, "standard", (*QUIET, ONE), 3.0, 3e3, 5.7),
    EarlierCase(f"{YANG}, error bars, pictures", HELICAL, "standard", (), 4.5),
    EarlierCase(f"{YANG}, plain", HELICAL, "fine", (*PLAIN, ONE), 3.0, 5e3),
    EarlierCase(f"{LIGHT}, 50 N·m, plain", FIRST, "standard", (*PLAIN, ONE, *SLENDER, "load.torque_Nm=50"), 4.0, 4e3),
    EarlierCase(f"{LIGHT}, 10 N·m, plain", FIRST, "standard", (*PLAIN, ONE, *SLENDER, "load.torque_Nm=10"), 5.0, 6e3),
)


@dataclass(frozen=True)
class EarlierRow:
    """What both commits took for a scene, and how far their results are apart."""

    case: str
    level: str
    frictions: int
    """Number of friction coefficients."""
    commit: str
    """The earlier one."""
    earlier_seconds: float
    """Wall time of the whole process, as of those below [s]."""
    earlier_MB: float
    """Memory of all ranks at once, as of those below; what they share counts once."""
    empty_seconds: float
    """With an empty cache of condensed gears."""
    empty_MB: float
    filled_seconds: float
    """With the filled cache."""
    filled_MB: float
    peak_to_peak_um: float
    """Transmission error at the first coefficient, of this commit."""
    peak_to_peak_off_um: float
    """The earlier commit's less this one's."""
    least_ratio: float
    memory_bar_MB: float
    least_filled_ratio: float

    @property
    def ratio(self) -> float:
        """Of the earlier commit's time to that with an empty cache."""
        return self.earlier_seconds / self.empty_seconds

    @property
    def filled_ratio(self) -> float:
        """Of the earlier commit's time to that with a filled cache."""
        return self.earlier_seconds / self.filled_seconds

    @property
    def met(self) -> bool:
        """Whether both ratios and the memory are within their bars, where there are any."""
        slow = self.ratio < self.least_ratio or self.filled_ratio < self.least_filled_ratio
        return not (slow or max(self.empty_MB, self.filled_MB) > self.memory_bar_MB)


TABLE = Table(EarlierRow, (
    Column("run", "case", words=True), Column("level", "level", words=True), Column("coefficients", "frictions"),
    Column("before s", "earlier_seconds", ".0f"), Column("MB", "earlier_MB", ".0f"),
    Column("now s", "empty_seconds", ".0f"), Column("MB", "empty_MB", ".0f"), Column("bar", "memory_bar_MB", ".0f"),
    Column("times", lambda row: f"**{row.ratio:.1f}**"), Column("bar", "least_ratio", "g"),
    Column("again s", "filled_seconds", ".0f"), Column("times", lambda row: f"**{row.filled_ratio:.1f}**"),
    Column("bar", "least_filled_ratio", "g"), Column("peak to peak µm", "peak_to_peak_um", ".3f"),
    Column("off µm", "peak_to_peak_off_um", "+.3f"),
    Column("", lambda row: "met" if row.met else "MISSED", words=True),
))


@dataclass(frozen=True)
class Program:
    """A checkout that runs scenes in a process of its own, as a user starts it."""

    root: Path
    python: Path
    cache: Path
    """Folder for compiled forms and condensed gears."""

    def run(self, out: Path, case: EarlierCase, *settings: str) -> tuple[Cost, dict[str, Any]]:
        """What a run took, and its summary. Raises RunFailed."""
        arguments = run_arguments(case.scene, out, (f"mesh.level={case.level}", *case.settings, *settings))
        variables = {"PYTHONPATH": python_path(self.root), "XDG_CACHE_HOME": str(self.cache), "EVOLVENT_CACHE_GB": "20"}
        words = (str(self.python), "-m", "evolvent", "run", *arguments)
        cost = run(Command(words, self.root, out.with_suffix(".log"), variables, RANKS, TIME_LIMIT))
        return cost, json.loads((out / "summary.json").read_text(encoding="utf-8"))

    @property
    def commit(self) -> str:
        """Its abbreviated name."""
        words = "git", "-C", str(self.root), "rev-parse", "--short", "HEAD"
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()


def rows(cases: tuple[EarlierCase, ...], checkout: Path, folder: Path) -> Iterator[EarlierRow]:
    """Runs each case three times. Raises RunFailed."""
    before = Program(checkout, checkout / ".venv/bin/python", folder / "before")
    now = Program(ROOT, Path(sys.executable), folder / "now")
    for program, name in ((before, "before"), (now, "now")):
        program.run(folder / f"{name}_compiled", CASES[0], *COMPILED)
    for number, case in enumerate(cases):
        forget(now.cache)
        earlier, own = before.run(folder / f"{number}_before", case)
        empty, _ = now.run(folder / f"{number}_empty", case)
        filled, last = now.run(folder / f"{number}_filled", case)
        yield EarlierRow(
            case.name, case.level, len(last["frictions"]), before.commit, earlier.wall, earlier.memory_MB, empty.wall,
            empty.memory_MB, filled.wall, filled.memory_MB, _peak_to_peak(last),
            _peak_to_peak(own) - _peak_to_peak(last), case.least_ratio, case.memory_bar_MB, case.least_filled_ratio,
        )


def forget(cache: Path) -> None:
    """Removes the condensed gears of a cache folder, not its compiled forms."""
    for entry in (cache / "evolvent" / "condensed").glob("*"):
        entry.unlink()


def _peak_to_peak(summary: dict[str, Any]) -> float:
    return float(summary["frictions"][0]["transmission_error_peak_to_peak_um"])


def main() -> None:
    """Measures all cases, or those whose names hold some words; the other rows of the table stay."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--case", default="", help="cases alone whose names and levels hold these words")
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    path = given.out / "benchmark" / "earlier.csv"
    wanted = tuple(case for case in CASES if given.case in f"{case.name}, {case.level}")
    measured = {(row.case, row.level): row for row in TABLE.read(path)}
    with tempfile.TemporaryDirectory() as folder:
        for row in rows(wanted, given.checkout.resolve(), Path(folder)):
            measured[row.case, row.level] = row
            print(row, flush=True)
            write_rows(path, list(measured.values()))


if __name__ == "__main__":
    main()
