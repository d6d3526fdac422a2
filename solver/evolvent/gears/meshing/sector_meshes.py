"""The sector meshes of a gear pair, fine on the loaded flanks, each in its gear's own frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from evolvent.gears.meshing.element_sizes import sector_resolution
from evolvent.gears.meshing.modifications import too_much_relief
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import least_determinants
from evolvent_meshes.mesh.reference_cells import corner_count
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh

Adaption = Callable[[SectorResolution], SectorResolution]

PLANE_SHAPE = {"hexahedron": "quadrilateral", "tetrahedron": "triangle"}
FACET_OF = {
    "hexahedron": "quadrilateral",
    "tetrahedron": "triangle",
    "quadrilateral": "interval",
    "triangle": "interval",
}


def gear_mesh(
    problem: GearProblem, member: Member, adapted: Adaption = lambda resolution: resolution
) -> MeshData:
    """The sector of the pinion or the wheel in its own frame [mm]; of a plane problem the mid-face section. For line
    contact the flanks have no modifications, which do not change the compliance. adapted: changes its resolution.

    Raises MeshError, also where first-order cells fold in a thin tooth, and TooMuchRelief where the flank's
    modification folds the cells.
    """
    shape = PLANE_SHAPE[problem.mesh.shape] if problem.is_plane else problem.mesh.shape
    resolution = adapted(sector_resolution(problem, member))
    try:
        gear = problem.pair.gears[member]
        mesh = sector_mesh(unmodified(gear) if problem.is_line else gear, resolution, shape)
    except MeshError as error:
        if reason := too_much_relief(problem, member, resolution):
            raise reason from error
        raise
    return mesh if problem.mesh.order == 2 else _first_order(mesh, member)


def unmodified(gear: GearParameters) -> GearParameters:
    """The gear without relief and crowning."""
    return replace(gear, modifications=Modifications())


def _first_order(mesh: MeshData, member: Member) -> MeshData:
    """The first-order mesh; raises MeshError where straight edges fold cells that curved ones do not."""
    straight = linear(mesh)
    folded = np.count_nonzero(least_determinants(straight) <= 0.0)
    if folded:
        raise MeshError(
            f"{member.label}: wanted first-order cells without folds, found {folded} of {len(straight.cells)} folded, "
            "for the tooth is thin; take mesh.order = 2, or more mesh.elements_per_contact_width"
        )
    return straight


def linear(mesh: MeshData) -> MeshData:
    """The first-order mesh on the corners of a second-order one; same groups."""
    cells = mesh.cells[:, : corner_count(mesh.shape)]
    facets = {name: nodes[:, : corner_count(FACET_OF[mesh.shape])] for name, nodes in mesh.facets.items()}
    used, first = np.unique(cells, return_inverse=True)
    renumbered = {name: np.searchsorted(used, nodes) for name, nodes in facets.items()}
    return MeshData(mesh.points[used], mesh.shape, 1, first.reshape(cells.shape), renumbered, dict(mesh.volumes))
