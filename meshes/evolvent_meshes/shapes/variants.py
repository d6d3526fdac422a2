"""Meshes derived from others: with part of a facet group as another group, or doubled by reflection."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData, MeshError
from evolvent_meshes.mesh.reference_cells import node_positions
from evolvent_meshes.mesh.structured_grid import weld


def with_part(mesh: MeshData, group: str, part: str, reach: float) -> MeshData:
    """The mesh with a further facet group of the facets that may come into contact.

    group: the facet group to take them from.
    part: name of the new group; as contact surface it needs fewer functionals than `group`.
    reach: largest distance of a facet's centre from the z axis, in 2D from the y axis [mm].
    Raises MeshError where there are no such facets.
    """
    facets = mesh.facets[group]
    away = np.linalg.norm(mesh.points[facets, : mesh.dimension - 1].mean(axis=1), axis=1)
    inside = facets[away < reach]
    if len(inside) == 0:
        raise MeshError(f"part of {group!r}: wanted facets within {reach} mm of the axis, found none; reach further")
    return replace(mesh, facets={**mesh.facets, part: inside})


def doubled(mesh: MeshData, plane: str, axis: int = 0) -> MeshData:
    """The mesh of quadrilaterals or hexahedra and its mirror image in a coordinate plane, welded there.

    plane: the facet group in the plane; the doubled mesh does not have it. All other groups have both halves.
    axis: the coordinate that is 0 in the plane.
    Raises MeshError for simplices, and where the group is not in the plane.
    """
    off = float(np.abs(mesh.points[np.unique(mesh.facets[plane]), axis]).max())
    scale = float(np.ptp(mesh.points, axis=0).max())
    if off > 1e-9 * scale:
        raise MeshError(f"doubled: wanted {plane!r} in the plane where coordinate {axis} is 0, found {off:g} mm off it")
    image = mesh.points * np.where(np.arange(3) == axis, -1.0, 1.0)
    keep, number = weld(np.concatenate([mesh.points, image]), 1e-9 * scale)
    points = np.concatenate([mesh.points, image])[keep]
    both = _both(mesh.cells, mesh.shape, mesh.order, len(mesh.points))
    facets = {
        name: number[_both(facets, FACET_SHAPE[mesh.shape], mesh.order, len(mesh.points))]
        for name, facets in mesh.facets.items()
        if name != plane
    }
    volumes = {name: np.concatenate([cells, cells + len(mesh.cells)]) for name, cells in mesh.volumes.items()}
    return MeshData(points, mesh.shape, mesh.order, number[both], facets, volumes)


def _both(cells: Ints, shape: str, order: int, count: int) -> Ints:
    """Cells and their images, with node numbers larger by `count` and the nodes reordered to keep the orientation."""
    return np.concatenate([cells, cells[:, _mirrored_order(shape, order)] + count])


def _mirrored_order(shape: str, order: int) -> Ints:
    """For each node of the reference cell the node at its mirror image. Raises MeshError for simplices."""
    if shape not in ("interval", "quadrilateral", "hexahedron"):
        raise MeshError(f"doubled: wanted quadrilaterals or hexahedra, found {shape}; mirror before splitting them")
    place: Floats = node_positions(shape, order).astype(float)
    image = place * np.where(np.arange(place.shape[1]) == 0, -1.0, 1.0) + np.where(np.arange(place.shape[1]) == 0, 2, 0)
    same = (place[None] == image[:, None]).all(axis=2)
    return np.asarray(same.argmax(axis=1), dtype=np.int64)
