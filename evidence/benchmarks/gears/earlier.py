"""`python -m evidence.benchmarks.gears.earlier CHECKOUT [--case NAME | --pitches] [--out DIR]`: whole runs and pitches
of an earlier commit beside those of this one, for docs/benchmark.md.

CHECKOUT holds the earlier commit, with an environment of its own (`make setup`). Each scene is run three times, one
after the other: by the earlier commit, by this one with an empty cache of condensed gears, and with the filled one;
each pitch twice, without a cache.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from math import nan
from pathlib import Path
from typing import Any

from evidence.benchmarks.gears.checkouts import Checkout
from evidence.benchmarks.gears.pitch import LEVELS, PitchFacts, read_facts
from evidence.benchmarks.gears.three_teeth import FRICTION
from evidence.benchmarks.gears.whole_runs import FULL, HELICAL, ONE, RANKS, YANG, RunCase
from evidence.checkout import DOCS
from evidence.processes import Cost, run_arguments
from evidence.scenes import QUIET
from evidence.tables import read_rows, write_rows

COMPILED = "mesh.elements_per_contact_width=0.5", "sweep.positions=2", ONE
"""Settings of a small run, after which the forms of all runs are compiled."""


@dataclass(frozen=True)
class EarlierCase:
    """A scene that both commits run, and what is wanted of this one."""

    run: RunCase
    least_ratio: float
    """Seconds of the earlier commit over those with an empty cache."""
    memory_bar_MB: float = nan
    """Memory of all ranks at once; NaN where there is no bar."""
    least_filled_ratio: float = nan
    """Seconds of the earlier commit over those with a filled cache; NaN where none is wanted."""


_, _, FINE, _, PICTURES, SLENDER_50, SLENDER_10 = FULL
CASES = (
    EarlierCase(RunCase(f"{YANG}, error bars", HELICAL, "standard", (*QUIET, ONE)), 3.0, 3e3, 5.7),
    EarlierCase(PICTURES, 4.5), EarlierCase(FINE, 3.0, 5e3), EarlierCase(SLENDER_50, 4.0, 4e3),
    EarlierCase(SLENDER_10, 5.0, 6e3),
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
    own_commit: str
    """This one."""
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
        """Ratio of the earlier commit's time to that with an empty cache."""
        return self.earlier_seconds / self.empty_seconds

    @property
    def filled_ratio(self) -> float:
        """Ratio of the earlier commit's time to that with a filled cache."""
        return self.earlier_seconds / self.filled_seconds

    @property
    def met(self) -> bool:
        """Whether both ratios and the memory are within their bars, where there are any."""
        slow = self.ratio < self.least_ratio or self.filled_ratio < self.least_filled_ratio
        return not (slow or max(self.empty_MB, self.filled_MB) > self.memory_bar_MB)


def rows(cases: tuple[EarlierCase, ...], checkout: Path, folder: Path) -> Iterator[EarlierRow]:
    """Runs each case three times. Raises RunFailed."""
    before, now = Checkout.earlier(checkout, folder / "before"), Checkout.this(folder / "now")
    for program, name in ((before, "before"), (now, "now")):
        _run(program, folder / f"{name}_compiled", CASES[0].run, *COMPILED)
    for number, case in enumerate(cases):
        now.forget_gears()
        earlier, first = _run(before, folder / f"{number}_before", case.run)
        empty, _ = _run(now, folder / f"{number}_empty", case.run)
        filled, last = _run(now, folder / f"{number}_filled", case.run)
        yield EarlierRow(
            case.run.name, case.run.level, len(last["frictions"]), before.commit, now.commit, earlier.wall,
            earlier.memory_MB, empty.wall, empty.memory_MB, filled.wall, filled.memory_MB, _peak_to_peak(last),
            _peak_to_peak(first) - _peak_to_peak(last), case.least_ratio, case.memory_bar_MB, case.least_filled_ratio,
        )


def _run(program: Checkout, out: Path, case: RunCase, *settings: str) -> tuple[Cost, dict[str, Any]]:
    """What a run took, and its summary. Raises RunFailed."""
    words = run_arguments(case.scene, out, (f"mesh.level={case.level}", *case.settings, *settings))
    cost = program.run(out.with_suffix(".log"), "evolvent", "run", *words, ranks=RANKS)
    return cost, json.loads((out / "summary.json").read_text(encoding="utf-8"))


def _peak_to_peak(summary: dict[str, Any]) -> float:
    return float(summary["frictions"][0]["transmission_error_peak_to_peak_um"])


@dataclass(frozen=True)
class EarlierPitchRow:
    """A pitch of Yang's pair on flanks in levels on one rank, by both commits."""

    elements: float
    """Across the contact width 2b."""
    positions: int
    commit: str
    """The earlier one."""
    own_commit: str
    """This one."""
    earlier_seconds: float
    """Wall time of all but meshing [s], as below."""
    earlier_MB: float
    earlier_error: float
    """Relative, of the mean transmission error, against that of the overkill pitch, as below."""
    seconds: float
    memory_MB: float
    error: float


ELEMENTS, OVERKILL, POSITIONS = (0.8, 1.2, 1.7, 3.75), 1.9, 20
"""Elements across 2b in levels, and those of one mesh with which errors are measured."""


def pitch_rows(elements: tuple[float, ...], checkout: Path, folder: Path) -> Iterator[EarlierPitchRow]:
    """Each pitch by both commits. Raises RunFailed."""
    before, now = Checkout.earlier(checkout, folder / "before"), Checkout.this(folder / "now")
    for program in (before, now):
        _pitch(program, folder, elements[0], 2, LEVELS)  # compiles the forms
    known = _pitch(now, folder, OVERKILL, POSITIONS)[1].mean_error
    for n in elements:
        (cost, facts), (own, found) = (_pitch(program, folder, n, POSITIONS, LEVELS) for program in (before, now))
        yield EarlierPitchRow(
            n, found.counted, before.commit, now.commit, facts.without_meshing, cost.memory_MB,
            facts.mean_error / known - 1.0, found.without_meshing, own.memory_MB, found.mean_error / known - 1.0,
        )


def _pitch(
    program: Checkout, folder: Path, elements: float, positions: int, *settings: str
) -> tuple[Cost, PitchFacts]:
    """What a pitch took, without a cache of condensed gears."""
    out = folder / "pitch.json"
    words = out, elements, "quick", positions, FRICTION, *settings
    cost = program.run(folder / "pitch.log", "evidence.benchmarks.gears.pitch", *words, ranks=1)
    return cost, read_facts(out)


def main() -> None:
    """Measures all cases, or those whose names hold some words, or the pitches; other rows of the table stay."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--case", default="", help="cases alone whose names and levels hold these words")
    parser.add_argument("--pitches", action="store_true", help="pitches on one rank in place of whole runs")
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    wanted = tuple(case for case in CASES if given.case in f"{case.run.name}, {case.run.level}")
    measure = partial(pitch_rows, ELEMENTS) if given.pitches else partial(rows, wanted)
    path = given.out / "benchmark" / f"earlier{'_pitches' if given.pitches else ''}.csv"
    kept: Sequence[EarlierRow | EarlierPitchRow]
    kept = read_rows(path, EarlierPitchRow) if given.pitches else read_rows(path, EarlierRow)
    measured = {_key(row): row for row in kept}
    with tempfile.TemporaryDirectory() as folder:
        for row in measure(given.checkout.resolve(), Path(folder)):
            measured[_key(row)] = row
            print(row, flush=True)
            write_rows(path, list(measured.values()))


def _key(row: EarlierRow | EarlierPitchRow) -> tuple[object, ...]:
    return (row.case, row.level) if isinstance(row, EarlierRow) else (row.elements,)


if __name__ == "__main__":
    main()
