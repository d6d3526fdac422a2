"""docs/benchmark.md: tables and figures from the measured rows; nothing is typed in by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from pathlib import Path

from evidence.benchmark import figures
from evidence.benchmark.bars import BarRow
from evidence.benchmark.gear_rows import GearRow
from evidence.benchmark.page_savings import bars_section, skip_section, spacing_section, spur_section
from evidence.benchmark.page_wear import precision, wear_section
from evidence.benchmark.pitches import PitchRow
from evidence.benchmark.precision import OverkillRow, Row
from evidence.benchmark.profile import ProfileRow
from evidence.benchmark.programs import EVOLVENT
from evidence.benchmark.scaling import RatioRow, SizeRow, exponent
from evidence.benchmark.skips import SkipRow
from evidence.benchmark.spur import SpurRow
from evidence.benchmark.tables import read_rows
from evidence.benchmark.wear import WearCostRow, WearPrecisionRow
from evidence.report import header, picture, table, write

TITLES = {"hertz2d": "Cylinder on block, 2D", "hertz3d": "Sphere on block, 3D"}
FROM = {"hertz2d": (20_000, 1.0), "hertz3d": (30_000, 2.0)}
"""Degrees of freedom from which a bar holds, and the bar: a peer's seconds over Evolvent's at no larger error."""
GEAR_BARS = {"GetFEM": 10.0, "CalculiX mortar": 40.0}
THREE_TEETH = "three teeth"
COMMAND = "python -m evidence.benchmark all --peers"
TERMS = """CPU seconds of the whole process with one thread, start of Python and its imports included, writing and
reading of meshes not; medians of runs side by side. *cold*: the first run on a kind of cells, which compiles its forms.
Errors are relative to the overkill solution of the same problem."""

PITCHES = """Wall seconds of the whole process without meshing: for a run of one position, for the pitch, and for one
position with an empty cache of compiled forms (*cold*). Error: of the pitch's mean transmission error, against the
overkill pitch. *Elements* are those across the contact width; the body keeps what its level has, and with order 1 the
error of that remains."""


def write_page(out: Path) -> Path:
    """The page, and its figures below pictures/benchmark/. Parts that were not measured are left out."""
    draw_figures(out / "benchmark", out / "pictures" / "benchmark")
    return write(out / "benchmark.md", [header("Benchmark", COMMAND), *parts(out / "benchmark")])


def draw_figures(tables: Path, pictures: Path) -> None:
    """Of what was measured. Raises OSError."""
    pictures.mkdir(parents=True, exist_ok=True)
    for name, title in TITLES.items():
        if rows := read_rows(tables / f"{name}.csv", Row):
            picture(figures.work_precision(rows, title), pictures / f"{name}.png")
    if gears := read_rows(tables / "gears.csv", GearRow):
        picture(figures.gears(gears), pictures / "gears.png")
    if pitches := read_rows(tables / "pitches.csv", PitchRow):
        picture(figures.pitches(pitches), pictures / "pitches.png")
    if sizes := [row for row in read_rows(tables / "sizes.csv", SizeRow) if not row.note]:
        picture(figures.sizes(sizes), pictures / "sizes.png")
    if precisions := read_rows(tables / "wear.csv", WearPrecisionRow):
        picture(precision(precisions), pictures / "wear.png")


def parts(tables: Path) -> list[str]:
    """The page below its header, from the tables in this folder."""
    found = [TERMS]
    for name, title in TITLES.items():
        if rows := read_rows(tables / f"{name}.csv", Row):
            known = read_rows(tables / f"{name}_overkill.csv", OverkillRow)[0]
            found += [f"## {title}", _overkill(known), f"![{title}](pictures/benchmark/{name}.png)"]
            found += [_verdict(rows, *FROM[name]), _hertz_table(rows)]
    if gears := read_rows(tables / "gears.csv", GearRow):
        found += ["## Gear pair", "![Seconds a position](pictures/benchmark/gears.png)"]
        found += [*_gear_verdicts(gears), *anew(gears), _gear_table(gears)]
    if pitches := read_rows(tables / "pitches.csv", PitchRow):
        found += ["## A position and a pitch, against the error", "![A pitch](pictures/benchmark/pitches.png)"]
        found += [PITCHES, _pitches_table(pitches)]
    if ratios := read_rows(tables / "ratios.csv", RatioRow):
        found += ["## A pitch", _ratio_table(ratios)]
    sizes = read_rows(tables / "sizes.csv", SizeRow)
    if [row for row in sizes if not row.note]:
        found += ["## Size", "![Cost over size](pictures/benchmark/sizes.png)", _size_table(sizes)]
    if profile := read_rows(tables / "profile.csv", ProfileRow):
        found += ["## Where the time goes", _profile_table(profile)]
    found += skip_section(read_rows(tables / "skips.csv", SkipRow))
    found += spur_section(read_rows(tables / "spur.csv", SpurRow))
    found += bars_section(read_rows(tables / "bars.csv", BarRow))
    found += spacing_section(read_rows(tables / "spacing.csv", BarRow))
    costs = read_rows(tables / "wear_cost.csv", WearCostRow)
    return found + wear_section(costs, read_rows(tables / "wear.csv", WearPrecisionRow))


def _overkill(known: OverkillRow) -> str:
    return (
        f"Overkill: force {known.force:.5g}, peak {known.peak:.5g} MPa, half-width {known.half_width:.4g} mm. Its own "
        f"error, the distance to the next coarser one: {_percent(known.force_error)} in the force, "
        f"{_percent(known.peak_error)} in the peak, {_percent(known.profile_error)} in the profile (L2)."
    )


def advantage(rows: Sequence[Row], least_dofs: int) -> list[tuple[Row, Row, float]]:
    """For every peer's row from `least_dofs` on: that row, Evolvent's fastest row whose profile is at least as good,
    and the ratio of their seconds; a row that Evolvent did not match anywhere has no line."""
    ours = [row for row in rows if row.program == EVOLVENT.name and not row.note]
    found = []
    for row in rows:
        if row.program == EVOLVENT.name or row.note or row.dofs < least_dofs:
            continue
        good = [own for own in ours if own.profile_error <= row.profile_error]
        if good:
            best = min(good, key=lambda own: own.cpu)
            found.append((row, best, row.cpu / best.cpu))
    return found


def unmatched(rows: Sequence[Row], least_dofs: int) -> list[Row]:
    """A peer's rows from `least_dofs` on whose profile is better than any of Evolvent's."""
    ours = [row.profile_error for row in rows if row.program == EVOLVENT.name and not row.note]
    peers = [row for row in rows if row.program != EVOLVENT.name and not row.note and row.dofs >= least_dofs]
    return [row for row in peers if row.profile_error < min(ours)]


def _verdict(rows: Sequence[Row], least_dofs: int, bar: float) -> str:
    found = advantage(rows, least_dofs)
    if not found:
        return f"No other program was measured from {least_dofs:,} degrees of freedom on."
    peer, own, ratio = min(found, key=lambda line: line[2])
    better = unmatched(rows, least_dofs)
    missed = f" {len(better)} of their rows have a smaller error than any of Evolvent's." if better else ""
    met = ratio >= bar and not better
    return (
        f"From {least_dofs:,} degrees of freedom on, at no larger error of the profile: the fastest other program "
        f"takes **{ratio:.1f} times** Evolvent's time ({peer.program}, {peer.shape} of order {peer.order}, "
        f"{peer.dofs:,} dofs, {peer.cpu:.1f} s, against order {own.order}, {own.dofs:,} dofs, {own.cpu:.1f} s). "
        f"Wanted at least {bar:g}: {'met' if met else 'MISSED'}.{missed}"
    )


def _hertz_table(rows: Sequence[Row]) -> str:
    head = ("cells", "order", "dofs", "program", "s", "cold s", "ratio", "MB", "Newton", "force %", "p0 %", "L2 %")
    lines = [
        [
            f"{r.shape} a/{r.cells:g}", str(r.order), f"{r.dofs:,}", r.program, *(
                (_number(r.cpu), _number(r.cold), _number(r.ratio), f"{r.memory_MB:.0f}", str(r.iterations),
                 f"{100 * r.force_error:+.2f}", f"{100 * r.peak_error:+.2f}", f"{100 * r.profile_error:.2f}")
                if not r.note else (r.note, *[""] * 7)
            ),
        ]
        for r in rows
    ]  # fmt: skip
    return table(head, lines, right=range(4, 12))


def _gear_verdicts(rows: Sequence[GearRow]) -> list[str]:
    said = []
    for name, bar in GEAR_BARS.items():
        large = [r for r in rows if r.program == name and not r.note and r.dofs >= 100_000]
        if large:
            r = large[-1]
            verdict = "met" if r.ratio >= bar else "MISSED"
            said.append(f"{name} at {r.dofs:,} dofs: **{r.ratio:.1f} times** Evolvent's time a position. "
                        f"Wanted at least {bar:g}: {verdict}.")  # fmt: skip
    return said


def anew(rows: Sequence[GearRow]) -> list[str]:
    """What is left of the ratios where Evolvent solves one position anew, on the others' mesh."""
    own = [r for r in rows if r.program == EVOLVENT.name and r.model == THREE_TEETH and not r.note]
    peers = [r for r in rows if r.program != EVOLVENT.name and r.model == THREE_TEETH and not r.note]
    if not own or not peers:
        return []
    said = ", ".join(f"{r.program} {r.seconds / own[-1].seconds:.1f} times" for r in peers)
    return [
        "Most of that is condensing once for all positions. For one position of the gear pair, solved anew on the same "
        f"mesh of three teeth, Evolvent takes {own[-1].seconds:.1f} s; {said} as long."
    ]


def _gear_table(rows: Sequence[GearRow]) -> str:
    head = ("program", "model", "order", "dofs", "positions", "s a position", "ratio", "MB", "Newton", "N·m/mrad",
            "error %", "reference's own %")  # fmt: skip
    lines = [
        [
            r.program, r.model, str(r.order), f"{r.dofs:,}", str(r.positions), *(
                (_number(r.seconds), _number(r.ratio), f"{r.memory_MB:.0f}", f"{r.iterations:.1f}",
                 f"{r.stiffness:.2f}", f"{100 * r.error:+.2f}", f"{100 * r.reference_error:.2f}")
                if not r.note else (r.note, *[""] * 6)
            ),
        ]
        for r in rows
    ]  # fmt: skip
    return table(head, lines, right=range(2, 12))


def _ratio_table(rows: Sequence[RatioRow]) -> str:
    lines = [
        [r.what, f"{r.dofs:,}", _number(r.above), _number(r.below), f"**{r.ratio:.2f}**",
         f"at {'least' if r.is_least else 'most'} {r.bar:g}", f"{r.aim:g}", "met" if r.met else "MISSED"]
        for r in rows
    ]  # fmt: skip
    return table(("ratio of", "dofs", "s", "over s", "found", "bar", "aim", "bar is"), lines, right=range(1, 7))


def _size_table(rows: Sequence[SizeRow]) -> str:
    head = ("elements across 2b", "dofs", "assemble s", "condense s", "s a position", "Newton", "MB")
    lines = [
        [f"{r.elements:g}", f"{r.dofs:,}", *(
            (_number(r.assemble), _number(r.condense), _number(r.position), f"{r.iterations:.0f}", f"{r.memory_MB:.0f}")
            if not r.note else (r.note, "", "", "", "")
        )]
        for r in rows
    ]  # fmt: skip
    kept = [r for r in rows if not r.note]
    said = []
    if len(kept) > 1:
        dofs = figures.column(kept, "dofs")
        names = {"memory_MB": "memory", "condense": "condensing", "position": "one more position"}
        said = [f"{text} ~ dofs^{exponent(dofs, figures.column(kept, name)):.2f}" for name, text in names.items()]
    return table(head, lines, right=range(7)) + ("\n\n" + "; ".join(said) + "." if said else "")


def _pitches_table(rows: Sequence[PitchRow]) -> str:
    head = ("cells", "order", "ranks", "elements", "dofs", "one position s", "cold s", "pitch s", "MB", "error %",
            "overkill's own %")  # fmt: skip
    lines = [
        [r.shape, str(r.order), str(r.ranks), f"{r.elements:g}", f"{r.dofs:,}", *(
            (_number(r.one), _number(r.cold), _number(r.pitch), f"{r.memory_MB:.0f}", f"{100 * r.error:+.2f}",
             f"{100 * r.reference_error:.2f}") if not r.note else (r.note, "", "", "", "", "")
        )]
        for r in rows
    ]  # fmt: skip
    return table(head, lines, right=range(1, 11))


def _profile_table(rows: Sequence[ProfileRow]) -> str:
    words = (
        f"A pitch of {rows[0].positions} positions at one friction coefficient, {rows[0].dofs:,} dofs, by Python's "
        "profiler, which slows small functions down."
    )
    lines = [[r.part, _number(r.seconds), f"{100 * r.share:.1f}", str(r.calls)] for r in rows]
    return words + "\n\n" + table(("part", "s", "%", "calls"), lines, right=range(1, 4))


def _number(value: float) -> str:
    return "" if isnan(value) else f"{value:.3g}"


def _percent(value: float) -> str:
    return f"{100 * value:.2g} %"
