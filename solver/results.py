"""The tables of a run: summary.json, positions.csv, teeth.csv.

`summary` gives plain values in the units that reports use (N·m, µm, MPa, degrees); files are written under another
name and renamed, so that a reader never sees half a table.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from solver.engagement import Engagement, crossing, engagements, line_peak
from solver.estimated_errors import FigureErrors
from solver.gear_results import ToothSummary, balance_error, pitch_imbalance
from solver.mesh_facts import MeshFacts
from solver.run_data import RunData, SolvedPosition
from solver.run_folder import RunFolder
from solver.run_warnings import warnings_of
from solver.scene import GEARS
from solver.skips import Skipped

SCHEMA_VERSION = 1
"""Of summary.json: one more where a key goes, is named anew or means something else; new keys leave it as it is."""


@dataclass(frozen=True)
class Timings:
    """Wall seconds of the parts of a run."""

    mesh: float = 0.0
    """Meshing both gears."""
    assemble: float = 0.0
    """Their stiffness and Nitsche's constant term."""
    factor: float = 0.0
    """Condensing both gears and closing the rings of teeth."""
    positions: float = 0.0
    """All positions at all friction coefficients; of a wear study, all of its blocks."""
    error_bars: float = 0.0
    """The coarse companion."""
    output: float = 0.0
    """Tables, fields and pictures."""
    total: float = 0.0
    """The whole run; of a resumed one since it was resumed."""


@dataclass(frozen=True)
class RunFacts:
    """What a run knows beside its results."""

    versions: Mapping[str, str]
    """What the results depend on: program or library, and its version."""
    ranks: int
    """MPI processes."""
    dofs: int
    """Degrees of freedom of one sector of both gears."""
    cells: int
    """Cells of these."""
    mesh: MeshFacts
    """What the meshes are worth."""
    skipped: Sequence[Skipped]
    """What the scene did not need, see docs/scene.md."""
    timings_s: Timings
    """Wall time of the run's parts."""
    peak_memory_MB: float
    """Largest resident memory, summed over the ranks."""


@dataclass(frozen=True)
class ToothRow:
    """One tooth pair at a position."""

    tooth: int
    """The tooth pair: 0 passes the pitch point at the pinion angle 0, 1 is one pitch ahead of it, −1 one behind."""
    force_N: float
    """Normal force on the pair."""
    max_pressure_MPa: float
    """Largest contact pressure, fitted over each slice, between the tip-edge zones; null where no slice lies there."""
    contact_length_mm: float
    """Length of the contact line that bears."""
    edge_pressure_MPa: float
    """Largest pressure at a tip's edge, 0 where none bears: singular there, and a matter of the mesh."""


@dataclass(frozen=True)
class PositionRow:
    """One position at one friction coefficient."""

    pinion_angle_deg: float
    """Rotation of the pinion; 0: the flanks of tooth pair 0 touch at the pitch point at mid-face."""
    friction: float
    """Coulomb's coefficient μ."""
    torque_pinion_Nm: float
    """On the pinion's shaft."""
    torque_gear_Nm: float
    """On the wheel's shaft."""
    transmission_error_um: float
    """r_b1 φ_1 − r_b2 φ_2: by how much the wheel lags behind the pinion, along the path of contact."""
    mesh_stiffness_N_per_mm_um: float
    """Slope of the force over the deflection along the line of action, over the face width: the tangent at this load,
    without friction."""
    secant_stiffness_N_per_mm_um: float
    """Force over face width and transmission error, in which modifications of the flanks count as deflection; null
    where a flank has a chart."""
    max_pressure_MPa: float
    """The largest of the teeth's."""
    tip_edge: bool
    """Whether a tooth bears on a tip's edge, where the pressure is singular."""
    loss_percent: float
    """Friction power, of the input power."""
    newton_iterations: int
    """Iterations of Newton's method at this position."""
    balance_error: float
    """Imbalance of the forces, or the power that the teeth store or give back over the input: the larger one. A run
    ends with status 3 above 0.1."""
    seconds: float
    """Wall time."""
    teeth: tuple[ToothRow, ...]
    """The tooth pairs that bear; in positions.csv their number, `teeth_in_contact`."""


@dataclass(frozen=True)
class FrictionRow:
    """A pitch at one friction coefficient."""

    friction: float
    """Coulomb's coefficient μ."""
    max_pressure_MPa: float
    """Largest contact pressure of a tooth's whole engagement between the tip-edge zones."""
    max_pressure_angle_deg: float
    """The tooth's rotation where it occurs; 0 is the pitch point at mid-face."""
    max_pressure_at_zone_end: bool
    """Whether it lies where a tip-edge zone begins, so that its size is a matter of where that is."""
    mean_pressure_MPa: float
    """Mean over the engagement of the mean pressure between the tip-edge zones."""
    transmission_error_peak_to_peak_um: float
    """Largest less smallest transmission error of the pitch."""
    mesh_stiffness_N_per_mm_um: float
    """Tangent, mean of the pitch: c_γ of ISO 6336-1."""
    secant_stiffness_N_per_mm_um: float
    """Secant, mean of the pitch; null where a flank has a chart."""
    loss_percent: float
    """Friction work of the pitch, of the input."""
    crossing_deg: float
    """The tooth's rotation at which its curve of maximum pressure crosses that of the smallest coefficient; null where
    it does not."""
    balance_error: float
    """Input less output less friction work, over the input, of the pitch. A run ends with status 3 above 0.01."""
    estimated_error: FigureErrors | None
    """Error bars of the figures of the same names; null where there are none."""


@dataclass(frozen=True)
class ErrorBars:
    """How error bars were estimated, or why there are none."""

    method: str
    """How they were estimated; empty where there are none."""
    missing: str | None
    """Why there are none; null where there are some."""


@dataclass(frozen=True)
class Summary(RunFacts):
    """summary.json."""

    schema_version: int
    """Of this file's form, docs/summary.schema.json: larger where a key is gone or means something else."""
    scene: Mapping[str, object]
    """The scene with all its defaults, docs/scene.md."""
    warnings: tuple[str, ...]
    """What makes figures doubtful, a sentence each."""
    estimated_error: ErrorBars
    """How error bars were estimated."""
    frictions: tuple[FrictionRow, ...]
    """The figures of the pitch, one entry a friction coefficient."""
    positions: tuple[PositionRow, ...]
    """One entry a position and friction coefficient."""


def position_rows(run: RunData) -> list[PositionRow]:
    """All positions of the pitch, all friction coefficients."""
    return [position_row(run, solved) for each in run.positions for solved in each]


def position_row(run: RunData, solved: SolvedPosition) -> PositionRow:
    """One position."""
    result, width = solved.result, run.width
    teeth = tuple(_tooth_row(run, solved, tooth) for tooth in solved.teeth)
    return PositionRow(
        pinion_angle_deg=math.degrees(result.stand.angle),
        friction=result.friction,
        torque_pinion_Nm=1e-3 * width * result.torques[0],
        torque_gear_Nm=1e-3 * width * result.torques[1],
        transmission_error_um=1e3 * result.transmission_error,
        mesh_stiffness_N_per_mm_um=mesh_stiffness(run, solved),
        secant_stiffness_N_per_mm_um=secant_stiffness(run, solved),
        max_pressure_MPa=float(np.nanmax([tooth.max_pressure_MPa for tooth in teeth])),
        tip_edge=any(tooth.edge_pressure > 0.0 for tooth in solved.teeth),
        loss_percent=loss_percent(solved),
        newton_iterations=result.iterations,
        balance_error=balance_error(result),
        seconds=result.seconds,
        teeth=teeth,
    )


def loss_percent(solved: SolvedPosition) -> float:
    """Friction power of the input power [%]."""
    return 100.0 * solved.result.friction_loss / solved.result.torques[0]


def _tooth_row(run: RunData, solved: SolvedPosition, tooth: ToothSummary) -> ToothRow:
    length, peak = tooth.contact_length * run.width, line_peak(run.pair, solved.cut, tooth.tooth, run.inner_path)
    return ToothRow(tooth.tooth, tooth.force * run.width, peak.pressure, length, tooth.edge_pressure)


def friction_rows(run: RunData, inner: tuple[float, float] | None = None) -> list[FrictionRow]:
    """One row per friction coefficient, in the scene's order; inner: see `engagement.engagement`."""
    curves = engagements(run, inner)
    lowest = curves[int(np.argmin(run.frictions))]
    return [_friction_row(run, index, curve, lowest) for index, curve in enumerate(curves)]


def _friction_row(run: RunData, index: int, curve: Engagement, lowest: Engagement) -> FrictionRow:
    results = [each[index].result for each in run.positions]
    errors = 1e3 * np.array([result.transmission_error for result in results])
    top = curve.peak
    loss = sum(r.friction_loss for r in results) / sum(r.torques[0] for r in results)
    return FrictionRow(
        friction=curve.friction,
        max_pressure_MPa=top.pressure,
        max_pressure_angle_deg=math.degrees(top.angle),
        max_pressure_at_zone_end=top.at_zone_end,
        mean_pressure_MPa=float(np.nanmean(curve.mean_pressure)),
        transmission_error_peak_to_peak_um=float(np.ptp(errors)),
        mesh_stiffness_N_per_mm_um=float(np.mean([mesh_stiffness(run, each[index]) for each in run.positions])),
        secant_stiffness_N_per_mm_um=float(np.mean([secant_stiffness(run, each[index]) for each in run.positions])),
        loss_percent=100.0 * loss,
        crossing_deg=math.degrees(crossing(lowest, curve)) if curve is not lowest else math.nan,
        balance_error=pitch_imbalance(results),
        estimated_error=run.errors.figures[index] if run.errors.figures else None,
    )


def mesh_stiffness(run: RunData, solved: SolvedPosition) -> float:
    """The tangent dF/dδ along the line of action [N/(mm·µm)] at the torque, without friction, see mesh_stiffness.py;
    its mean over the pitch is c_γ of ISO 6336-1. F: torque over base radius and face width, δ: transmission error."""
    return 1e-3 * solved.result.stiffness * run.width / run.pair.face_width


def secant_stiffness(run: RunData, solved: SolvedPosition) -> float:
    """T_1/(r_b1 b) over the transmission error [N/(mm·µm)], in which modifications of the flanks count as deflection;
    NaN where a flank has a chart, as there is no telling how much of the error is missing material."""
    if any(getattr(run.scene, name).flank_csv is not None for name in GEARS):
        return math.nan
    force = run.width * solved.result.torques[0] / run.pair.pinion.base_radius / run.pair.face_width
    return force / (1e3 * solved.result.transmission_error)


def summary(run: RunData, facts: RunFacts) -> dict[str, object]:
    """What summary.json holds, in plain values."""
    found = Summary(
        **vars(facts),
        schema_version=SCHEMA_VERSION,
        scene=run.scene.model_dump(mode="json"),
        warnings=warnings_of(run, facts.mesh),
        estimated_error=ErrorBars(run.errors.method, run.errors.missing or None),
        frictions=tuple(friction_rows(run)),
        positions=tuple(position_rows(run)),
    )
    return {"schema_version": found.schema_version, **asdict(found)}


def write_tables(folder: RunFolder, run: RunData, facts: RunFacts) -> None:
    """Writes summary.json, positions.csv and teeth.csv. Raises OSError."""
    rows = position_rows(run)
    folder.write_text("positions.csv", csv_text([_flat(asdict(row)) for row in rows]))
    teeth = [
        {"pinion_angle_deg": row.pinion_angle_deg, "friction": row.friction, **asdict(tooth)}
        for row in rows
        for tooth in row.teeth
    ]
    folder.write_text("teeth.csv", csv_text(teeth))
    text = json.dumps(_without_nan(summary(run, facts)), ensure_ascii=False, indent=1, allow_nan=False)
    folder.write_text("summary.json", text + "\n")


def _flat(row: dict[str, object]) -> dict[str, object]:
    """A position without its list of teeth, but with their number."""
    teeth = row.pop("teeth")
    assert isinstance(teeth, (list, tuple))
    return row | {"teeth_in_contact": len(teeth)}


def csv_text(rows: Sequence[Mapping[str, object]]) -> str:
    """Rows with the same keys as a CSV file."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, fieldnames=list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _shown(value) for key, value in row.items()} for row in rows)
    return stream.getvalue()


def _shown(value: object) -> object:
    """Nine digits are enough for people and for comparing two runs."""
    return f"{value:.9g}" if isinstance(value, float) else value


def _without_nan(value: object) -> object:
    """JSON knows no NaN: null."""
    if isinstance(value, Mapping):
        return {str(key): _without_nan(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
