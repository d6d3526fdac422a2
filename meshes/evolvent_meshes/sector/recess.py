"""Recess of a gear with a web: cells between rim and hub, or rim and bore, beside the web, which its sector lacks."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Bools, Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.structured_grid import boundary_facets

RECESS = "recess"
"""Facet group of the free faces that are left: of the web, inside the rim, outside the hub."""


def without_recess(gear: GearParameters, mesh: MeshData) -> tuple[MeshData, Ints]:
    """A sector of second-order hexahedra without the cells beside the web, and the nodes (n,) that it keeps; a full
    ring as it is. Layers and rows of cells end at the faces of the web."""
    if gear.thin_web is None:
        return mesh, np.arange(len(mesh.points))
    beside = _beside_web(gear, mesh)
    kept = mesh.cells[~beside]
    is_used = np.zeros(len(mesh.points), dtype=bool)
    is_used[kept] = True
    used, number = np.flatnonzero(is_used), np.cumsum(is_used) - 1
    facets = mesh.facets | {RECESS: boundary_facets(mesh.shape, mesh.order, mesh.cells[beside])}
    groups = {  # the middle node of a facet is a node of its one or two cells only
        name: number[nodes[is_used[nodes[:, -1]]]] for name, nodes in facets.items()
    }
    volumes = {name: np.searchsorted(np.flatnonzero(~beside), cells[~beside[cells]]) for name, cells in
               mesh.volumes.items()}
    return MeshData(mesh.points[used], mesh.shape, mesh.order, number[kept], groups, volumes), used


def _beside_web(gear: GearParameters, mesh: MeshData) -> Bools:
    """Whether cells lie in the recess, by their middle nodes."""
    assert gear.thin_web is not None
    middle = mesh.points[mesh.cells[:, -1]]
    radius, (low, high) = np.hypot(middle[:, 0], middle[:, 1]), gear.thin_web.ends
    outer, inner = gear.web_diameters
    is_within = (2.0 * radius > inner) & (2.0 * radius < outer)
    return np.asarray(is_within & ~((middle[:, 2] > low) & (middle[:, 2] < high)))
