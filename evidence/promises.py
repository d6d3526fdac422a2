"""What Evolvent is to reach, and what was found: read from the tables of the benchmark and the stress tests."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from evidence.benchmark.bars import BarRow
from evidence.benchmark.gear_rows import GearRow
from evidence.benchmark.page import FROM, GEAR_BARS, TITLES, advantage, anew, unmatched
from evidence.benchmark.page_savings import SPUR_BAR
from evidence.benchmark.page_wear import BAR as WEAR_BAR
from evidence.benchmark.precision import Row
from evidence.benchmark.scaling import RatioRow
from evidence.benchmark.spur import SpurRow
from evidence.benchmark.tables import read_rows
from evidence.benchmark.wear import BLOCKS, WearCostRow
from evidence.report import table

GEAR_DOFS = 100_000
TERMS = """Errors are relative. p0 is the peak pressure. γ is the stabiliser of Nitsche's method, θ its variant, C the
least γ of theory (docs/design.md). *Over γ*: by how much a result moves with it, which it should not."""
HELD = 0.9  # share of the error bars that must hold


@dataclass(frozen=True)
class Promise:
    """bar, found: with their units, as they are to be read."""

    what: str
    bar: str
    found: str
    met: bool


@dataclass(frozen=True)
class Measured:
    """A line of a page's table: a figure and what it was held against. section: the heading above it. held: as that
    page says."""

    section: str
    quantity: str
    found: float
    wanted: float
    allowed: float
    held: bool

    @property
    def off(self) -> float:
        """Relative error; the figure itself where nothing is wanted but a small one."""
        return abs(self.found / self.wanted - 1.0) if self.wanted else abs(self.found)


def table_of(promises: Sequence[Promise]) -> str:
    """Markdown."""
    rows = [(p.what, p.bar, p.found, "met" if p.met else "**missed**") for p in promises]
    return table(("", "bar", "found", ""), rows, right=(1, 2))


def said(docs: Path) -> str:
    """The table, and what its terms mean."""
    words = [table_of(promises(docs)), *anew(read_rows(docs / "benchmark" / "gears.csv", GearRow)), TERMS]
    return "\n\n".join(words)


def promises(docs: Path) -> list[Promise]:
    """All of them, from the tables below `docs`. Raises OSError, ValueError where a table is not there."""
    return [*_speed(docs / "benchmark"), *_robust(docs)]


def _speed(tables: Path) -> Iterator[Promise]:
    for name, title in TITLES.items():
        least, bar = FROM[name]
        rows = read_rows(tables / f"{name}.csv", Row)
        peer, _, ratio = min(advantage(rows, least), key=lambda line: line[2])
        what = f"{title}, {least:,} dofs and more: seconds of the fastest other program ({peer.program}) over ours"
        yield _at_least(f"{what}, at no larger error", ratio, bar, better=not unmatched(rows, least))
    gears = read_rows(tables / "gears.csv", GearRow)
    for name, bar in GEAR_BARS.items():
        row = [r for r in gears if r.program == name and not r.note and r.dofs >= GEAR_DOFS][-1]
        yield _at_least(f"gear pair, {row.dofs:,} dofs: seconds a position of {name} over ours", row.ratio, bar)
    for ratio_row in read_rows(tables / "ratios.csv", RatioRow):
        what = f"{ratio_row.what}, {ratio_row.dofs:,} dofs"
        yield (_at_least if ratio_row.is_least else _at_most)(what, ratio_row.ratio, ratio_row.bar)
    spur = read_rows(tables / "spur.csv", SpurRow)
    least_ratio = min(row.volume_seconds / row.seconds for row in spur)
    yield _at_least("spur pair, seconds in 3D over 2D at equal error, least of three meshes", least_ratio, SPUR_BAR)
    for cost in read_rows(tables / "wear_cost.csv", WearCostRow):
        what = f"wear study of {BLOCKS} blocks over a sweep, {cost.case}"
        yield _at_most(f"{what}, preparing counted", cost.whole, WEAR_BAR)
        yield _at_most(f"{what}, preparing not counted", cost.bare, WEAR_BAR)


def _robust(docs: Path) -> Iterator[Promise]:
    bars = read_rows(docs / "benchmark" / "bars.csv", BarRow)
    inside = sum(row.inside for row in bars)
    yield Promise(
        "true error inside the error bar", f"{100 * HELD:.0f} %", f"{inside} of {len(bars)}", inside >= HELD * len(bars)
    )
    spaced = read_rows(docs / "benchmark" / "spacing.csv", BarRow)
    inside = sum(row.inside for row in spaced)
    yield Promise(
        "error of the spacing of positions inside its bar", f"{100 * HELD:.0f} %", f"{inside} of {len(spaced)}",
        inside >= HELD * len(spaced),
    )  # fmt: skip
    yield from _scenes(docs)
    free = measured(docs / "stress" / "independence.md")
    for what, start in (
        ("p0 over γ from 1.25 to 50 C, spur pair, `standard`", "p0 [MPa], spur pair, standard"),
        ("p0 over γ from 1.25 to 50 C, spur pair, `fine`", "p0 [MPa], spur pair, fine"),
        ("transmission error over γ, spur pair", "TE [mm], spur pair,"),
        ("wheel torque over γ, spur pair", "wheel torque [N], spur pair,"),
        ("p0 over θ, spur pair as two bodies", "p0 [MPa], spur pair as two bodies"),
        ("p0 over θ and γ, cylinder", "relative error of p0, cylinder"),
    ):
        rows = [m for m in free if m.quantity.startswith(start) and not math.isnan(m.found)]
        worst = max(m.off for m in rows)
        yield Promise(what, "0.5 %", f"{_percent(worst)}", all(m.held for m in rows))
    refused = {m.quantity.split(", ")[2] for m in free if math.isnan(m.found)}
    yield Promise("γ = 1.1 C, spur pair", "a result", f"refused, {' and '.join(sorted(refused))}", not refused)
    newton = max(m.found for m in free if m.quantity.startswith("Newton iterations"))
    yield _at_most("Newton iterations a position with friction, mean", newton, 8.0)
    (kills,) = measured(docs / "stress" / "faults.md")
    yield Promise("killed 20 times and resumed: largest difference", "1e-7", f"{kills.found:.0e}", kills.held)


def _scenes(docs: Path) -> Iterator[Promise]:
    verdicts = _column(docs / "stress" / "scenes.csv", "verdict")
    good = verdicts.count("converged")
    yield Promise("random scenes that converge, balanced", "all", f"{good} of {len(verdicts)}", good == len(verdicts))
    worn = _column(docs / "stress" / "wear.csv", "verdict")
    wrong = sum(verdict in ("wrong", "crashed", "hung") for verdict in worn)
    yield Promise("random wear studies that are wrong, crash or hang", "0", f"{wrong} of {len(worn)}", not wrong)


def measured(page: Path) -> list[Measured]:
    """The lines of all tables of a page that tell what was found and what was wanted. Raises OSError; ValueError where
    there is none."""
    found = []
    head: list[str] = []
    section = ""
    for line in page.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if line.startswith("## "):
            section = line.removeprefix("## ")
        if not cells:
            head = []
        elif not head:
            head = cells
        elif {"found", "wanted"} <= set(head) and not cells[0].startswith("---"):
            row = dict(zip(head, cells))
            wanted = row["wanted"].removeprefix("at least ")
            numbers = float(row["found"]), float(wanted), float(row.get("allowed") or row["tolerance"])
            found.append(Measured(section, row["quantity"], *numbers, held=row[""] == "holds"))
    if not found:
        raise ValueError(f"{page}: wanted a table with what was found and wanted, found none")
    return found


def _column(path: Path, name: str) -> list[str]:
    with open(path, newline="", encoding="utf-8") as file:
        return [row[name] for row in csv.DictReader(file)]


def _at_least(what: str, ratio: float, bar: float, better: bool = True) -> Promise:
    return Promise(what, f"at least {bar:g}", f"{ratio:.3g}", ratio >= bar and better)


def _at_most(what: str, ratio: float, bar: float) -> Promise:
    return Promise(what, f"at most {bar:g}", f"{ratio:.3g}", ratio <= bar)


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"
