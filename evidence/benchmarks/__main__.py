"""`python -m evidence.benchmarks [PART] [--peers] [--small] [--out DIR]`: measures, writes the page docs/benchmark.md.

PART: hertz2d, hertz3d, gears, pitches, ratios, sizes, profile, skips, spur, bars, excitation-bars, root-bars, spacing,
wear, dynamics, transient, level-sizes, two-level, beside, runs, all (the default), or page, which measures nothing.
Tables are kept in docs/benchmark/, figures in docs/pictures/benchmark/.
--small takes sizes that show that everything works; give it another --out.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evidence.benchmarks.accuracy import error_bars, excitation_bars, root_bars, spacing, two_level
from evidence.benchmarks.comparison import work_precision
from evidence.benchmarks.comparison.programs import PEERS, Program
from evidence.benchmarks.gears import (
    pitch_precision,
    plane_and_solid,
    position_cost,
    profile,
    scaling,
    skips,
    wear,
    whole_runs,
)
from evidence.benchmarks.motion import transient, vibration
from evidence.benchmarks.pages.page import write_page
from evidence.checkout import DOCS
from evidence.tables import write_rows

WITHOUT_GEARS = ("Kratos",)  # its mortar contact with friction does not converge there
Tables = Iterator[tuple[str, Iterable[Any]]]
"""Names of CSV files, and their rows, which are measured one by one."""


@dataclass(frozen=True)
class Measurement:
    """How to measure; each part gives its tables."""

    small: bool
    """Sizes that show that everything works."""
    peers: tuple[Program, ...]
    folder: Path
    """For what processes write."""

    def size(self, module: Any) -> Any:
        """A module's SMALL or FULL."""
        return module.SMALL if self.small else module.FULL

    def round_contact(self, name: str) -> Tables:
        case = self.size(work_precision)[name]
        reference, known = work_precision.overkill(case, self.folder)
        yield f"{name}_overkill", [known]
        yield name, work_precision.rows(case, self.peers, reference, known, self.folder)

    def gears(self) -> Tables:
        peers = [program for program in self.peers if program.name not in WITHOUT_GEARS]
        yield "gears", position_cost.rows(peers, self.size(position_cost), self.folder)

    def profile(self) -> Tables:
        for name, case in self.size(profile).items():
            yield name, profile.rows(case, self.folder)

    def bars(self) -> Tables:
        yield "bars", (row for problem in self.bar_problems() for row in error_bars.measure_bars(problem))

    def excitation_bars(self) -> Tables:
        rows = (row for problem in self.bar_problems() for row in excitation_bars.measure_bars(problem))
        yield "excitation_bars", rows

    def root_bars(self) -> Tables:
        problems = root_bars.problems(self.small)
        yield "root_bars", (row for problem in problems for row in root_bars.measure_bars(problem))

    def bar_problems(self) -> list[error_bars.BarProblem]:
        if self.small:
            return [error_bars.spur_problem((1.2, 1.7), 6, (0.0, 0.1))]
        return [error_bars.spur_problem(), error_bars.helical_problem()]

    def spacing(self) -> Tables:
        pairs = list(spacing.problems())[: 1 if self.small else None]
        counts, many = self.size(spacing)
        yield "spacing", (row for pair in pairs for row in spacing.measure_spacing(pair, counts, many))

    def wear(self) -> Tables:
        yield "wear_cost", wear.cost_rows(wear.SMALL_CASES if self.small else wear.CASES)
        yield "wear", wear.precision_rows(*((wear.SMALL_CASES[0], wear.TOLERANCES[:2]) if self.small else ()))


def _table(name: str, rows: Callable[[Measurement], Iterable[Any]]) -> Callable[[Measurement], Tables]:
    """A part with a single table."""
    return lambda given: iter([(name, rows(given))])


PARTS: Mapping[str, Callable[[Measurement], Tables]] = {
    "hertz2d": lambda given: given.round_contact("hertz2d"),
    "hertz3d": lambda given: given.round_contact("hertz3d"),
    "gears": Measurement.gears,
    "pitches": _table("pitches", lambda given: pitch_precision.rows(given.size(pitch_precision), given.folder)),
    "ratios": _table("ratios", lambda given: scaling.ratio_rows(given.size(scaling), given.folder)),
    "sizes": _table("sizes", lambda given: scaling.size_rows(given.size(scaling), given.folder)),
    "profile": Measurement.profile,
    "skips": _table("skips", lambda given: skips.rows(skips.CASES[:1] if given.small else skips.CASES)),
    "spur": _table("spur", lambda given: plane_and_solid.rows()),
    "bars": Measurement.bars,
    "excitation-bars": Measurement.excitation_bars,
    "root-bars": Measurement.root_bars,
    "spacing": Measurement.spacing,
    "wear": Measurement.wear,
    "dynamics": _table("dynamics", lambda given: vibration.rows(given.size(vibration))),
    "transient": _table("transient", lambda given: transient.rows(given.size(transient))),
    "level-sizes": _table("level_sizes", lambda given: scaling.level_rows(given.size(scaling), given.folder)),
    "two-level": _table("two_level", lambda given: two_level.rows(given.size(two_level))),
    "beside": _table("beside", lambda given: whole_runs.beside_rows(whole_runs.BESIDE, given.folder)),
    "runs": _table("runs", lambda given: whole_runs.rows(given.size(whole_runs), given.folder)),
}


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", nargs="?", default="all", choices=(*PARTS, "page", "all"))
    parser.add_argument("--peers", action="store_true", help="with the other programs, where installed")
    parser.add_argument("--small", action="store_true", help="small sizes, to see that everything works")
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    peers = tuple(p for p in PEERS if p.available()) if given.peers else ()
    for part in PARTS if given.part == "all" else {given.part} - {"page"}:
        with tempfile.TemporaryDirectory() as folder:
            for name, rows in PARTS[part](Measurement(given.small, peers, Path(folder))):
                _kept(given.out / "benchmark" / f"{name}.csv", rows)
    write_page(given.out, measured=given.part != "page")


def _kept(path: Path, rows: Iterable[Any]) -> None:
    """Writes after every row: a run that is ended has what it measured."""
    measured = []
    for row in rows:
        measured.append(row)
        print(row, flush=True)
        write_rows(path, measured)


if __name__ == "__main__":
    main()
