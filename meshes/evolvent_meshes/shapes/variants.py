"""Meshes made from others: with a part of a facet group as a group of its own, doubled by mirroring."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData, MeshError
from evolvent_meshes.mesh.reference_cells import node_positions
from evolvent_meshes.mesh.structured_grid import weld


def with_part(mesh: MeshData, group: str, part: str, reach: float) -> MeshData:
    """The mesh with a further facet group `part`: the facets of `group` whose middle is nearer than `reach` [mm] to the
    z axis, in 2D to the y axis.

    What cannot touch then costs no compliance. Raises MeshError where there is none.
    """
    facets = mesh.facets[group]
    away = np.linalg.norm(mesh.points[facets, : mesh.dimension - 1].mean(axis=1), axis=1)
    inside = facets[away < reach]
    if len(inside) == 0:
        raise MeshError(f"part of {group!r}: wanted facets within {reach} mm of the axis, found none; reach further")
    return replace(mesh, facets={**mesh.facets, part: inside})


def doubled(mesh: MeshData, plane: str, axis: int = 0) -> MeshData:
    """The mesh and its mirror image in the coordinate plane of the facet group `plane`, welded there.

    axis: the coordinate that vanishes in the plane. All other facet groups and the volumes have both halves, `plane`
    is gone. Quadrilaterals and hexahedra. Raises MeshError where the group is not in the plane.
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
    """Cells and their images, whose nodes are `count` further on; the image's nodes are reordered to keep its sense."""
    return np.concatenate([cells, cells[:, _mirrored_order(shape, order)] + count])


def _mirrored_order(shape: str, order: int) -> Ints:
    """The node at the mirrored place of the reference cell, for each of its nodes."""
    if shape not in ("interval", "quadrilateral", "hexahedron"):
        raise MeshError(f"doubled: wanted quadrilaterals or hexahedra, found {shape}; mirror before splitting them")
    place: Floats = node_positions(shape, order).astype(float)
    image = place * np.where(np.arange(place.shape[1]) == 0, -1.0, 1.0) + np.where(np.arange(place.shape[1]) == 0, 2, 0)
    same = (place[None] == image[:, None]).all(axis=2)
    return np.asarray(same.argmax(axis=1), dtype=np.int64)
