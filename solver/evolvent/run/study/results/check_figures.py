"""Figures of a scene that `check` of a study gives without computing it: geometry, load and size."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evolvent.check.check_report import overview
from evolvent.check.problem_size import memory_megabytes, sector_sizes
from evolvent.check.scene_warnings import scene_warnings
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.tables.table import Record
from evolvent.scene.scene import Scene

REPORT = "check.txt"


@dataclass(frozen=True)
class CheckFigures:
    """check.json: figures of a scene that are known before it is computed."""

    centre_distance_mm: float
    """Centre distance a."""
    transverse_contact_ratio: float
    """Transverse contact ratio ε_α."""
    overlap_ratio: float
    """Overlap ratio ε_β."""
    total_contact_ratio: float
    """Total contact ratio ε_γ."""
    normal_backlash_um: float
    """Normal backlash j_bn."""
    pinion_tip_thickness_mm: float
    """Normal tooth thickness at the tip of the pinion, s_an, without chamfer or rounding, which leave less."""
    wheel_tip_thickness_mm: float
    """Normal tooth thickness at the tip of the wheel, s_an, without chamfer or rounding, which leave less."""
    pitch_point_pressure_MPa: float
    """Hertz pressure at the pitch point, on the mean length of the contact lines."""
    degrees_of_freedom: int
    """Degrees of freedom of one sector of both gears."""
    memory_MB: float
    """Largest memory of a run on one rank, estimated."""


CHECK = Record("check.json", CheckFigures)


def run_check(scene: Scene, out: Path) -> list[str]:
    """Writes the report that `evolvent check` prints, and its figures; returns the scene's warnings. Raises WriteError,
    FolderError."""
    figures = check_figures(scene)
    with locked(out):
        folder = RunFolder(out)
        folder.write_text(REPORT, overview(scene) + "\n")
        CHECK.write(folder, figures)
    return list(scene_warnings(scene))


def check_figures(scene: Scene) -> CheckFigures:
    """Figures of a valid scene."""
    pair = scene.gear_pair()
    pinion, wheel = (gear.normal_thickness(gear.tip_diameter) for gear in pair.gears)
    return CheckFigures(
        centre_distance_mm=pair.centre_distance, transverse_contact_ratio=pair.transverse_contact_ratio,
        overlap_ratio=pair.overlap_ratio, total_contact_ratio=pair.total_contact_ratio,
        normal_backlash_um=1e3 * pair.normal_backlash, pinion_tip_thickness_mm=float(pinion),
        wheel_tip_thickness_mm=float(wheel), pitch_point_pressure_MPa=float(scene.hertz_estimate().peak_pressure(0.0)),
        degrees_of_freedom=sum(size.dofs for size in sector_sizes(scene)), memory_MB=memory_megabytes(scene),
    )
