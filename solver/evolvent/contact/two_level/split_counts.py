"""Into how many cells those below a contact surface are split in patches: finely at the surface, less with depth."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.reference_cells import facet_nodes, node_positions
from evolvent_meshes.mesh.splitting import edge_classes


def split_counts(mesh: MeshData, group: str, along: Ints, below: tuple[int, ...]) -> Ints:
    """Counts (n_cells, d), equal within each class of edges.

    along: (n_cells, d) wanted along each reference axis of the cells at the surface; others are not read.
    below: into how many cells the first, second, ... cell below each facet is split in depth.
    """
    classes = edge_classes(mesh)
    wanted = np.ones(classes.max() + 1, dtype=np.int64)
    cell, side = _behind(mesh, mesh.facets[group])
    axes = _axis_of_side(mesh.shape)
    for axis in range(mesh.dimension):
        tangential = axes[side] != axis
        np.maximum.at(wanted, classes[cell[tangential], axis], along[cell[tangential], axis])
    for count in below:
        np.maximum.at(wanted, classes[cell, axes[side]], count)
        cell, side = _next(mesh, cell, side)
    return wanted[classes]


def _behind(mesh: MeshData, facets: Ints) -> tuple[Ints, Ints]:
    """The cell behind each facet of the boundary, and which of its sides the facet is."""
    centres = mesh.cells[:, [face[-1] for face in facet_nodes(mesh.shape, 2)]]
    owner = np.full((len(mesh.points), 2), -1)
    owner[centres.ravel(), 0], owner[centres.ravel(), 1] = np.divmod(np.arange(centres.size), centres.shape[1])
    return owner[facets[:, -1], 0], owner[facets[:, -1], 1]


def _next(mesh: MeshData, cell: Ints, side: Ints) -> tuple[Ints, Ints]:
    """The cells beyond these, seen from their sides, as far as there are any."""
    centres = mesh.cells[:, [face[-1] for face in facet_nodes(mesh.shape, 2)]]
    far = centres[cell, _opposite(mesh.shape)[side]]
    flat = np.argsort(centres.ravel(), kind="stable")
    ordered = centres.ravel()[flat]
    first, last = np.searchsorted(ordered, far), np.searchsorted(ordered, far, side="right") - 1
    other = np.where(flat[first] // centres.shape[1] == cell, flat[last], flat[first])
    beyond = last > first
    return other[beyond] // centres.shape[1], other[beyond] % centres.shape[1]


def _axis_of_side(shape: str) -> Ints:
    """Reference axis (sides,) across each side of a cell."""
    centres = node_positions(shape, 2)[[face[-1] for face in facet_nodes(shape, 2)]]
    return np.argmax(centres != 1, axis=1)


def _opposite(shape: str) -> Ints:
    """Opposite side (sides,) of each side."""
    centres = node_positions(shape, 2)[[face[-1] for face in facet_nodes(shape, 2)]]
    return np.array([int(np.argmax((centres == 2 - centre).all(axis=1))) for centre in centres])
