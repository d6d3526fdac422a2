"""The sector meshes of a gear pair: each in its gear's own frame, and both in place as the gears mesh."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from evolvent.gears.meshing.element_sizes import sector_resolutions
from evolvent.gears.meshing.modifications import too_much_relief
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import nominal_angles
from evolvent_meshes.gears.member import Member
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


def sector_meshes(problem: GearProblem) -> tuple[MeshData, MeshData]:
    """(pinion's, wheel's) sector in its own frame [mm]; of a plane problem the mid-face section. Raises MeshError."""
    return gear_mesh(problem, Member.PINION), gear_mesh(problem, Member.WHEEL)


def gear_mesh(
    problem: GearProblem, member: Member, adapted: Adaption = lambda resolution: resolution
) -> MeshData:
    """The sector of the pinion or the wheel. adapted: changes its resolution.

    Raises MeshError, also where first-order cells fold in a thin tooth, and TooMuchRelief where the flank's
    modification folds the cells.
    """
    shape = PLANE_SHAPE[problem.mesh.shape] if problem.is_plane else problem.mesh.shape
    resolution = adapted(sector_resolutions(problem)[member])
    try:
        mesh = sector_mesh(problem.pair.gears[member], resolution, shape)
    except MeshError as error:
        if reason := too_much_relief(problem, member, resolution):
            raise reason from error
        raise
    return mesh if problem.mesh.order == 2 else _first_order(mesh, member)


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


def standing_pair(problem: GearProblem) -> MeshData:
    """Both sectors in place at φ = 0 as one mesh, tooth pair 0 touching at the pitch point.

    Groups: pinion_tooth, pinion_flank, ..., wheel_tooth, ... Raises MeshError.
    """
    pair = problem.pair
    first, second = sector_meshes(problem)
    angles = nominal_angles(pair, 0.0)
    centre = np.array([pair.centre_distance, 0.0, 0.0])
    points = [_turned(first, float(angles[0])), _turned(second, float(angles[1])) + centre]
    facets = {f"pinion_{name}": nodes for name, nodes in first.facets.items()}
    facets |= {f"wheel_{name}": nodes + len(first.points) for name, nodes in second.facets.items()}
    volumes = {f"pinion_{name}": cells for name, cells in first.volumes.items()}
    volumes |= {f"wheel_{name}": cells + len(first.cells) for name, cells in second.volumes.items()}
    cells = np.concatenate([first.cells, second.cells + len(first.points)])
    return MeshData(np.concatenate(points), first.shape, first.order, cells, facets, volumes)


def _turned(mesh: MeshData, angle: float) -> Floats:
    cosine, sine = np.cos(angle), np.sin(angle)
    return mesh.points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
