"""The sector mesh on which a gear's modes are computed: the gear's own mesh where that is small, else a coarse one.

Natural modes up to the mesh frequency's harmonics are as long as the gear: they need no flank that resolves a contact.
"""

from __future__ import annotations

from dataclasses import replace

from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.meshing.companion_meshes import coarser
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.section import SectorResolution

OWN_NODES = 6000
"""Nodes of a sector up to which its own mesh serves: its modes take seconds."""


def mode_mesh(problem: GearProblem, body: GearBody) -> MeshData | None:
    """A coarse sector of a gear, None where its own mesh serves: not where the flank's nodes are those of finer levels.
    Raises MeshError."""
    if len(body.mesh.points) <= OWN_NODES and not body.levels:
        return None
    return coarse_sector(problem, body.member)


def body_mesh(problem: GearProblem, member: Member) -> MeshData:
    """A sector for static shapes of a gear's body: the problem's own one in 2D, in space a coarse one. Raises
    MeshError."""
    return gear_mesh(problem, member) if problem.is_plane else coarse_sector(problem, member)


def coarse_sector(problem: GearProblem, member: Member) -> MeshData:
    """A coarse sector of a gear, whatever the mesh of the problem. Raises MeshError."""
    settings = replace(MeshSettings("quick"), shape=problem.mesh.shape)
    return gear_mesh(replace(problem, mesh=settings), member, adapted=_coarse_flank)


def _coarse_flank(fine: SectorResolution) -> SectorResolution:
    """Sector with half as many elements along profile, face and root, but all below the teeth: what the bore holds
    bends there."""
    return replace(
        coarser(fine), core_elements=fine.core_elements, rim_elements=fine.rim_elements,
        web_elements=fine.web_elements, hub_elements=fine.hub_elements,
    )
