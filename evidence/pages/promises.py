"""What Evolvent must reach, and what was found: from the tables of the benchmarks and of robustness."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import isnan
from pathlib import Path

from evidence.benchmarks.accuracy.error_bars import BarRow
from evidence.benchmarks.accuracy.two_level import AccuracyRow
from evidence.benchmarks.comparison.work_precision import Row
from evidence.benchmarks.gears.plane_and_solid import SpurRow
from evidence.benchmarks.gears.position_cost import GearRow
from evidence.benchmarks.gears.scaling import RatioRow
from evidence.benchmarks.gears.wear import BLOCKS, WearCostRow
from evidence.benchmarks.gears.whole_runs import RunRow
from evidence.benchmarks.pages.comparison import FROM, GEAR_BARS, TITLES, advantage, anew, large, unmatched
from evidence.benchmarks.pages.gear_pairs import SPUR_BAR, WEAR_BAR, least_ratio
from evidence.tables import Column, Table, read_csv, read_rows

TERMS = """Errors are relative. p0 is the peak pressure. γ is the stabiliser of Nitsche's method, θ its variant, C the
least γ of theory (docs/design.md). *Over γ*: by how much a result moves with it, which it should not."""
HELD = 0.9  # share of the error bars that must hold
OVER_PARAMETERS = (
    ("p0 over γ from 1.25 to 50 C, spur pair, `standard`", "p0 [MPa], spur pair, standard"),
    ("p0 over γ from 1.25 to 50 C, spur pair, `fine`", "p0 [MPa], spur pair, fine"),
    ("p0 over γ from 1.1 to 50 C, helical pair in levels, `standard`", "largest p0 [MPa], helical pair"),
    ("its mean over the slices", "mean p0 [MPa], helical pair"),
    ("transmission error over γ, helical pair in levels", "TE [mm], helical pair"),
    ("load sharing over γ, helical pair in levels", "load share, helical pair"),
    ("transmission error over γ, spur pair", "TE [mm], spur pair,"),
    ("wheel torque over γ, spur pair", "wheel torque [N], spur pair,"),
    ("p0 over θ, spur pair as two bodies", "p0 [MPa], spur pair as two bodies"),
    ("p0 over θ and γ, cylinder", "relative error of p0, cylinder"),
)
"""What must not depend on γ and θ, and how its claims begin in docs/stress/independence.md."""
BAR, BALL, PRESSED, IMPACTS = (
    "Bar on a rigid wall", "Ball dropped on a block", "Pressed block under a varying force: order in time",
    "Bar between two walls: energy over a thousand impacts",
)
OVER_TIME = (
    ("bar on a wall: time of contact", BAR, "time of contact 2L/c [µs]"),
    ("bar on a wall: impulse", BAR, "impulse 2mv [N·s/m]"),
    ("bar on a wall: mean force", BAR, "mean force ϱcv [N/mm]"),
    ("ball dropped on a block: time of contact", BALL, "time of contact 2.9433 δ/v [µs]"),
    ("ball dropped on a block: largest force", BALL, "largest force [N]"),
    ("order in time, contact that stays closed", PRESSED, "order of convergence of the contact force in the time step"),
    ("order in time, through an impact", BAR, "order of convergence of the impulse in the time step"),
    ("1000 impacts without friction, conserving: growth of the energy", IMPACTS,
     "growth of the energy over that at the start, 4 modes, 10 steps, conserving"),
    ("impacts by the default method: growth of the energy", IMPACTS,
     "growth of the energy over that of any flight before, no modes, 10 steps, ρ_∞ = 0.8"),
)
"""What transient contact must reach: a promise, the title of its problem, and what docs/verification.md calls it."""


@dataclass(frozen=True)
class Promise:
    """A bar, and what was found; both with their units, as they are to be read."""

    what: str
    bar: str
    found: str
    met: bool


@dataclass(frozen=True)
class Measured:
    """A claim as a page's table has it."""

    section: str
    """The heading above the table."""
    quantity: str
    found: float
    wanted: float
    allowed: float
    """Absolute."""
    one_sided: bool
    """More than `wanted` is no error."""
    held: bool
    """As the page says."""

    @property
    def off(self) -> float:
        """Relative error; the figure itself where zero is wanted."""
        return abs(self.found / self.wanted - 1.0) if self.wanted else abs(self.found)


PROMISES = Table(
    Promise,
    (
        Column("", "what", words=True),
        Column("bar", "bar"),
        Column("found", "found"),
        Column("", lambda promise: "met" if promise.met else "**missed**", words=True),
    ),
)


def said(docs: Path) -> str:
    """The table of all promises, and what its terms mean."""
    gears = read_rows(docs / "benchmark" / "gears.csv", GearRow)
    return "\n\n".join([PROMISES.markdown(promises(docs)), *anew(gears), TERMS])


def promises(docs: Path) -> list[Promise]:
    """All of them, from the tables below `docs`. Raises OSError, ValueError where a table is missing."""
    tables, robustness = docs / "benchmark", docs / "stress"
    return [
        *_speed(tables), *_error_bars(tables), *_scenes(robustness), *_parameters(robustness),
        *_over_time(docs / "verification.md"),
    ]


def _speed(tables: Path) -> Iterator[Promise]:
    for name, title in TITLES.items():
        least, bar = FROM[name]
        rows = read_rows(tables / f"{name}.csv", Row)
        peer, _, ratio = min(advantage(rows, least), key=lambda line: line[2])
        what = f"{title}, {least:,} dofs and more: seconds of the fastest other program ({peer.program}) over ours"
        yield _at_least(f"{what}, at no larger error", ratio, bar, better=not unmatched(rows, least))
    gears = read_rows(tables / "gears.csv", GearRow)
    for program, bar in GEAR_BARS.items():
        (row,) = large(gears, program)
        yield _at_least(f"gear pair, {row.dofs:,} dofs: seconds per position of {program} over ours", row.ratio, bar)
    for ratio_row in (row for name in ("ratios", "beside") for row in read_rows(tables / f"{name}.csv", RatioRow)):
        compared = _at_least if ratio_row.is_least else _at_most
        yield compared(f"{ratio_row.what}, {ratio_row.dofs:,} dofs", ratio_row.ratio, ratio_row.bar)
    for run in read_rows(tables / "runs.csv", RunRow):
        yield from _run(run)
    levels = [row for row in read_rows(tables / "two_level.csv", AccuracyRow) if not isnan(row.bar)]
    met = sum(row.met for row in levels)
    what = "bars of flanks in levels, against exact condensation and against Hertz (docs/benchmark.md)"
    yield Promise(what, "all", f"{met} of {len(levels)}", met == len(levels))
    spur = "spur pair, seconds in 3D over 2D at equal error, least of three meshes"
    yield _at_least(spur, least_ratio(read_rows(tables / "spur.csv", SpurRow)), SPUR_BAR)
    for cost in read_rows(tables / "wear_cost.csv", WearCostRow):
        what = f"wear study of {BLOCKS} blocks over a sweep, {cost.case}"
        yield _at_most(f"{what}, preparing counted", cost.whole, WEAR_BAR)
        yield _at_most(f"{what}, preparing not counted", cost.bare, WEAR_BAR)


def _run(run: RunRow) -> Iterator[Promise]:
    """Its bars, if it came to its end."""
    name = f"{run.case}, `{run.level}`, two ranks"
    if not (isnan(run.seconds_bar) or run.note):
        bar, found = (f"{value:.0f} s" for value in (run.seconds_bar, run.seconds))
        yield Promise(f"{name}: time", bar, found, run.seconds <= run.seconds_bar)
    if not (isnan(run.memory_bar_MB) or run.note):
        bar, found = (f"{value / 1000:.1f} GB" for value in (run.memory_bar_MB, run.memory_MB))
        yield Promise(f"{name}: memory", bar, found, run.memory_MB <= run.memory_bar_MB)
    if not (isnan(run.iterations_bar) or run.note):
        yield _at_most(f"{name}: Newton iterations a position", run.iterations, run.iterations_bar)


def _error_bars(tables: Path) -> Iterator[Promise]:
    for name, what in (("bars", "true error inside the error bar, one mesh a sector, without K_Hβ"),
                       ("spacing", "error of the spacing of positions inside its bar")):
        rows = read_rows(tables / f"{name}.csv", BarRow)
        inside = sum(row.inside for row in rows)
        yield Promise(what, f"{100 * HELD:.0f} %", f"{inside} of {len(rows)}", inside >= HELD * len(rows))


def _scenes(robustness: Path) -> Iterator[Promise]:
    names = ("scenes.csv", "levels.csv", "wear.csv")
    every, levelled, worn = ([line["verdict"] for line in read_csv(robustness / name)] for name in names)
    for what, verdicts in (("random scenes", every), ("random scenes, flanks in levels,", levelled)):
        good, count = verdicts.count("converged"), len(verdicts)
        yield Promise(f"{what} that converge, balanced", "all", f"{good} of {count}", good == count)
    wrong = sum(verdict in ("wrong", "crashed", "hung") for verdict in worn)
    yield Promise("random wear studies that are wrong, crash or hang", "0", f"{wrong} of {len(worn)}", not wrong)


def _parameters(robustness: Path) -> Iterator[Promise]:
    claims = measured(robustness / "independence.md")
    for what, start in OVER_PARAMETERS:
        solved = [each for each in claims if each.quantity.startswith(start) and not isnan(each.found)]
        worst = max(each.off for each in solved)
        yield Promise(what, "0.5 %", f"{100 * worst:.2g} %", all(each.held for each in solved))
    for pair in ("spur pair", "helical pair in levels"):
        without = (each.quantity for each in claims if isnan(each.found))
        refused = {quantity.split(f"{pair}, ")[1] for quantity in without if pair in quantity}
        found = f"refused: {'; '.join(sorted(refused))}" if refused else "results"
        yield Promise(f"γ from 1.1 to 50 C, {pair}", "results", found, not refused)
    newton = max(each.found for each in claims if each.quantity.startswith("Newton iterations"))
    yield _at_most("Newton iterations per position with friction, spur pair in 2D, both stages", newton, 8.0)
    (kills,) = measured(robustness / "faults.md")
    yield Promise("killed 20 times and resumed: largest difference", "1e-7", f"{kills.found:.0e}", kills.held)


def _over_time(page: Path) -> Iterator[Promise]:
    claims = measured(page)
    for what, problem, quantity in OVER_TIME:
        claim = claim_of(claims, problem, quantity)
        if claim.one_sided:
            bar, found = f"at least {claim.wanted:g}", f"{claim.found:.3g}"
        elif claim.wanted:
            bar, found = f"{100 * claim.allowed / claim.wanted:.1g} %", f"{100 * claim.off:.2g} %"
        else:
            bar, found = f"{claim.allowed:.0e}", f"{claim.found:.1g}"
        yield Promise(what, bar, found, claim.held)


def claim_of(claims: list[Measured], problem: str, quantity: str) -> Measured:
    """The claim of a problem of docs/verification.md. Raises ValueError where there is none."""
    for claim in claims:
        if (claim.section, claim.quantity) == (problem, quantity):
            return claim
    raise ValueError(
        f"docs/verification.md: wanted {quantity!r} under {problem!r}, found none; "
        "change the table of names in evidence/pages that has it"
    )


def measured(page: Path) -> list[Measured]:
    """The claims in the tables of a page. Raises OSError; ValueError where there is none."""
    claims = [Measured(section, *_numbers(line)) for section, line in _lines(page) if {"found", "wanted"} <= set(line)]
    if not claims:
        raise ValueError(f"{page}: wanted a table with what was found and wanted, found none")
    return claims


def _numbers(line: dict[str, str]) -> tuple[str, float, float, float, bool, bool]:
    wanted = line["wanted"].removeprefix("at least ")
    allowed = line.get("allowed") or line["tolerance"]
    one_sided = wanted != line["wanted"]
    return line["quantity"], float(line["found"]), float(wanted), float(allowed), one_sided, line[""] == "holds"


def _lines(page: Path) -> Iterator[tuple[str, dict[str, str]]]:
    """The heading above each line of the tables of a page, and its cells by the names of their columns."""
    head: list[str] = []
    section = ""
    for line in page.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if line.startswith("## "):
            section = line.removeprefix("## ")
        if cells and head and not cells[0].startswith("---"):
            yield section, dict(zip(head, cells))
        head = (head or cells) if cells else []


def _at_least(what: str, ratio: float, bar: float, better: bool = True) -> Promise:
    return Promise(what, f"at least {bar:g}", f"{ratio:.3g}", ratio >= bar and better)


def _at_most(what: str, ratio: float, bar: float) -> Promise:
    return Promise(what, f"at most {bar:g}", f"{ratio:.3g}", ratio <= bar)
