"""The figures of a load list: one line per torque and friction coefficient, from the summaries of its runs."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from statistics import fmean
from typing import Any

from evolvent.results.tables.table import Table

ERROR = "_error"
"""End of the name of a column with the estimated error of a figure."""


@dataclass(frozen=True)
class LoadRow:
    """A line of loads.csv: a torque and a friction coefficient."""

    torque_Nm: float
    """Torque on the gear that the scene names."""
    friction: float
    """Friction coefficient μ."""
    transmission_error_mean_um: float
    """Mean of the transmission error at the positions of the pitch."""
    transmission_error_peak_to_peak_um: float
    """Peak-to-peak transmission error, as in summary.json, `frictions`, like the figures below."""
    transmission_error_peak_to_peak_um_error: float
    """Estimated error of the peak-to-peak transmission error, as in summary.json; NaN where the run has none."""
    max_pressure_MPa: float
    """Largest contact pressure over the whole engagement of a tooth, between the tip-edge zones and away from the
    starts of linear reliefs, as in summary.json."""
    max_pressure_MPa_error: float
    """Estimated error of the largest contact pressure."""
    max_pressure_at_zone_end: bool
    """Whether the largest contact pressure lies at the limit of a tip-edge zone, as in summary.json: its value depends
    on where the zone ends, and so on the mesh, which its error bar leaves out."""
    kink_pressure_MPa: float
    """Contact pressure over the start of a linear relief, for an ideal kink, as in summary.json; NaN where there is
    none."""
    mean_pressure_MPa: float
    """Mean contact pressure, as in summary.json. Where the largest pressure lies at the end of a tip-edge zone, which
    moves with the mesh, torques can be compared by the mean; its error bar may be the wider one, and says how well."""
    mean_pressure_MPa_error: float
    """Estimated error of the mean contact pressure."""
    mesh_stiffness_N_per_mm_um: float
    """Tangent stiffness, mean over the pitch."""
    mesh_stiffness_N_per_mm_um_error: float
    """Estimated error of the tangent stiffness."""
    secant_stiffness_N_per_mm_um: float
    """Secant stiffness, mean over the pitch: force over what the torque adds to the unloaded transmission error."""
    secant_stiffness_N_per_mm_um_error: float
    """Estimated error of the secant stiffness."""
    loss_percent: float
    """Friction work over input work of the pitch."""
    loss_percent_error: float
    """Estimated error of the loss."""
    face_load_factor: float
    """K_Hβ of ISO 6336-1, as in summary.json."""
    face_load_factor_error: float
    """Estimated error of the face load factor."""
    tip_edge_positions: int
    """Number of positions at which a tooth bears on a tip edge."""
    cells_across_contact_width: float
    """Elements across the contact width, median: flanks with levels take another number of them at each torque."""
    warnings: int
    """Number of warnings in the run's summary.json: read them before the figures are compared."""


LOADS = Table("loads.csv", LoadRow)
RUNS = "load_{}_percent"
"""Name of the folder of a run below that of the table, with its part of the torque."""


@dataclass(frozen=True)
class LoadResult:
    """A run under one torque at one friction coefficient."""

    row: LoadRow
    """Row of the run in loads.csv."""
    angle: tuple[float, ...]
    """Rotation of the pinion at each position [°]."""
    transmission_error: tuple[float, ...]
    """Transmission error at each position [µm]."""


@dataclass(frozen=True)
class LoadRuns:
    """The runs that loads.csv was gathered from."""

    name: str = LOADS.name
    """Name of the table's file."""

    def read(self, folder: Path) -> list[LoadResult]:
        """The runs in folders below that of the table, the lightest torque first. Raises ArchiveError, OSError."""
        torques = [row.torque_Nm for row in LOADS.read(folder)]
        every = load_results(path for path in folder.glob(RUNS.format("*")) if (path / "summary.json").exists())
        return [each for each in every if any(math.isclose(each.row.torque_Nm, torque) for torque in torques)]


def load_results(folders: Iterable[Path]) -> list[LoadResult]:
    """Rows and transmission errors of finished runs, from their summary.json, the lightest torque first. Raises
    OSError."""
    read = [json.loads((folder / "summary.json").read_text(encoding="utf-8")) for folder in folders]
    read.sort(key=lambda summary: float(summary["scene"]["load"]["torque_Nm"]))
    return [_result(summary, row) for summary in read for row in summary["frictions"]]


def _result(summary: Mapping[str, Any], row: Mapping[str, Any]) -> LoadResult:
    """Result of a run at one of its friction coefficients."""
    positions = [each for each in summary["positions"] if each["friction"] == row["friction"]]
    keys = "pinion_angle_deg", "transmission_error_um"
    angle, error = (tuple(float(each[key]) for each in positions) for key in keys)
    bars = row["estimated_error"] or {}
    known = {
        "torque_Nm": summary["scene"]["load"]["torque_Nm"],
        "friction": row["friction"],
        "transmission_error_mean_um": fmean(error),
        "max_pressure_at_zone_end": row["max_pressure_at_zone_end"],
        "tip_edge_positions": sum(each["tip_edge"] for each in positions),
        "cells_across_contact_width": _number(summary["mesh"]["cells_across_contact_width"]),
        "warnings": len(summary["warnings"]),
    }
    for name in [each.name for each in fields(LoadRow) if each.name not in known]:
        figure = name.removesuffix(ERROR)
        known[name] = _number(row.get(name) if name == figure else bars.get(figure))
    return LoadResult(LoadRow(**known), angle, error)


def _number(value: float | None) -> float:
    return float("nan") if value is None else value
