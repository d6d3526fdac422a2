"""Key figures of a run in words, a line for each friction coefficient, printed at its end."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.results.relief_kinks import AWAY

LARGEST = "largest pressure"
"""Name of the largest contact pressure, followed by `AWAY` beside the pressure over the start of a linear relief."""
FIGURES = (
    ("max_pressure_MPa", LARGEST, "MPa", 0),
    ("kink_pressure_MPa", "over the sharp start of a linear relief about", "MPa", 0),
    ("transmission_error_peak_to_peak_um", "transmission error", "µm peak to peak", 2),
    ("mesh_stiffness_N_per_mm_um", "mesh stiffness", "N/(mm·µm)", 1),
    ("loss_percent", "loss", "%", 2),
    ("face_load_factor", "face load factor K_Hβ", "", 2),
)
"""Key in summary.json, name, unit and decimals of each figure."""
UNEVEN = 1.2
"""Largest face load factor that is not printed. Pressure grows with its square root: this one is 10 % more pressure
than of an even load, and misalignment and helix modifications deserve a look. Yang's pair, aligned and without
modifications, has 1.1 under its torque."""


def headlines(summary: Path) -> list[str]:
    """A line per friction coefficient from summary.json, each value with its error bar where there is one."""
    rows = json.loads(summary.read_text(encoding="utf-8"))["frictions"]
    return [f"μ = {row['friction']:g}: {', '.join(figure_texts(row, row['estimated_error'] or {}))}" for row in rows]


def has_error_bars(summary: Path) -> bool:
    """Whether the figures of summary.json have error bars."""
    return any(row["estimated_error"] for row in json.loads(summary.read_text(encoding="utf-8"))["frictions"])


def figure_texts(row: Mapping[str, Any], bars: Mapping[str, float | None]) -> list[str]:
    """Name, value, error bar and unit of each figure that is known. row, bars: by key of summary.json."""
    known = [figure for figure in FIGURES if _said(figure[0], row.get(figure[0]))]
    names = {LARGEST: f"{LARGEST} {AWAY}"} if row.get("kink_pressure_MPa") is not None else {}
    return [
        f"{names.get(name, name)} {plus_minus(row[key], bars.get(key) or 0.0, digits)} {unit}".rstrip()
        for key, name, unit, digits in known
    ]


def _said(key: str, value: float | None) -> bool:
    """Whether a figure is printed: if it is known, and the face load factor only of an uneven load."""
    return value is not None and not (key == "face_load_factor" and value <= UNEVEN)
