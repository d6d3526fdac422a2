"""python -m evidence.benchmark [hertz2d|hertz3d|gears|pitches|scaling|profile|skips|spur|bars|spacing|wear|page|all]
[--peers] [--small]

Writes docs/benchmark/*.csv, the figures in docs/pictures/benchmark/ and the page docs/benchmark.md. --small takes sizes
that show that everything works, into --out.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from evidence.benchmark import bars, gear_rows, page, pitches, precision, profile, scaling, skips, spacing, spur, wear
from evidence.benchmark.programs import PEERS, ROOT, Program
from evidence.benchmark.tables import write_rows

PARTS = ("hertz2d", "hertz3d", "gears", "pitches", "scaling", "profile", "skips", "spur", "bars", "spacing", "wear")
WITHOUT_GEARS = ("Kratos",)  # its mortar contact with friction does not converge there


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", nargs="?", default="all", choices=(*PARTS, "page", "all"))
    parser.add_argument("--peers", action="store_true", help="with the other programs, where installed")
    parser.add_argument("--small", action="store_true", help="small sizes, to see that everything works")
    parser.add_argument("--out", type=Path, default=ROOT / "docs")
    given = parser.parse_args()
    peers = tuple(p for p in PEERS if p.available()) if given.peers else ()
    for part in PARTS if given.part == "all" else (given.part,):
        if part in PARTS:
            with tempfile.TemporaryDirectory() as folder:
                _measure(part, peers, given.small, given.out / "benchmark", Path(folder))
    page.write_page(given.out)


def _measure(part: str, peers: tuple[Program, ...], small: bool, out: Path, folder: Path) -> None:
    if part == "gears":
        sizes = gear_rows.SMALL if small else gear_rows.FULL
        own = [p for p in peers if p.name not in WITHOUT_GEARS]
        _kept(out / "gears.csv", gear_rows.rows(own, sizes, folder))
    elif part == "scaling":
        lengths = scaling.SMALL if small else scaling.FULL
        _kept(out / "ratios.csv", scaling.ratio_rows(lengths, folder))
        _kept(out / "sizes.csv", scaling.size_rows(lengths, folder))
    elif part == "pitches":
        _kept(out / "pitches.csv", pitches.rows(pitches.SMALL if small else pitches.FULL, folder))
    elif part == "profile":
        length = (1.0, 4) if small else (profile.ELEMENTS, profile.POSITIONS)
        _kept(out / "profile.csv", profile.rows(folder, *length))
    elif part == "skips":
        _kept(out / "skips.csv", skips.rows(skips.CASES[:1] if small else skips.CASES))
    elif part == "spur":
        _kept(out / "spur.csv", spur.rows())
    elif part == "bars":
        full = bars.spur_problem(), bars.helical_problem()
        problems = (bars.spur_problem((1.2, 1.7), 6, (0.0, 0.1)),) if small else full
        _kept(out / "bars.csv", (row for problem in problems for row in bars.measure_bars(problem)))
    elif part == "spacing":
        pairs = list(spacing.problems())
        counts, many = ((6, 12), 24) if small else (spacing.COUNTS, spacing.MANY)
        pairs = pairs[:1] if small else pairs
        _kept(out / "spacing.csv", (row for pair in pairs for row in spacing.measure_spacing(pair, counts, many)))
    elif part == "wear":
        _kept(out / "wear_cost.csv", wear.cost_rows(wear.SMALL_CASES if small else wear.CASES))
        few = wear.SMALL_CASES[0], wear.TOLERANCES[:2]
        _kept(out / "wear.csv", wear.precision_rows(*few) if small else wear.precision_rows())
    else:
        case = _case(part, small)
        known = precision.overkill(case, folder)
        write_rows(out / f"{part}_overkill.csv", [known.row()])
        _kept(out / f"{part}.csv", precision.rows(case, peers, known, folder))


def _case(part: str, small: bool) -> precision.Case:
    if part == "hertz2d":
        return precision.SMALL_2D if small else precision.HERTZ_2D
    return precision.SMALL_3D if small else precision.HERTZ_3D


def _kept(path: Path, rows: Iterable[Any]) -> None:
    """Writes after every row: a run that is ended has what it measured."""
    found = []
    for row in rows:
        found.append(row)
        print(row, flush=True)
        write_rows(path, found)


if __name__ == "__main__":
    main()
