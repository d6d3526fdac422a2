"""Results of a wear study, read from its folder: blocks, worn flanks and solved pitches at each report; wear.json."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import trapezoid

from evolvent.dynamics.operation_figures import VibrationRow
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.store import ArchiveError
from evolvent.results.run_data import RunData, read_run
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.table import Record
from evolvent.scene.scene import GEARS, Scene, kept_scene
from evolvent.wear.gears.flank_grid import inner_arcs
from evolvent.wear.gears.gear_study import BlockRow
from evolvent.wear.results.archive import read_checkpoint, worn_folder
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class GearReport:
    """Wear of a gear after some cycles."""

    deepest_um: float
    """Largest worn depth between the edge margins (0.1 m_n)."""
    at_diameter_mm: float
    """Diameter at which the worn depth is largest."""
    at_z_mm: float
    """Height above mid-face at which the worn depth is largest."""
    at_pitch_point_um: float
    """Worn depth at the pitch point, mean over the face."""
    volume_mm3: float
    """Total volume worn off a tooth."""


@dataclass(frozen=True)
class PairReport:
    """The pair after some cycles; figures as in summary.json."""

    cycles: float
    """Revolutions of the pinion."""
    pinion: GearReport
    """Wear of the pinion."""
    wheel: GearReport
    """Wear of the wheel."""
    max_pressure_MPa: float
    """Largest contact pressure of a tooth's engagement, away from the starts of linear reliefs."""
    kink_pressure_MPa: float
    """Contact pressure over the start of a linear relief, for the ideal kink of flanks that are not worn; null where
    there is none."""
    transmission_error_peak_to_peak_um: float
    """Largest minus smallest transmission error of the pitch."""
    mesh_stiffness_N_per_mm_um: float
    """Tangent stiffness, mean over the pitch."""
    loss_percent: float
    """Friction work over the input work of the pitch."""
    balance_error: float
    """Error of the energy balance over the pitch."""


@dataclass(frozen=True)
class WearReport:
    """Content of wear.json."""

    K_over_H_mm2_per_N: Mapping[str, float]
    """Archard's coefficient over the hardness, of pinion and wheel."""
    blocks: int
    """Number of blocks of cycles."""
    refused_blocks: int
    """Longer blocks that were tried and rejected."""
    largest_block_error: float
    """Largest estimated error of a block: volume worn off in the wrong place over its whole worn volume."""
    reports: tuple[PairReport, ...]
    """The pair at the beginning and at each report."""


WEAR = Record("wear.json", WearReport)


@dataclass(frozen=True)
class WornPair:
    """The pair after some cycles.

    cycles: revolutions of the pinion.
    run: the pitch solved on the worn flanks.
    worn: depths worn off pinion and wheel in the study, as charts on the flanks' nodes.
    volumes: worn off a tooth of each [mm³].
    """

    cycles: float
    run: RunData
    worn: tuple[FlankChart, FlankChart]
    volumes: tuple[float, float]

    def inner(self, gear: Member) -> Bools:
        """(k,) which diameters of the chart are between the edge margins, in which pressure and wear are singular."""
        low, high = inner_arcs(self.run.pair, gear)
        arcs = self.worn[gear].arcs(self.run.pair.gears[gear])
        return np.asarray((arcs >= low) & (arcs <= high))

    def profile(self, gear: Member) -> tuple[Floats, Floats]:
        """Diameters (k,) [mm] between the edge margins, and worn depth (k,) [µm] there, mean over the face."""
        inner, chart = self.inner(gear), self.worn[gear]
        return chart.diameters[inner], 1e3 * _mean(chart)[inner]

    def report(self) -> PairReport:
        """The figures of the pair for wear.json."""
        row = friction_rows(self.run)[0]
        return PairReport(
            cycles=self.cycles, pinion=self._gear(Member.PINION), wheel=self._gear(Member.WHEEL),
            max_pressure_MPa=row.max_pressure_MPa, kink_pressure_MPa=row.kink_pressure_MPa,
            transmission_error_peak_to_peak_um=row.transmission_error_peak_to_peak_um,
            mesh_stiffness_N_per_mm_um=row.mesh_stiffness_N_per_mm_um, loss_percent=row.loss_percent,
            balance_error=row.balance_error,
        )

    def _gear(self, gear: Member) -> GearReport:
        chart, inner = self.worn[gear], self.inner(gear)
        depth = np.where(inner[:, None], chart.depth, -np.inf)
        row, column = np.unravel_index(int(np.argmax(depth)), depth.shape)
        pitch = float(np.interp(self.run.pair.working_pitch_diameters[gear], *self.profile(gear)))
        return GearReport(
            1e3 * float(depth[row, column]), float(chart.diameters[row]), float(chart.heights[column]), pitch,
            self.volumes[gear],
        )


@dataclass(frozen=True)
class WornRun:
    """A finished study.

    scene: its scene.
    rows: of all blocks.
    pairs: at the beginning and at each report.
    vibrations: at the beginning and after each block; empty under a constant torque.
    """

    scene: Scene
    rows: tuple[BlockRow, ...]
    pairs: tuple[WornPair, ...]
    vibrations: tuple[VibrationRow, ...] = ()


def read_worn(folder: Path) -> WornRun:
    """The finished study in `folder`. Raises SceneError; ArchiveError where there is none."""
    scene = kept_scene(folder / "scene.toml")
    study = read_checkpoint(Archive(folder, scene))
    if scene.wear is None or study is None or study.cycles < scene.wear.cycles:
        found = "a scene without [wear]" if scene.wear is None else "one that has not reached its last report"
        raise ArchiveError(f"{folder}: wanted a finished wear study, found {found}; `evolvent run ... --resume`")
    volumes = {0.0: (0.0, 0.0)} | {row.cycles: (row.volume_pinion_mm3, row.volume_wheel_mm3) for row in study.rows}
    ends = np.array(list(volumes))
    pairs = []
    for cycles in (0.0, *scene.wear.reports):
        pair_folder = worn_folder(folder, cycles)
        chart_folder = pair_folder if cycles else worn_folder(folder, scene.wear.reports[0])
        charts = [_worn(scene, chart_folder, gear) for gear in Member]
        if cycles == 0.0:
            charts = [FlankChart(c.diameters, c.heights, np.zeros_like(c.depth)) for c in charts]
        volume = volumes[float(ends[np.argmin(np.abs(ends - cycles))])]
        pairs.append(WornPair(cycles, read_run(pair_folder), (charts[0], charts[1]), volume))
    return WornRun(scene, study.rows, tuple(pairs), study.vibrations)


def _worn(scene: Scene, folder: Path, gear: Member) -> FlankChart:
    """The depth worn off a flank: its chart minus that of the beginning."""
    chart = FlankChart.read(folder / f"flank_{GEARS[gear]}.csv")
    before = scene.flank_chart(GEARS[gear])
    if before is None:
        return chart
    geometry = scene.gear_pair().gears[gear]
    d, z = np.meshgrid(chart.diameters, chart.heights, indexing="ij")
    roll = np.sqrt(np.maximum(d.ravel() ** 2 / 4.0 - geometry.base_radius**2, 0.0))
    earlier = before.at(geometry, roll, z.ravel()).reshape(d.shape)
    return FlankChart(chart.diameters, chart.heights, chart.depth - earlier)


def _mean(chart: FlankChart) -> Floats:
    """Mean (k,) over the face by the trapezoid rule."""
    if len(chart.heights) == 1:
        return chart.depth[:, 0]
    return np.asarray(trapezoid(chart.depth, chart.heights, axis=1) / np.ptp(chart.heights))


def wear_report(study: WornRun) -> WearReport:
    """The figures at each report, for wear.json."""
    wear = study.scene.wear
    assert wear is not None
    return WearReport(
        {"pinion": wear.pinion_mm2_per_N, "wheel": wear.wheel_mm2_per_N},
        blocks=len(study.rows), refused_blocks=sum(row.refused for row in study.rows),
        largest_block_error=max(row.error for row in study.rows), reports=tuple(pair.report() for pair in study.pairs),
    )
