"""Which meshes a gear pair is condensed from: one fine mesh a sector, or a coarse one with levels on its flank."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from evolvent.gears.meshing.element_sizes import sector_resolution
from evolvent.gears.meshing.flank_levels import FlankLevel, LevelledSector, levelled_sector
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.meshing.sector_sizes import finest_cells, one_mesh_sizes
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.gear_geometry import Modifications
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.sector import sector_mesh

MOST_DOFS = 300_000
"""Degrees of freedom of one fine mesh of both sectors together, from which on levels are used by default: below,
condensing it takes no longer than condensing the patches of a levelled flank."""


@dataclass(frozen=True)
class LevelledMesh:
    """A coarse sector, and the levels of its flank."""

    mesh: MeshData
    """The sector without flank modifications, which do not change its compliance."""
    levels: tuple[FlankLevel, ...]
    """From the coarsest to the finest."""


SectorMesh = MeshData | LevelledMesh
"""What a gear is condensed from."""


def is_two_level(problem: GearProblem) -> bool:
    """Whether the flanks have levels of their own: as the settings say or, by default, where that can be and one fine
    mesh has more than `MOST_DOFS` degrees of freedom."""
    wanted, options = problem.mesh.two_level, problem.options
    if problem.is_plane or wanted is False:
        return False
    if wanted:
        return True
    can_be = (problem.mesh.shape, problem.mesh.order) == ("hexahedron", 2)
    if not can_be or options.whole_gears or options.fine_body:
        return False
    return sum(size.dofs for size in one_mesh_sizes(problem)) > MOST_DOFS


def run_mesh(problem: GearProblem, member: Member) -> SectorMesh:
    """The mesh of the pinion's or the wheel's sector, with levels where the problem has them.

    Raises MeshError, TooMuchRelief.
    """
    return levelled_mesh(problem, member) if is_two_level(problem) else gear_mesh(problem, member)


def levelled_mesh(
    problem: GearProblem, member: Member, adapted: Callable[[LevelledSector], LevelledSector] = lambda sector: sector
) -> LevelledMesh:
    """The coarse sector of the pinion or the wheel with the levels of its flank. adapted: changes their resolution.

    Raises MeshError.
    """
    sector = adapted(levelled_sector(problem, member))
    return LevelledMesh(sector_mesh(unmodified(problem.pair.gears[member]), sector.coarse), sector.levels)


def flank_cells(problem: GearProblem, member: Member) -> tuple[int, int]:
    """Rows along the profile and layers along the face of the loaded flank that contact is computed on."""
    if is_two_level(problem):
        return finest_cells(levelled_sector(problem, member))
    resolution = sector_resolution(problem, member)
    return resolution.profile_elements, resolution.face_elements


def unmodified(gear: GearParameters) -> GearParameters:
    """The gear without relief and crowning."""
    return replace(gear, modifications=Modifications())
