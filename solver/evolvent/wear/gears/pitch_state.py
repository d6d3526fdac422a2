"""A pitch solved on worn flanks, and the state from which its vibration is resumed."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.dynamics.operating_point import Operation
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import SearchedAt, SharedPosition
from evolvent.wear.block_stepping import CycleEvaluation
from evolvent.wear.gears.passage import MeshPassage
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class PitchState(CycleEvaluation):
    """A pitch solved on worn flanks.

    positions: results of all positions.
    work: ∫∫p|v_s| dA dt of a tooth's passage [N·mm; per mm of width in 2D].
    shared: searches and compliances of this rank's positions, reused in the next cycle.
    searched: number of positions that were searched anew, on all ranks.
    mesh_updates: number of mesh updates before.
    points: contact points of this rank's positions without friction.
    passage: their mesh passage.
    operation: the vibration under whose mesh force it was solved; None under the constant torque.
    """

    positions: tuple[PositionResult, ...]
    work: float
    shared: tuple[SharedPosition, ...]
    searched: int
    mesh_updates: int
    points: tuple[ContactPoints, ...]
    passage: MeshPassage
    operation: Operation | None = None


@dataclass(frozen=True, eq=False)
class Vibration:
    """State from which the vibration of a wearing pair is resumed."""

    state: Floats
    """Coordinate s [mm] and velocity ṡ [mm/s] (2,) at phase 0."""
    forces: tuple[float, float]
    """Smallest and largest mesh force over the static one."""
    torques: tuple[float, ...]
    """Torques under which the excitation was solved [N·mm]; empty where its searches are not kept."""
    searches: tuple[SearchedAt, ...]
    """Places where the contact of the excitation was searched, of all positions and torques; empty where they are not
    kept."""
