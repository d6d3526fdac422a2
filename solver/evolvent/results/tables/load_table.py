"""The figures of a load list: one line per load and friction coefficient, from the summaries of its runs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from statistics import fmean
from typing import Any

from evolvent.results.tables.table import Table
from evolvent.scene.load_cases import LoadCase, load_cases
from evolvent.scene.scene import kept_scene

ERROR = "_error"
"""End of the name of a column with the estimated error of a figure."""


@dataclass(frozen=True)
class LoadRow:
    """A line of loads.csv: a load and a friction coefficient."""

    case: str
    """Name of the load case, or the part of the scene's torque."""
    torque_Nm: float
    """Torque on the gear that the scene names."""
    speed_rpm: float
    """Speed of the pinion in the load case, without effect on a run; NaN where it is not given."""
    share_of_life: float
    """Share of the life in the load case; NaN where it is not given."""
    misalignment_um: float
    """Opening of the flanks over the face width, `pair.misalignment_um` or that of the load case."""
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


def run_folder(case: LoadCase) -> str:
    """Name of the folder of a run below that of the table."""
    return f"load_{case.label}"


@dataclass(frozen=True)
class LoadResult:
    """A run under one load at one friction coefficient."""

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
        """The runs of the table that have folders below its own, the lightest load first. Raises ArchiveError,
        SceneError, OSError."""
        named, listed = {row.case for row in LOADS.read(folder)}, load_cases(kept_scene(folder / "scene.toml"))
        there = [case for case in listed if (folder / run_folder(case) / "summary.json").exists()]
        return load_results(folder, [case for case in there if case.name in named])


def load_results(folder: Path, cases: Iterable[LoadCase]) -> list[LoadResult]:
    """Rows and transmission errors of finished runs below a folder, from their summary.json, in the order of the loads.
    Raises OSError."""
    found = []
    for case in cases:
        summary = json.loads((folder / run_folder(case) / "summary.json").read_text(encoding="utf-8"))
        found += [_result(case, summary, row) for row in summary["frictions"]]
    return found


def _result(case: LoadCase, summary: Mapping[str, Any], row: Mapping[str, Any]) -> LoadResult:
    """Result of a run at one of its friction coefficients."""
    positions = [each for each in summary["positions"] if each["friction"] == row["friction"]]
    keys = "pinion_angle_deg", "transmission_error_um"
    angle, error = (tuple(float(each[key]) for each in positions) for key in keys)
    bars = row["estimated_error"] or {}
    known = {
        "case": case.name,
        "torque_Nm": case.torque_Nm,
        "speed_rpm": _number(case.speed_rpm),
        "share_of_life": _number(case.share_of_life),
        "misalignment_um": case.misalignment_um,
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
