"""What a reader looks for first in transient.json, a line a speed and friction coefficient."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.results.archive.error_bar_data import plus_minus

FIGURES = (
    ("start_dynamic_factor", "from rest up to a mesh force over load of", "", 2),
    ("dynamic_factor", "largest mesh force over load", "", 2),
    ("peak_to_peak_um", "transmission error", "µm peak to peak", 2),
    ("max_pressure_MPa", "largest pressure", "MPa", 0),
)
"""Key, name, unit, decimals."""
STATIC = "static_"


def summary_lines(folder: Path) -> Iterator[str]:
    """Each figure with its error bar where there is one, and without inertia behind it, from the folder's table."""
    for fact in json.loads((folder / TRANSIENT_FACTS).read_text(encoding="utf-8")):
        parts = []
        for key, name, unit, digits in FIGURES:
            if fact[key] is None:
                continue
            value = plus_minus(fact[key], fact[f"{key}_error"] or 0.0, digits)
            calm = fact.get(f"{STATIC}{key}")
            without = "" if calm is None else (
                f" (without inertia {plus_minus(calm, fact[f'{STATIC}{key}_error'] or 0.0, digits)})"
            )
            parts.append(f"{name} {value} {unit}".rstrip() + without)
        yield f"{fact['speed_rpm']:g} r/min, μ = {fact['friction']:g}: {', '.join(parts)}"
