"""Patches: the cells about a place of a mesh, cut out of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from evolvent_meshes.arrays import Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.reference_cells import facet_nodes
from evolvent_meshes.mesh.structured_grid import boundary_facets

CUT = "cut"
"""Facet group of a patch on which it was cut out of the body."""


@dataclass(frozen=True)
class Patch:
    """Some cells of a mesh as a mesh of their own."""

    mesh: MeshData
    """Mesh with the groups of the body's mesh, as far as they lie on the patch, and the group CUT."""
    cells: Ints
    """Numbers (n_cells,) of the cells in the body's mesh."""
    nodes: Ints
    """Numbers (n,) of the nodes in the body's mesh."""


def cells_near(mesh: MeshData, nodes: Ints, reach: float) -> Ints:
    """The cells (n,) with a node closer than `reach` [mm] to one of the `nodes`."""
    distance, _ = cKDTree(mesh.points[nodes]).query(mesh.points, distance_upper_bound=reach)
    return np.flatnonzero(np.isfinite(distance)[mesh.cells].any(axis=1))


def cut_out(mesh: MeshData, cells: Ints) -> Patch:
    """Patch of some cells (n,) of a mesh of second-order quadrilaterals or hexahedra, whose facets have a node each
    that belongs to them alone. The patch of a patch keeps the group CUT where it lies on that."""
    nodes, numbers = np.unique(mesh.cells[cells], return_inverse=True)
    place = np.full(len(mesh.points), -1)
    place[nodes] = np.arange(len(nodes))
    own = numbers.reshape(len(cells), -1)
    outline = boundary_facets(mesh.shape, mesh.order, own)
    facets = {name: _facets_on(outline, place[rows]) for name, rows in mesh.facets.items()}
    inside = _cut_facets(mesh, outline, nodes)
    facets[CUT] = np.concatenate([facets[CUT], inside]) if CUT in facets else inside
    volumes = {name: np.flatnonzero(np.isin(cells, old)) for name, old in mesh.volumes.items()}
    return Patch(MeshData(mesh.points[nodes], mesh.shape, mesh.order, own, facets, volumes), cells, nodes)


def _facets_on(outline: Ints, wanted: Ints) -> Ints:
    """The facets (f, nodes) among `wanted` that lie on the outline of a patch. Their last node is theirs alone."""
    inside = wanted[(wanted >= 0).all(axis=1)]
    return inside[np.isin(inside[:, -1], outline[:, -1])]


def _cut_facets(mesh: MeshData, outline: Ints, nodes: Ints) -> Ints:
    """The facets of the outline that are inside the body: their last nodes belong to two of its cells."""
    last = mesh.cells[:, facet_nodes(mesh.shape, mesh.order)[:, -1]]
    counts = np.bincount(last.ravel(), minlength=len(mesh.points))
    return outline[counts[nodes[outline[:, -1]]] > 1]
