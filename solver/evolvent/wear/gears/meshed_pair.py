"""The meshes of a gear pair that wears, and the part of the worn depth that they include.

Depths (n,) are those of the pinion's flank nodes, then of the wheel's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evolvent.fem.surface import Surface
from evolvent.gears.gear_model import GearModel
from evolvent.wear.gears.flank_grid import FlankGrid
from evolvent.wear.mesh_motion import WornSurface, certify_mesh_volume, worn_mesh
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.input_checks import Words, refuse
from evolvent_meshes.mesh.mesh_data import MeshData

HELD = "bore", "bore_free", "recess", "cut_low", "cut_high", "fillet", "back", "tip"
"""Facet groups of a sector that stay at rest when its mesh follows the wear; plane end faces slide in themselves."""
MESHABLE_SLOPE = 0.01
"""Largest slope of the depth that a mesh follows: half a degree. Steeper is only the wear of a tip edge, narrow as a
cell."""


@dataclass(frozen=True)
class GearMeshMotion:
    """When and how the meshes of a gear pair follow the wear.

    depth: depth that the meshes may lack, of what they can follow [mm].
    condense: makes the condensed gears from the mesh of each.
    """

    depth: float
    condense: Callable[[Callable[[Member], MeshData]], GearModel]


@dataclass(frozen=True)
class MeshedPair:
    """Both gears as meshed and condensed.

    model: condensed gears on the present meshes.
    grids: of pinion and wheel flank.
    unworn: meshes and flanks without wear, from which all moved meshes are made.
    mesh_depth: (n,) depth that the meshes include [mm].
    mesh_updates: number of times that the meshes have followed the wear.
    """

    model: GearModel
    grids: tuple[FlankGrid, FlankGrid]
    unworn: tuple[tuple[MeshData, Surface], ...]
    mesh_depth: Floats
    mesh_updates: int = 0

    @staticmethod
    def of(model: GearModel) -> MeshedPair:
        """The meshed pair of gears without wear in their meshes. Raises InputError where the nodes of a flank are no
        grid, and where flanks have levels of their own."""
        if any(body.levels for body in model.bodies):
            remedy = "write MeshSettings(two_level=False)"
            refuse("wear", "gears whose flanks are those of their meshes", Words("flanks with levels"), remedy)
        grids = FlankGrid.of(model.bodies[0]), FlankGrid.of(model.bodies[1])
        unworn = tuple((body.mesh, body.flank) for body in model.bodies)
        return MeshedPair(model, grids, unworn, np.zeros(sum(grid.node.size for grid in grids)))

    @cached_property
    def areas(self) -> Floats:
        """(n,) areas of all flank nodes [mm²; mm in 2D]."""
        return np.concatenate([grid.areas for grid in self.grids])

    def by_gear(self, depth: Floats) -> tuple[Floats, Floats]:
        """Depths of the pinion's and of the wheel's flank nodes."""
        first = self.grids[0].node.size
        return depth[:first], depth[first:]

    def meshable(self, depth: Floats) -> Floats:
        """The part of depths (n,) [mm] that meshes can follow. What is steeper than MESHABLE_SLOPE, such as the wear of
        tip edges, stays in the gap."""
        limited = [grid.slope_limited(own, MESHABLE_SLOPE) for grid, own in zip(self.grids, self.by_gear(depth))]
        return np.concatenate(limited)

    def lacking(self, depth: Floats) -> float:
        """Largest difference [mm] between what meshes can follow of depths (n,) and what these include."""
        return float(np.abs(self.meshable(depth) - self.mesh_depth).max())

    def with_gap(self, depth: Floats) -> GearModel:
        """The gears with the part of depths (n,) in the gap that the meshes do not include."""
        gaps = self.by_gear(depth - self.mesh_depth)
        pinion, wheel = (replace(body, worn=gap) for body, gap in zip(self.model.bodies, gaps))
        return replace(self.model, bodies=(pinion, wheel))

    def moved(self, depth: Floats, motion: GearMeshMotion) -> MeshedPair:
        """The gears with meshes that include what they can of depths (n,), condensed anew.

        Raises MeshInverted, MeshVolumeLost.
        """
        mesh_depth = self.meshable(depth)
        by_gear = self.by_gear(mesh_depth)

        def mesh_of(gear: Member) -> MeshData:
            unworn, flank = self.unworn[gear]
            held = [name for name in HELD if name in unworn.facets]
            mesh = worn_mesh(unworn, [WornSurface(flank, by_gear[gear])], held)
            certify_mesh_volume(unworn, mesh, float(flank.weights() @ by_gear[gear]))
            return mesh

        return replace(self, model=motion.condense(mesh_of), mesh_depth=mesh_depth, mesh_updates=self.mesh_updates + 1)
