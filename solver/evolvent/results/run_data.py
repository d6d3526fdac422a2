"""A finished run in memory: what tables, fields and pictures are made from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from evolvent.gears.sweep.pitch_sweep import SweptPosition
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.archive import Archive, ArchiveError, GearShape
from evolvent.results.archive.error_bar_data import NOT_ESTIMATED, EstimatedErrors, wanted_errors
from evolvent.results.contact_slices import Slices, ToothSummary, slices, tooth_summaries
from evolvent.results.tip_zones import path_between_zones, row_before_tip
from evolvent.scene.scene import Scene, load_scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class FlankNodes:
    """The loaded flank's nodes of a gear's tooth 0 in its own frame: points (n, 3) [mm]."""

    gear: GearParameters
    points: Floats

    @property
    def z(self) -> Floats:
        """Heights (n,) [mm]."""
        return self.points[:, 2]

    @property
    def roll_length(self) -> Floats:
        """Transverse curvature radii √(r² − r_b²) (n,) [mm]."""
        r = np.hypot(self.points[:, 0], self.points[:, 1])
        return np.sqrt(np.maximum(r**2 - self.gear.base_radius**2, 0.0))


@dataclass(frozen=True)
class SolvedPosition:
    """One position at one friction coefficient, and what is read from it. 2D values are per mm of width."""

    result: PositionResult
    cut: Slices
    teeth: tuple[ToothSummary, ...]


@dataclass(frozen=True)
class RunData:
    """A scene and its results over one base pitch.

    shapes: surfaces of (pinion, wheel). positions: (positions of the pitch, friction coefficients).
    errors: the figures' error bars.
    """

    scene: Scene
    shapes: tuple[GearShape, GearShape]
    positions: tuple[tuple[SolvedPosition, ...], ...]
    errors: EstimatedErrors = NOT_ESTIMATED

    @cached_property
    def pair(self) -> GearPair:
        """The scene's gears."""
        return self.scene.gear_pair()

    @cached_property
    def plane(self) -> bool:
        """True where the scene was solved in 2D."""
        return is_plane(self.shapes[0])

    @property
    def width(self) -> float:
        """By which results must be multiplied: the face width [mm] of a 2D run, 1 in 3D."""
        return self.pair.face_width if self.plane else 1.0

    @property
    def frictions(self) -> tuple[float, ...]:
        """The friction coefficients, in the order of the results."""
        return tuple(solved.result.friction for solved in self.positions[0])

    @property
    def angles(self) -> Floats:
        """Nominal pinion rotations (positions,) [rad] of the pitch."""
        return np.array([each[0].result.stand.angle for each in self.positions])

    @property
    def pitch(self) -> float:
        """Pinion rotation of a base pitch, 2π/z_1 [rad]."""
        return 2.0 * np.pi / self.pair.pinion.z

    @cached_property
    def inner_path(self) -> tuple[float, float]:
        """Roll distances [mm] between which no slice of any position bears on a tip edge."""
        cuts = [(solved.result, solved.cut) for each in self.positions for solved in each]
        flanks = [flank_nodes(gear, shape) for gear, shape in zip(self.pair.gears, self.shapes)]
        rows = [row_before_tip(flank.roll_length, self.scene.mesh.order) for flank in flanks]
        return path_between_zones(self.pair, cuts, (rows[0], rows[1]))

    @cached_property
    def flank(self) -> FlankNodes:
        """The pinion's flank nodes, in the order of PositionResult.node."""
        return flank_nodes(self.pair.pinion, self.shapes[0])


@dataclass(frozen=True)
class Companion:
    """The companion's run, on rank 0; None on the others, and where it failed for the reason `failure`."""

    run: RunData | None
    failure: str
    seconds: float



def flank_nodes(gear: GearParameters, shape: GearShape) -> FlankNodes:
    """The nodes of a gear's loaded flank."""
    return FlankNodes(gear, shape.points[shape.flank_nodes])


def is_plane(shape: GearShape) -> bool:
    """True if the shape comes from a 2D mesh."""
    return "face_low" not in shape.facets


def run_data(scene: Scene, shapes: tuple[GearShape, GearShape], swept: Sequence[SweptPosition]) -> RunData:
    """Puts a run together. Raises ArchiveError where no position of the pitch is there yet."""
    if not swept:
        raise ArchiveError("wanted at least one position of the pitch, found none; let the run go on with --resume")
    flank, materials = flank_nodes(scene.gear_pair().pinion, shapes[0]), scene.materials()

    def solved(result: PositionResult) -> SolvedPosition:
        cut = slices(result, flank.z, materials)
        return SolvedPosition(result, cut, tuple(tooth_summaries(result, cut)))

    return RunData(scene, shapes, tuple(tuple(solved(r) for r in position.results) for position in swept))


def read_run(folder: Path) -> RunData:
    """The run that `folder` holds: OUT/scene.toml and OUT/results. Raises SceneError, ArchiveError."""
    scene = load_scene(folder / "scene.toml")
    archive = Archive(folder, scene)
    run = run_data(scene, archive.read_gears(), archive.read_positions(scene.gear_pair()))
    return replace(run, errors=wanted_errors(archive) or run.errors)
