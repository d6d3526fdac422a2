"""Archived data of the meshes of a run: surfaces of both sectors for pictures, counts and quality for the tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.meshed_gear import MeshedGear
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.quality import scaled_jacobians


@dataclass(frozen=True)
class GearShape:
    """Surface of a gear's sector with tooth 0, in the gear's own frame."""

    points: Floats
    """(n, 3), nodes of the sector mesh, then those of a flank with levels of its own [mm]."""
    facets: dict[str, Ints]
    """Name -> (f, k), nodes of the facets of a part of the boundary, in gmsh's order: "flank", "back", "tip", "fillet",
    "face_low", "face_high", "bore"."""
    flank_nodes: Ints
    """(m,), index into `points` of each flank node, in the order of PositionResult.node."""


@dataclass(frozen=True)
class MeshRecord:
    """Surfaces, size and quality of the meshes of both gears, for the output."""

    shapes: tuple[GearShape, GearShape]
    """Surfaces of pinion and wheel."""
    dofs: int
    """Degrees of freedom of both sectors."""
    flank_dofs: int
    """Degrees of freedom of both flanks on the finest of their own levels; 0 where they have none."""
    cells: int
    """Cells of both sectors."""
    min_scaled_jacobian: float
    """Smallest scaled Jacobian of the cells of both sectors."""

    @staticmethod
    def of(gears: Sequence[MeshedGear]) -> MeshRecord:
        """The record of the meshes of pinion and wheel."""
        pinion, wheel = (gear_shape(gear) for gear in gears)
        return MeshRecord(
            shapes=(pinion, wheel),
            dofs=sum(gear.mesh.points.shape[0] * gear.mesh.dimension for gear in gears),
            flank_dofs=sum(gear.flank.points.size for gear in gears if gear.has_levels),
            cells=sum(len(gear.mesh.cells) for gear in gears),
            min_scaled_jacobian=min(float(scaled_jacobians(gear.mesh).min()) for gear in gears),
        )


def gear_shape(gear: MeshedGear) -> GearShape:
    """The surface of a sector; its flank is that on which contact is computed."""
    points, facets, flank = gear.mesh.points, dict(gear.mesh.facets), gear.flank
    if not gear.has_levels:
        return GearShape(points, facets, flank.nodes)
    facets["flank"] = len(points) + gear.flank_facets
    own = len(points) + np.arange(len(flank.points))
    return GearShape(np.concatenate([points, flank.points]), facets, own)
