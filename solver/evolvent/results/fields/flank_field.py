"""Pressure of a position as a smooth field over the exact flank, for maps, pictures and the mating flank.

The contact is a narrow ridge of pressure that crosses the rows of cells at an angle. Interpolation along z would turn a
ridge a few points wide into separate spots. Interpolation along the contact line, at equal distance s from it, keeps
it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.fields.polygons import Polygons
from evolvent.results.run_data import RunData, flank_nodes
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

POINTS = (420, 160)
"""Points on a flank, along the profile and across the face, in a picture of about 1000 pixels."""


@dataclass(frozen=True)
class FlankField:
    """Pressure on the flanks of one tooth pair at a position."""

    heights: Floats
    """(h,), heights z of the node rows, ascending [mm]."""
    distances: tuple[Floats, ...]
    """Arc lengths of each row, along the profile from the contact line to its nodes in contact, ascending and positive
    towards the pinion's tip [mm]; empty where none is in contact."""
    values: tuple[Floats, ...]
    """Pressures of each row at these distances [MPa]."""

    def at(self, distance: Floats, z: Floats) -> Floats:
        """Pressure (n, m) [MPa] at distances (n, m) from the contact line [mm] and heights z (m,) [mm] of the columns;
        0 outside the contact."""
        last = len(self.heights) - 1
        if last == 0:
            return np.column_stack([self._row(0, column) for column in distance.T])
        below = np.clip(np.searchsorted(self.heights, z, side="right") - 1, 0, last - 1)
        part = np.clip((z - self.heights[below]) / (self.heights[below + 1] - self.heights[below]), 0.0, 1.0)
        columns = [
            (1.0 - t) * self._row(k, column) + t * self._row(k + 1, column)
            for k, t, column in zip(below, part, distance.T)
        ]
        return np.column_stack(columns)

    def _row(self, k: int, distance: Floats) -> Floats:
        if len(self.distances[k]) == 0:
            return np.zeros_like(distance)
        return np.interp(distance, self.distances[k], self.values[k], left=0.0, right=0.0)


def flank_field(run: RunData, result: PositionResult, tooth: int) -> FlankField:
    """The pressure on a tooth pair at a position, from its nodal averages. tooth: index of the pair."""
    here = np.flatnonzero(result.tooth == tooth)
    nodes = result.node[here]
    z, p = np.round(run.flank.z, 9), result.pressure[here]
    s = line_distance(run.pair, result, tooth, Member.PINION, run.flank.roll_length[nodes], z[nodes])
    heights = np.unique(z)
    members = [np.flatnonzero(z[nodes] == height) for height in heights]
    rows = [row[np.argsort(s[row])] for row in members]
    return FlankField(heights, tuple(s[row] for row in rows), tuple(p[row] for row in rows))


def line_distance(
    pair: GearPair, result: PositionResult, tooth: int, gear: Member, roll_length: Floats, z: Floats
) -> Floats:
    """Arc length s along the profile [mm] from the nominal contact line to points of a gear's flank, positive towards
    the pinion's tip and the wheel's root; s = (ρ² − ρ_line²)/2r_b on an involute. roll_length, z: ρ and heights of the
    points [mm], of shapes that broadcast."""
    base = pair.gears[gear].base_radius
    line = pair.pitch_point_roll_lengths[gear] + gear.sign * result.stand.roll_distance(tooth, z)
    return np.asarray(gear.sign * (roll_length**2 - np.sign(line) * line**2) / (2.0 * base))


@dataclass(frozen=True)
class Patch:
    """A rectangular grid on the exact flank of a gear's tooth 0."""

    gear: Member
    """Pinion or wheel."""
    roll_length: Floats
    """(n,), roll lengths ρ of the rows [mm]."""
    z: Floats
    """(m,), heights of the columns [mm]."""

    def polygons(self, run: RunData) -> Polygons:
        """Surface of the patch in the gear's own frame, its points row by row."""
        ρ, z = np.meshgrid(self.roll_length, self.z, indexing="ij")
        points = Flank(run.pair.gears[self.gear]).point(ρ, z).reshape(-1, 3)
        number = np.arange(ρ.size).reshape(ρ.shape)
        quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
        return Polygons(points, (quads.reshape(-1, 4),))

    def values(self, run: RunData, result: PositionResult, tooth: int, field: FlankField) -> Floats:
        """Pressure (n, m) [MPa] of a tooth pair's field on the patch."""
        ρ, z = np.meshgrid(self.roll_length, self.z, indexing="ij")
        return field.at(line_distance(run.pair, result, tooth, self.gear, ρ, z), self.z)


def flank_patch(run: RunData, gear: Member, count: tuple[int, int] = POINTS) -> Patch:
    """The whole meshed flank of a gear. count: numbers of points along the profile and across the face."""
    ρ = flank_nodes(run.pair.gears[gear], run.shapes[gear]).roll_length
    half = 0.5 * run.pair.gears[gear].face_width
    return Patch(gear, np.linspace(ρ.min(), ρ.max(), count[0]), np.linspace(-half, half, count[1]))
