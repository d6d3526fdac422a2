"""Meshes from which a gear pair is condensed: one fine mesh a sector, or a coarse one with levels on its flank."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from evolvent.gears.meshing.element_sizes import sector_resolution
from evolvent.gears.meshing.flank_levels import (
    LONGEST,
    FlankLevel,
    LevelledSector,
    length_over_height,
    levelled_sector,
)
from evolvent.gears.meshing.sector_meshes import gear_mesh, unmodified
from evolvent.gears.meshing.sector_sizes import divided_cells, finest_cells, one_mesh_sizes
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.sector import sector_mesh

MOST_DOFS = 200_000
"""Degrees of freedom of one fine mesh of both sectors together, from which on levels are used by default: about there,
condensing it takes as long as condensing the patches of a levelled flank."""


@dataclass(frozen=True)
class LevelledMesh:
    """A coarse sector, and the levels of its flank."""

    mesh: MeshData
    """Mesh of the sector without flank modifications, which do not change its compliance."""
    levels: tuple[FlankLevel, ...]
    """Levels of the flank from the coarsest to the finest."""


SectorMesh = MeshData | LevelledMesh
"""Mesh from which a gear is condensed: one fine mesh, or a coarse one with levels on its flank."""


def is_two_level(problem: GearProblem) -> bool:
    """Whether the flanks have levels of their own: as the settings say or, by default, where that can be, one fine mesh
    has more than `MOST_DOFS` degrees of freedom, and the flank has no long cells."""
    if problem.is_plane or problem.is_line or problem.mesh.two_level is False:
        return False
    return problem.mesh.two_level is True or (is_large(problem) and not has_long_cells(problem))


def is_large(problem: GearProblem) -> bool:
    """Whether levels can be, and one fine mesh of both sectors is so large that they would pay."""
    can_be = (problem.mesh.shape, problem.mesh.order) == ("hexahedron", 2)
    if not can_be or problem.options.whole_gears or problem.options.fine_body:
        return False
    return sum(size.dofs for size in one_mesh_sizes(problem)) > MOST_DOFS


def has_long_cells(problem: GearProblem) -> bool:
    """Whether the cells that the finest level divides are too long along the face, as a spur gear's are, for small
    patches."""
    return max(_divided_cell_length(problem, member) for member in Member) > LONGEST


def _divided_cell_length(problem: GearProblem, member: Member) -> float:
    """Length along the face over that along the profile, on average, of the cells that the finest level divides; of the
    lightest torque that the meshes serve, so that all torques of a list have levels or none."""
    sector = levelled_sector(problem.lightest, member)
    return length_over_height(problem.pair.gears[member], sector.coarse, *divided_cells(sector))


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
