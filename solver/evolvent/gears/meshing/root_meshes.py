"""Sector meshes with finer roots, where the stress there is wanted: contact and deflection need less."""

from __future__ import annotations

from dataclasses import replace

from evolvent.gears.meshing.companion_meshes import coarser
from evolvent.gears.meshing.flank_levels import LevelledSector
from evolvent.gears.meshing.levelled_meshes import SectorMesh, is_two_level, levelled_mesh
from evolvent.gears.meshing.sector_meshes import Adaption, gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.section import SectorResolution

FINER = 2
"""Elements around a fillet over those of a run, which has six. Largest tension of Zhang's pair in plane strain, over
the limit of finer ones: 1.020 with six elements, 1.005 with twelve, 1.001 with 24."""


def finer_roots(sector: SectorResolution) -> SectorResolution:
    """`FINER` times the elements around both fillets."""
    return replace(
        sector, fillet_elements=FINER * sector.fillet_elements, back_elements=FINER * sector.back_elements,
        neck_elements=FINER * sector.neck_elements,
    )  # fmt: skip


def root_mesh(problem: GearProblem, member: Member) -> SectorMesh:
    """The mesh of a run with finer roots. Raises MeshError, TooMuchRelief."""
    return _adapted(problem, member, finer_roots)


def coarse_root_mesh(problem: GearProblem, member: Member) -> SectorMesh:
    """The same with elements of twice the size, for error bars. Raises MeshError."""
    return _adapted(problem, member, lambda sector: coarser(finer_roots(sector)))


def _adapted(problem: GearProblem, member: Member, adapted: Adaption) -> SectorMesh:
    if not is_two_level(problem):
        return gear_mesh(problem, member, adapted)

    def of_coarse(levels: LevelledSector) -> LevelledSector:
        return replace(levels, coarse=adapted(levels.coarse))

    return levelled_mesh(problem, member, of_coarse)
