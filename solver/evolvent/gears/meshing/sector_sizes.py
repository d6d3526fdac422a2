"""Degrees of freedom of sector meshes, counted without meshing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import prod

from evolvent.gears.meshing.element_sizes import sector_resolutions
from evolvent.gears.meshing.flank_levels import LevelledSector, levelled_sector
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.axial_layers import web_layers
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import layer_heights


@dataclass(frozen=True)
class SectorSize:
    """Degrees of freedom of a sector, or of its plane section."""

    dofs: int
    """Number of all degrees of freedom."""
    flank: int
    """Degrees of freedom of the loaded flank."""
    cuts: int
    """Degrees of freedom of both cut faces."""
    roots: int = 0
    """Degrees of freedom of both roots, where their displacements are condensed, too."""

    def times(self, sectors: int, flanks: int) -> SectorSize:
        """The size of so many sectors joined to a ring, with so many flanks in contact."""
        return SectorSize(sectors * self.dofs, flanks * self.flank, 0)


def sector_size(
    resolution: SectorResolution, order: int, plane: bool, gear: GearParameters | None = None
) -> SectorSize:
    """The exact size of a sector mesh of order 1 or 2; cutting hexahedra into tetrahedra adds no node.

    gear: whose web leaves cells out; None: a full ring. Raises MeshError for too few layers beside a web.
    A section without holes has corners − edges + cells = 1 (Euler), and 4 cells + outline = 2 edges.
    """
    counts = resolution
    alike, rows = counts.fine_back, counts.profile_elements // 3
    inner = counts.core_elements + 1 + alike  # columns between the bands of both sides
    below = counts.fillet_elements + counts.back_elements - 2 * counts.neck_elements + inner  # columns of the rim
    tooth = rows * (13 * (1 + alike) + counts.core_elements + 1 - alike)  # 3 × 3 thin, 4 joining, then coarse cells
    band = counts.fillet_elements - 1 + 4 + counts.back_elements + 3 * alike
    cells = tooth + band + counts.neck_elements * inner + counts.rim_elements * below
    cut = counts.rim_elements + 1
    tip = 3 * (1 + alike) + counts.core_elements + 2
    back = counts.back_elements + rows * (3 if alike else 1)
    outline = counts.profile_elements + counts.fillet_elements + back + tip + 2 * cut + below
    nodes = 1 + 4 * cells + outline if order == 2 else 1 + cells + outline // 2
    levels = 2 if plane else 3 * (order * counts.face_elements + 1)
    flank, cuts = order * counts.profile_elements + 1, 2 * (order * cut + 1)
    more = 0 if gear is None else _below_rim(resolution, order, gear)
    return SectorSize(levels * nodes + (order * below + 1) * more, levels * flank, levels * cuts + 2 * more)


def root_dofs(resolution: SectorResolution, order: int, plane: bool) -> int:
    """Degrees of freedom of both roots of a sector."""
    rows = order * (resolution.fillet_elements + resolution.back_elements) + 2
    return rows * (2 if plane else 3 * (order * resolution.face_elements + 1))


def _below_rim(resolution: SectorResolution, order: int, gear: GearParameters) -> int:
    """Degrees of freedom of one line of nodes from the rim of a web down to the bore, without that on the rim."""
    if gear.thin_web is None:
        return 0
    hub = 0 if gear.thin_web.hub_diameter is None else order * resolution.hub_elements + 1
    web = order * resolution.web_elements - (hub > 0)  # the hub has the nodes where both meet
    layers = len(web_layers(gear, layer_heights(gear.face_width, resolution)))
    return 3 * (web * (order * layers + 1) + hub * (order * resolution.face_elements + 1))


def one_mesh_sizes(problem: GearProblem) -> tuple[SectorSize, SectorSize]:
    """Sizes of (pinion's, wheel's) sector where each is one mesh, fine on the flank."""
    order, plane = problem.mesh.order, problem.is_plane
    pinion, wheel = (
        sector_size(each, order, plane, gear) for each, gear in zip(sector_resolutions(problem), problem.pair.gears)
    )
    return pinion, wheel


@dataclass(frozen=True)
class LevelledSize:
    """Degrees of freedom of a sector whose flank has levels of its own."""

    sector: SectorSize
    """Degrees of freedom of the coarse sector."""
    flank: int
    """Degrees of freedom of the flank's finest level."""

    @staticmethod
    def of(levelled: LevelledSector, gear: GearParameters | None = None) -> LevelledSize:
        """The exact size of second-order meshes. gear: as of `sector_size`."""
        rows, layers = finest_cells(levelled)
        return LevelledSize(sector_size(levelled.coarse, 2, False, gear), 3 * (2 * rows + 1) * (2 * layers + 1))


def finest_cells(levelled: LevelledSector) -> tuple[int, int]:
    """Rows along the profile and layers along the face of the flank's finest level."""
    rows = levelled.coarse.profile_elements * prod(level.rows for level in levelled.levels)
    return rows, levelled.coarse.face_elements * prod(level.layers for level in levelled.levels)


def divided_cells(levelled: LevelledSector) -> tuple[int, int]:
    """Rows and layers of the flank's cells that its finest level divides."""
    return finest_cells(replace(levelled, levels=levelled.levels[:-1]))


def levelled_sizes(problem: GearProblem) -> tuple[LevelledSize, LevelledSize]:
    """Sizes of (pinion's, wheel's) sector in levels."""
    pinion, wheel = (LevelledSize.of(levelled_sector(problem, member), problem.pair.gears[member]) for member in Member)
    return pinion, wheel
