"""Evolvent beside the other programs: the sections on round contacts and on the gear pair."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from evidence.benchmarks.comparison.programs import EVOLVENT
from evidence.benchmarks.comparison.work_precision import OverkillRow, Row
from evidence.benchmarks.gears.position_cost import GearRow
from evidence.benchmarks.pages import figures
from evidence.benchmarks.pages.section import PageSection, verdict
from evidence.tables import Column, Table

TITLES = {"hertz2d": "Cylinder on block, 2D", "hertz3d": "Sphere on block, 3D"}
FROM = {"hertz2d": (20_000, 1.0), "hertz3d": (30_000, 2.0)}
"""Degrees of freedom from which a bar holds, and the bar: a peer's seconds over Evolvent's at no larger error."""
GEAR_BARS = {"GetFEM": 10.0, "CalculiX mortar": 40.0}
GEAR_DOFS = 100_000
"""From which these bars hold: seconds per position over Evolvent's."""
THREE_TEETH = "three teeth"
HERTZ = Table(
    Row,
    (
        Column("cells", lambda row: f"{row.shape} a/{row.cells:g}", words=True), Column("order", "order", words=True),
        Column("dofs", "dofs", ",", words=True), Column("program", "program", words=True), Column("s", "cpu", ".3g"),
        Column("cold s", "cold", ".3g"), Column("ratio", "ratio", ".3g"), Column("MB", "memory_MB", ".0f"),
        Column("Newton", "iterations"), Column("force %", "force_error", "+.2%"),
        Column("p0 %", "peak_error", "+.2%"), Column("L2 %", "profile_error", ".2%"),
    ),
)
GEARS = Table(
    GearRow,
    (
        Column("program", "program", words=True), Column("model", "model", words=True), Column("order", "order"),
        Column("dofs", "dofs", ","), Column("positions", "positions"), Column("s a position", "seconds", ".3g"),
        Column("ratio", "ratio", ".3g"), Column("MB", "memory_MB", ".0f"), Column("Newton", "iterations", ".1f"),
        Column("N·m/mrad", "stiffness", ".2f"), Column("error %", "error", "+.2%"),
        Column("reference's own %", "reference_error", ".2%"),
    ),
)


def advantage(rows: Sequence[Row], least_dofs: int) -> list[tuple[Row, Row, float]]:
    """For every peer's row from `least_dofs` on: that row, Evolvent's fastest row whose profile is at least as good,
    and the ratio of their seconds; nothing for a row that no row of Evolvent's matches."""
    ours, peers = _by_program(rows, least_dofs)
    lines = []
    for peer in peers:
        if good := [row for row in ours if row.profile_error <= peer.profile_error]:
            best = min(good, key=lambda row: row.cpu)
            lines.append((peer, best, peer.cpu / best.cpu))
    return lines


def unmatched(rows: Sequence[Row], least_dofs: int) -> list[Row]:
    """A peer's rows from `least_dofs` on whose profile is better than any of Evolvent's."""
    ours, peers = _by_program(rows, least_dofs)
    return [peer for peer in peers if peer.profile_error < min(row.profile_error for row in ours)]


def _by_program(rows: Sequence[Row], least_dofs: int) -> tuple[list[Row], list[Row]]:
    """Evolvent's rows, and the other programs' from `least_dofs` on."""
    solved = [row for row in rows if not row.note]
    ours = [row for row in solved if row.program == EVOLVENT.name]
    return ours, [row for row in solved if row.program != EVOLVENT.name and row.dofs >= least_dofs]


def _overkill_said(name: str, tables: Path) -> list[str]:
    (known,) = Table(OverkillRow).read(tables / f"{name}_overkill.csv")
    force, peak, profile = (
        f"{100 * error:.2g} %" for error in (known.force_error, known.peak_error, known.profile_error)
    )
    return [
        f"Overkill: force {known.force:.5g}, peak {known.peak:.5g} MPa, half-width {known.half_width:.4g} mm. Its own "
        f"error, the distance to the next coarser one: {force} in the force, {peak} in the peak, {profile} in the "
        "profile (L2)."
    ]


def _advantage_said(least_dofs: int, bar: float, rows: Sequence[Row]) -> list[str]:
    lines = advantage(rows, least_dofs)
    if not lines:
        return [f"No other program was measured from {least_dofs:,} degrees of freedom on."]
    peer, best, ratio = min(lines, key=lambda line: line[2])
    better = unmatched(rows, least_dofs)
    missed = f" {len(better)} of their rows have a smaller error than any of Evolvent's." if better else ""
    return [
        f"From {least_dofs:,} degrees of freedom on, at no larger error of the profile: the fastest other program "
        f"takes **{ratio:.1f} times** Evolvent's time ({peer.program}, {peer.shape} of order {peer.order}, "
        f"{peer.dofs:,} dofs, {peer.cpu:.1f} s, against order {best.order}, {best.dofs:,} dofs, {best.cpu:.1f} s). "
        f"Wanted at least {bar:g}: {verdict(ratio >= bar and not better)}.{missed}"
    ]


def large(rows: Sequence[GearRow], program: str) -> list[GearRow]:
    """A program's last row from GEAR_DOFS on, or none."""
    return [row for row in rows if row.program == program and not row.note and row.dofs >= GEAR_DOFS][-1:]


def anew(rows: Sequence[GearRow]) -> list[str]:
    """What is left of the ratios where Evolvent solves one position anew, on the others' mesh."""
    solved = [row for row in rows if row.model == THREE_TEETH and not row.note]
    ours = [row for row in solved if row.program == EVOLVENT.name]
    peers = [row for row in solved if row.program != EVOLVENT.name]
    if not ours or not peers:
        return []
    said = ", ".join(f"{row.program} {row.seconds / ours[-1].seconds:.1f} times" for row in peers)
    return [
        "Most of that is condensing once for all positions. For one position of the gear pair, solved anew on the same "
        f"mesh of three teeth, Evolvent takes {ours[-1].seconds:.1f} s; {said} as long."
    ]


def _gears_said(rows: Sequence[GearRow]) -> list[str]:
    ratios = [
        f"{row.program} at {row.dofs:,} dofs: **{row.ratio:.1f} times** Evolvent's time a position. "
        f"Wanted at least {bar:g}: {verdict(row.ratio >= bar)}."
        for program, bar in GEAR_BARS.items()
        for row in large(rows, program)
    ]
    return [*ratios, *anew(rows)]


SECTIONS: tuple[PageSection[Any], ...] = (
    *(
        PageSection(
            title, name, HERTZ, partial(_overkill_said, name), partial(figures.work_precision, title=title), title,
            partial(_advantage_said, *FROM[name]),
        )
        for name, title in TITLES.items()
    ),
    PageSection("Gear pair", "gears", GEARS, figure=figures.gears, caption="Seconds a position", words=_gears_said),
)
