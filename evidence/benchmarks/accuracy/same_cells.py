"""Gears whose flanks have levels of their own, and exact condensation of the very same cells."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from mpi4py import MPI

from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshing.flank_levels import LevelledSector, levelled_sector
from evolvent.gears.meshing.levelled_meshes import levelled_mesh
from evolvent.gears.meshing.sector_meshes import unmodified
from evolvent.gears.meshing.sector_sizes import finest_cells
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.two_level.flank_cells import FlankCells
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.flank_refinement import coarse_body
from evolvent.gears.two_level_gear import modified_flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.patches import cut_out


def two_level_model(problem: GearProblem) -> GearModel:
    """Condensed in levels, on this rank alone. problem: with `two_level`."""
    return prepare_model(problem, MPI.COMM_SELF).model


def exact_model(problem: GearProblem, levels: GearModel) -> GearModel:
    """The same cells, condensed exactly; minutes and gigabytes. levels: the same problem's `two_level_model`."""
    pinion, wheel = (exact_gear(problem, member) for member in Member)
    return replace(levels, bodies=(pinion, wheel))


@dataclass(frozen=True, kw_only=True)
class ExactGear(GearBody):
    """A gear condensed exactly, on whose flank the contact has cells of its own, as on levels."""

    plain: Surface
    """Flank of the gear without modifications."""

    @cached_property
    def cells(self) -> FlankCells:
        """Facets of the flank by row and layer."""
        return FlankCells.of(FlankLattice.of(self.plain.points), self.flank, self.gear.base_radius)


def exact_gear(problem: GearProblem, member: Member) -> GearBody:
    """Condensed without flank modifications, as the levels are; its flank has them."""
    gear, material = problem.pair.gears[member], problem.materials[member]
    plain = unmodified(gear)
    mesh, carries = split_sector(problem, member), member is Member.PINION
    body = condensed_gear(plain, mesh, material, problem.contact_teeth, member, carries)
    kept = {each.name: getattr(body, each.name) for each in fields(body)}
    levels, flank = levelled_sector(problem, member).levels, modified_flank(body.flank, gear)
    return ExactGear(**kept | {"gear": gear, "flank": flank, "levels": levels}, plain=body.flank)


def split_sector(problem: GearProblem, member: Member) -> MeshData:
    """The coarse sector, split everywhere as each level splits it near the flank, then moved onto the flank."""
    mesh, plain = levelled_mesh(problem, member).mesh, unmodified(problem.pair.gears[member])
    for level in levelled_sector(problem, member).levels:
        body = coarse_body(plain, mesh, problem.materials[member], level)
        split = body.split_patch(cut_out(mesh, np.arange(len(mesh.cells)))).mesh
        mesh = replace(split, facets={name: split.facets[name] for name in mesh.facets})  # nothing was cut out
    return mesh


def fine_nodes(sector: LevelledSector) -> int:
    """Nodes of the flank on the finest level."""
    rows, layers = finest_cells(sector)
    return (2 * rows + 1) * (2 * layers + 1)
