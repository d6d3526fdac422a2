"""Key figures of transient.json in words, a line for each speed and friction coefficient."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS, TransientFacts
from evolvent.results.archive.error_bar_data import plus_minus

FIGURES = (
    ("start_dynamic_factor", "from rest up to a mesh force over load of", "", 2),
    ("dynamic_factor", "largest mesh force over load", "", 2),
    ("peak_to_peak_um", "transmission error", "µm peak to peak", 2),
    ("max_pressure_MPa", "largest pressure", "MPa", 0),
)
"""Key, name, unit and decimals of each key figure."""
STATIC = "static_"


def summary_lines(folder: Path) -> Iterator[str]:
    """Key figures of each case from the folder's table, with error bars where there are any, and the values without
    inertia in brackets."""
    for fact in TRANSIENT_FACTS.read(folder):
        parts = []
        for key, name, unit, digits in FIGURES:
            if not (value := _with_error(fact, key, digits)):
                continue
            calm = _with_error(fact, f"{STATIC}{key}", digits)
            parts.append(f"{name} {value} {unit}".rstrip() + (f" (without inertia {calm})" if calm else ""))
        yield f"{fact.speed_rpm:g} r/min, μ = {fact.friction:g}: {', '.join(parts)}"


def _with_error(fact: TransientFacts, key: str, digits: int) -> str:
    """A figure with its error bar as text; empty where there is none."""
    value: float | None = getattr(fact, key, None)
    if value is None or math.isnan(value):
        return ""
    bar: float | None = getattr(fact, f"{key}_error")
    return plus_minus(value, math.nan if bar is None else bar, digits)
