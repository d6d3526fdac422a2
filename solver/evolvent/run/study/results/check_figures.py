"""What `check` of a study finds of a scene without computing it: figures of its geometry, load and size."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from evolvent.check.check_report import overview
from evolvent.check.problem_size import memory_megabytes, sector_sizes
from evolvent.check.scene_warnings import scene_warnings
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.scene.scene import Scene

CHECK, REPORT = "check.json", "check.txt"


@dataclass(frozen=True)
class CheckFigures:
    """check.json: what follows from a scene before it is computed."""

    centre_distance_mm: float
    """a."""
    transverse_contact_ratio: float
    """ε_α."""
    overlap_ratio: float
    """ε_β."""
    total_contact_ratio: float
    """ε_γ."""
    normal_backlash_um: float
    """j_bn."""
    pinion_tip_thickness_mm: float
    """Normal tooth thickness at the tip, s_an, without chamfer or rounding, which leave less."""
    wheel_tip_thickness_mm: float
    """The same of the wheel."""
    pitch_point_pressure_MPa: float
    """Hertz pressure at the pitch point, on the mean length of the contact lines."""
    degrees_of_freedom: int
    """Of one sector of both gears."""
    memory_MB: float
    """Of a run on one rank, estimated."""


def run_check(scene: Scene, out: Path) -> list[str]:
    """Writes the report that `evolvent check` prints, and its figures; returns the scene's warnings. Raises WriteError,
    FolderError."""
    text = json.dumps(asdict(check_figures(scene)), ensure_ascii=False, indent=1) + "\n"
    with locked(out):
        folder = RunFolder(out)
        folder.write_text(REPORT, overview(scene) + "\n")
        folder.write_text(CHECK, text)
    return list(scene_warnings(scene))


def check_figures(scene: Scene) -> CheckFigures:
    """Of a valid scene."""
    pair = scene.gear_pair()
    pinion, wheel = (gear.normal_thickness(gear.tip_diameter) for gear in pair.gears)
    return CheckFigures(
        pair.centre_distance, pair.transverse_contact_ratio, pair.overlap_ratio, pair.total_contact_ratio,
        1e3 * pair.normal_backlash, float(pinion), float(wheel), float(scene.hertz_estimate().peak_pressure(0.0)),
        sum(size.dofs for size in sector_sizes(scene)), memory_megabytes(scene),
    )
