"""A gear's sector mesh and its loaded flank, condensed or not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent.fem.lagrange import gmsh_permutation
from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.meshing.levelled_meshes import LevelledMesh, SectorMesh, run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.two_level_gear import levelled_flank
from evolvent_meshes.arrays import Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData


@dataclass(frozen=True)
class MeshedGear:
    """The sector of tooth 0 and its flank, in the gear's frame."""

    mesh: MeshData
    """Mesh of the sector."""
    flank: Surface
    """Loaded flank."""
    has_levels: bool = False
    """Whether the flank is finer than the sector; else its nodes are the sector's."""

    @property
    def flank_facets(self) -> Ints:
        """Points (m, k) of the flank's facets, in the order of gmsh."""
        from_gmsh = gmsh_permutation(self.flank.shape, self.flank.order)
        return self.flank.facets[:, np.argsort(from_gmsh)]

    @staticmethod
    def of(body: GearBody) -> MeshedGear:
        """Sector and flank of a condensed gear."""
        return MeshedGear(body.mesh, body.flank, bool(body.levels))


def meshed_gear(
    problem: GearProblem, member: Member, mesh: Callable[[GearProblem, Member], SectorMesh] = run_mesh
) -> MeshedGear:
    """Sector and flank of the pinion or the wheel, without condensing it. mesh: makes the sector. Raises MeshError,
    TooMuchRelief."""
    sector = mesh(problem, member)
    if isinstance(sector, LevelledMesh):
        return MeshedGear(sector.mesh, levelled_flank(problem, member, sector), True)
    return MeshedGear(sector, surface_of(sector, "flank"))
