"""The sector meshes of a scene: of each gear in its own frame, and both standing as they mesh, to be looked at."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from evolvent.scene.meshing.element_sizes import sector_resolutions
from evolvent.scene.meshing.modifications import too_much_relief
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import SceneError
from evolvent.scene.skips import is_plane
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import nominal_angles
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
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


def sector_meshes(scene: Scene, plane: bool | None = None) -> tuple[MeshData, MeshData]:
    """(pinion's, wheel's) sector in its own frame [mm], with the scene's cells and order.

    plane: mesh the mid-face sections only; by default where `is_plane` says so. Raises MeshError.
    """
    return gear_mesh(scene, Member.PINION, plane), gear_mesh(scene, Member.WHEEL, plane)


def gear_mesh(
    scene: Scene, member: Member, plane: bool | None = None, adapted: Adaption = lambda own: own
) -> MeshData:
    """One of the `sector_meshes`: the pinion's or the wheel's; `adapted` may change its resolution.

    Raises MeshError, and SceneError where it is the flank's modification that folds the cells.
    """
    flat = is_plane(scene) if plane is None else plane
    shape = PLANE_SHAPE[scene.mesh.shape] if flat else scene.mesh.shape
    resolution = adapted(sector_resolutions(scene)[member])
    try:
        mesh = sector_mesh(scene.gear_pair().gears[member], resolution, shape)
    except MeshError as error:
        if problem := too_much_relief(scene, member, resolution):
            raise SceneError([problem]) from error
        raise
    return mesh if scene.mesh.order == 2 else linear(mesh)


def linear(mesh: MeshData) -> MeshData:
    """The first-order mesh on the corners of a second-order one; same groups."""
    cells = mesh.cells[:, : corner_count(mesh.shape)]
    facets = {name: nodes[:, : corner_count(FACET_OF[mesh.shape])] for name, nodes in mesh.facets.items()}
    used, first = np.unique(cells, return_inverse=True)
    renumbered = {name: np.searchsorted(used, nodes) for name, nodes in facets.items()}
    return MeshData(mesh.points[used], mesh.shape, 1, first.reshape(cells.shape), renumbered, dict(mesh.volumes))


def standing_pair(scene: Scene) -> MeshData:
    """Both sectors in one mesh in space at φ = 0, tooth pair 0 touching at the pitch point.

    Groups: pinion_tooth, pinion_flank, ..., wheel_tooth, ... Raises MeshError.
    """
    pair = scene.gear_pair()
    first, second = sector_meshes(scene)
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
