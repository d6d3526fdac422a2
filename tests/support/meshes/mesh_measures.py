"""Area or volume of a mesh, and whether its facet groups are its boundary."""

from __future__ import annotations

from itertools import product

import numpy as np

from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData
from evolvent_meshes.mesh.reference_cells import shape_gradients
from evolvent_meshes.mesh.structured_grid import boundary_facets


def measure(mesh: MeshData) -> float:
    """Area or volume of a mesh by Gauss points on the curved cells, collapsed for simplices."""
    d = mesh.dimension
    line, weights = np.polynomial.legendre.leggauss(4)
    where = np.array(list(product(0.5 + 0.5 * line, repeat=d)))
    weight = np.prod(list(product(0.5 * weights, repeat=d)), axis=1)
    if mesh.shape in ("triangle", "tetrahedron"):  # collapsed coordinates
        x = where.copy()
        for k in range(1, d):
            where[:, k] = x[:, k] * (1 - where[:, :k].sum(axis=1))
            weight = weight * (1 - where[:, :k].sum(axis=1))
    gradients = shape_gradients(mesh.shape, mesh.order, where)
    jacobians = np.einsum("cni,pnj->cpij", mesh.points[mesh.cells, :d], gradients)
    return float((np.linalg.det(jacobians) * weight).sum())


def covers_boundary(mesh: MeshData) -> bool:
    """Whether the facet groups are together the whole boundary, each facet once."""
    corners = len({"interval": "ab", "triangle": "abc", "quadrilateral": "abcd"}[FACET_SHAPE[mesh.shape]])
    outside = np.sort(boundary_facets(mesh.shape, mesh.order, mesh.cells)[:, :corners], axis=1)
    named = np.sort(np.concatenate(list(mesh.facets.values()))[:, :corners], axis=1)
    return len(named) == len(outside) and {tuple(f) for f in named.tolist()} == {tuple(f) for f in outside.tolist()}
