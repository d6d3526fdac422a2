"""Last lines of `evolvent dynamics`: the figures of a pair's vibration that a reader looks for first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from evolvent.dynamics.results.response import DYNAMICS, RESPONSE, DriveSummary, ResponseRow
from evolvent.results.archive.error_bar_data import plus_minus

WAYS = "up", "down"


def summary_lines(folder: Path) -> Iterator[str]:
    """Natural speed, largest mesh force running up and down, jumps, and what is known of the gear bodies, from the
    folder's tables."""
    known, rows = DYNAMICS.read(folder), RESPONSE.read(folder)
    natural = plus_minus(known.natural_speed_rpm, known.natural_speed_rpm_error, 0)
    yield f"natural speed {natural} r/min; {'; '.join(_largest(rows))}"
    yield "; ".join([_jumps(known), *_bodies(known)])


def _largest(rows: Sequence[ResponseRow]) -> Iterator[str]:
    for way in WAYS:
        row = max((row for row in rows if row.way == way), key=lambda row: row.dynamic_factor)
        factor = plus_minus(row.dynamic_factor, row.dynamic_factor_error, 2)
        near = ", too low near the bodies' own vibration" if row.near_body_vibration else ""
        yield f"running {way}, largest mesh force over the static one {factor} at {row.speed_rpm:.0f} r/min{near}"


def _jumps(known: DriveSummary) -> str:
    ways = (
        f"running {way} at {', '.join(f'{speed:.0f}' for speed in speeds)} r/min"
        for way, speeds in zip(WAYS, (known.jumps_up_rpm, known.jumps_down_rpm)) if speeds
    )
    return f"jumps {', '.join(found)}" if (found := list(ways)) else "no jumps"


def _bodies(known: DriveSummary) -> Iterator[str]:
    yield f"{known.bodies} gear bodies"
    if known.body_frequency_Hz is not None and math.isfinite(known.body_frequency_Hz):
        yield f"their own vibration, left out, {known.body_frequency_Hz:.0f} Hz with bores whose centres cannot move"
    added = known.pinion_added_inertia_kg_m2, known.wheel_added_inertia_kg_m2
    if any(added):
        pinion, wheel = (each or 0.0 for each in added)
        yield f"inertia beyond that of the bodies, which turns with the bores: {pinion:.3g} and {wheel:.3g} kg·m²"
