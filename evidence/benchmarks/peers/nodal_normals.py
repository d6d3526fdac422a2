"""What the adapters share of a contact surface: its nodes with their normals and areas. NumPy only."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData


def nodal_normals(mesh: MeshData, group: str) -> tuple[Ints, Floats]:
    """The nodes (n,) of a facet group and their unit outward normals (n, 3): the mean over the facets that meet there.

    In 2D normals have z = 0.
    """
    facets = mesh.facets[group]
    flat = mesh.dimension == 2
    corners = mesh.points[facets[:, : 2 if flat else 3 if mesh.shape == "tetrahedron" else 4]]
    if flat:
        along = corners[:, 1] - corners[:, 0]
        area = np.column_stack([along[:, 1], -along[:, 0], np.zeros(len(along))])
    else:
        area = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0])
        if corners.shape[1] == 4:
            area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    area *= np.where(np.sum(area * (corners.mean(axis=1) - _inside(mesh, facets)), axis=1) < 0, -1.0, 1.0)[:, None]
    nodes, place = np.unique(facets, return_inverse=True)
    normal = np.zeros((len(nodes), 3))
    np.add.at(normal, place.ravel(), np.repeat(area, facets.shape[1], axis=0))
    return nodes, normal / np.linalg.norm(normal, axis=1)[:, None]


def _inside(mesh: MeshData, facets: Ints) -> Floats:
    """The centre (n, 3) of the cell behind each facet."""
    touched = np.flatnonzero(np.isin(mesh.cells, facets).any(axis=1))
    owner: dict[int, list[int]] = {}
    for cell in touched.tolist():
        for node in mesh.cells[cell].tolist():
            owner.setdefault(node, []).append(cell)
    cells = [set.intersection(*(set(owner[node]) for node in facet)).pop() for facet in facets.tolist()]
    return np.asarray(mesh.points[mesh.cells[cells]].mean(axis=1))
