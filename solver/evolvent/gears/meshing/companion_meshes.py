"""The meshes of a coarse companion, for error bars: elements of twice the size."""

from __future__ import annotations

from dataclasses import replace

from evolvent.gears.meshing.flank_levels import LevelledSector
from evolvent.gears.meshing.levelled_meshes import SectorMesh, is_two_level, levelled_mesh
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.section import SectorResolution

COARSENING = 2.0
"""Element size of the companion over that of the run."""
LEAST_LAYERS = 2
"""Least number of layers of elements over the face width: both ends of the face need their own."""


def coarser(fine: SectorResolution) -> SectorResolution:
    """Sector resolution of the companion, graded as the run's, with elements of `COARSENING` times the size as far as
    counts can be divided."""

    def half(count: int, least: int = 1) -> int:
        return max(least, round(count / COARSENING))

    neck = half(fine.neck_elements)
    low, middle, high = (COARSENING * depth for depth in fine.layer_depths)
    return replace(
        fine,
        profile_elements=3 * half(fine.profile_elements // 3, 2),
        face_elements=half(fine.face_elements, LEAST_LAYERS),
        layer_depths=(low, middle, high),
        neck_elements=neck,
        fillet_elements=half(fine.fillet_elements, neck + 1),
        back_elements=half(fine.back_elements, neck + 1),
        band_depth=min(COARSENING * fine.band_depth, SectorResolution.band_depth),
        core_elements=half(fine.core_elements),
        rim_elements=half(fine.rim_elements),
        web_elements=half(fine.web_elements),
        hub_elements=half(fine.hub_elements),
    )


def coarser_levels(fine: LevelledSector) -> LevelledSector:
    """Levelled sector of the companion: as many levels on a sector with elements of `COARSENING` times the size. So the
    elements of every level are as much larger, and the error of the body is included beside that of the contact. One
    level less on the same sector would cost half of the patches, but leave the body as it is."""
    return replace(fine, coarse=coarser(fine.coarse))


def companion_mesh(problem: GearProblem, member: Member) -> SectorMesh:
    """The coarse sector of the pinion or the wheel, in levels where the run's is. Raises MeshError."""
    if is_two_level(problem):
        return levelled_mesh(problem, member, adapted=coarser_levels)
    return gear_mesh(problem, member, adapted=coarser)
