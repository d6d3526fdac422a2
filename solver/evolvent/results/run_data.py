"""A finished run in memory, from which tables, fields and pictures are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from evolvent.gears.pressure.contact_slices import Slices, ToothSummary, slices, tooth_summaries
from evolvent.gears.pressure.flank_facets import FlankFacets
from evolvent.gears.pressure.tip_zones import path_between_zones
from evolvent.gears.sweep.pitch_sweep import SweptPosition
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.error_bar_data import NOT_ESTIMATED, EstimatedErrors, requested_error_bars
from evolvent.results.archive.gear_shapes import GearShape
from evolvent.results.archive.store import ArchiveError
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import LINE
from evolvent.scene.scene import Scene, kept_scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class FlankNodes:
    """Nodes of the loaded flank of a gear's tooth 0."""

    gear: GearParameters
    """Pinion or wheel."""
    points: Floats
    """(n, 3), nodes in the gear's own frame [mm]."""

    @property
    def z(self) -> Floats:
        """(n,) heights of the nodes [mm]."""
        return self.points[:, 2]

    @property
    def roll_length(self) -> Floats:
        """(n,) transverse curvature radii √(r² − r_b²) at the nodes [mm]."""
        r = np.hypot(self.points[:, 0], self.points[:, 1])
        return np.sqrt(np.maximum(r**2 - self.gear.base_radius**2, 0.0))


@dataclass(frozen=True)
class SolvedPosition:
    """One position at one friction coefficient, evaluated by slices and teeth. Values of a 2D run are per mm of
    width."""

    result: PositionResult
    """Contact solution of the position."""
    cut: Slices
    """Contact in slices across the face width."""
    teeth: tuple[ToothSummary, ...]
    """Results of the tooth pairs in contact, in ascending order of their index."""
    unloaded_error: float
    """Transmission error of the rigid flanks at this position, without load [mm]; NaN where none face each other."""


@dataclass(frozen=True)
class RunData:
    """A scene and its results over one angular pitch."""

    scene: Scene
    """The scene as it was solved."""
    shapes: tuple[GearShape, GearShape]
    """Sector surfaces of pinion and wheel."""
    positions: tuple[tuple[SolvedPosition, ...], ...]
    """Positions of the pitch, each with its results at all friction coefficients."""
    errors: EstimatedErrors = NOT_ESTIMATED
    """Error bars of the engineering figures."""

    @cached_property
    def pair(self) -> GearPair:
        """The gear pair of the scene."""
        return self.scene.gear_pair()

    @cached_property
    def plane(self) -> bool:
        """Whether the scene was solved in 2D."""
        return is_plane(self.shapes[0])

    @property
    def is_line(self) -> bool:
        """Whether the scene was solved in line contact, which has no pressure of its own across the contact."""
        return self.scene.mesh.level == LINE

    @property
    def width(self) -> float:
        """Factor from results to values of the whole face: the face width [mm] in 2D, 1 in 3D."""
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
        """Angular pitch 2π/z_1 of the pinion [rad]."""
        return 2.0 * np.pi / self.pair.pinion.z

    @cached_property
    def inner_path(self) -> tuple[float, float]:
        """Roll distances [mm] between which no slice of any position bears on a tip edge."""
        cuts = [(solved.result, solved.cut) for each in self.positions for solved in each]
        pinion, wheel = flank_facets(self.pair, self.shapes, self.scene.mesh.order)
        return path_between_zones(self.pair, cuts, (pinion.row_before_tip, wheel.row_before_tip))

    @cached_property
    def flank(self) -> FlankNodes:
        """Nodes of the pinion's loaded flank, in the order of PositionResult.node."""
        return flank_nodes(self.pair.pinion, self.shapes[0])


def flank_nodes(gear: GearParameters, shape: GearShape) -> FlankNodes:
    """Nodes of a gear's loaded flank, in the order of GearShape.flank_nodes."""
    return FlankNodes(gear, shape.points[shape.flank_nodes])


def flank_facets(pair: GearPair, shapes: tuple[GearShape, GearShape], order: int) -> tuple[FlankFacets, FlankFacets]:
    """The facets of both loaded flanks. order: of the cells."""
    nodes = [flank_nodes(gear, shape) for gear, shape in zip(pair.gears, shapes)]
    pinion, wheel = (FlankFacets.of(each.z, each.roll_length, each.gear.base_radius, order) for each in nodes)
    return pinion, wheel


def is_plane(shape: GearShape) -> bool:
    """Whether the shape comes from a 2D mesh."""
    return "face_low" not in shape.facets


def run_data(scene: Scene, shapes: tuple[GearShape, GearShape], swept: Sequence[SweptPosition]) -> RunData:
    """The run with these positions. Raises ArchiveError if there is no position."""
    if not swept:
        raise ArchiveError("wanted at least one position of the pitch, found none; `evolvent run ... --resume` goes on")
    flanks, materials = flank_facets(scene.gear_pair(), shapes, scene.mesh.order), scene.materials()

    problem, angles = gear_problem(scene), np.array([position.results[0].stand.angle for position in swept])
    unloaded = unloaded_error(RigidFlanks(problem.pair, problem.flanks), angles, problem.torque_on)

    def solved(result: PositionResult, error: float) -> SolvedPosition:
        cut = slices(result, flanks, materials, scene.mesh.level == LINE)
        return SolvedPosition(result, cut, tuple(tooth_summaries(result, cut)), error)

    positions = (tuple(solved(each, error) for each in one.results) for one, error in zip(swept, unloaded.tolist()))
    return RunData(scene, shapes, tuple(positions))


def archived_run(archive: Archive) -> RunData:
    """The run in an archive, without error bars. Raises ArchiveError."""
    scene = archive.scene
    return run_data(scene, archive.read_gears(), archive.read_positions(scene.gear_pair()))


def read_run(folder: Path) -> RunData:
    """The run in the folder OUT, from OUT/scene.toml and OUT/results. Raises SceneError, ArchiveError."""
    archive = Archive(folder, kept_scene(folder / "scene.toml"))
    run = archived_run(archive)
    return replace(run, errors=requested_error_bars(archive) or run.errors)
