"""The figures of a load list: one line per torque and friction coefficient, from the summaries of its runs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean
from typing import Any

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.tables import csv_text

LOADS = "loads.csv"
FIGURES = (
    "transmission_error_peak_to_peak_um", "max_pressure_MPa", "mesh_stiffness_N_per_mm_um", "loss_percent",
)  # fmt: skip
"""Keys of a friction coefficient in summary.json."""
BAR = "_error"
"""Behind the name of a figure: its estimated error."""


@dataclass(frozen=True)
class LoadResult:
    """A run under one torque at one friction coefficient."""

    torque: float
    """On the gear that the scene names [N·m]."""
    friction: float
    """Coefficient μ."""
    figures: Mapping[str, float]
    """Each of `FIGURES`; NaN where the run has none."""
    errors: Mapping[str, float]
    """Their estimated errors; NaN where none are known."""
    angle: tuple[float, ...]
    """Of the pinion at each position [°]."""
    transmission_error: tuple[float, ...]
    """At each position [µm]."""


def load_results(folders: Sequence[Path]) -> list[LoadResult]:
    """Of finished runs, from their summary.json. Raises OSError."""
    read = [json.loads((folder / "summary.json").read_text(encoding="utf-8")) for folder in folders]
    return [_result(summary, row) for summary in read for row in summary["frictions"]]


def _result(summary: Mapping[str, Any], row: Mapping[str, Any]) -> LoadResult:
    """One of the friction coefficients of a run."""
    positions = [each for each in summary["positions"] if each["friction"] == row["friction"]]
    keys = "pinion_angle_deg", "transmission_error_um"
    angle, error = (tuple(float(each[key]) for each in positions) for key in keys)
    bars = row["estimated_error"] or {}
    return LoadResult(
        torque=summary["scene"]["load"]["torque_Nm"],
        friction=row["friction"],
        figures={key: _number(row[key]) for key in FIGURES},
        errors={key: _number(bars.get(key)) for key in FIGURES},
        angle=angle,
        transmission_error=error,
    )


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


def write_loads(folder: RunFolder, results: Sequence[LoadResult]) -> None:
    """Writes the table: torque, friction, mean transmission error, and each figure with its error. Raises WriteError,
    FolderError."""
    folder.write_text(LOADS, csv_text([_row(each) for each in results]))


def _row(result: LoadResult) -> dict[str, float]:
    row = {
        "torque_Nm": result.torque,
        "friction": result.friction,
        "transmission_error_mean_um": fmean(result.transmission_error),
    }
    for key in FIGURES:
        row |= {key: result.figures[key], key + BAR: result.errors[key]}
    return row
