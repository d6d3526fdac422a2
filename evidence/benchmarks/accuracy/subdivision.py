"""A second-order mesh cut into halves in every direction: the reference of a convergence study keeps the grading.

A mesh that is made anew with more elements grades differently; one whose cells are halved is finer everywhere, by the
same factor.
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData
from evolvent_meshes.mesh.reference_cells import node_positions
from evolvent_meshes.mesh.structured_grid import lattice_cells, tensor_points, weld

SAME_POINT = 1e-8
"""Points closer than this are one node [mm]; rounding leaves 1e-13, the smallest cells are 1e-3."""


def halved(mesh: MeshData) -> MeshData:
    """Every cell of a second-order mesh of quadrilaterals or hexahedra cut into 4 or 8; same groups.

    New nodes lie on the old cells' second-order geometry, a cell's own nodes stay. Raises ValueError for another mesh.
    """
    if mesh.order != 2 or mesh.shape not in ("quadrilateral", "hexahedron"):
        raise ValueError(
            f"halved: wanted second-order quadrilaterals or hexahedra, found {mesh.shape} of order {mesh.order}"
        )
    parts = [_children(mesh.points, mesh.cells, mesh.shape)]
    parts += [_children(mesh.points, nodes, FACET_SHAPE[mesh.shape]) for nodes in mesh.facets.values()]
    keep, number = weld(np.concatenate([points for points, _ in parts]), SAME_POINT)
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    cells, *facets = (number[start + nodes] for start, (_, nodes) in zip(starts, parts))
    several = len(cells) // len(mesh.cells)
    volumes = {name: (several * old[:, None] + np.arange(several)).ravel() for name, old in mesh.volumes.items()}
    points = np.concatenate([points for points, _ in parts])[keep]
    return MeshData(points, mesh.shape, 2, cells, dict(zip(mesh.facets, facets)), volumes)


def _children(points: Floats, entities: Ints, shape: str) -> tuple[Floats, Ints]:
    """Points (n·5^t, 3) of n halved entities of topological dimension t, and the halves (n·2^t, nodes) on them."""
    positions = node_positions(shape, 2)
    dimension = positions.shape[1]
    lattice = tensor_points(*[np.linspace(0.0, 2.0, 5)] * dimension)
    values = np.ones((len(lattice), len(positions)))
    for axis in range(dimension):
        x = lattice[:, axis]
        values *= np.stack([(1 - x) * (2 - x) / 2, x * (2 - x), x * (x - 1) / 2])[positions[:, axis]].T
    new = np.einsum("qk,nkx->nqx", values, points[entities])
    local = _lattice_halves(dimension)
    nodes = np.arange(len(entities))[:, None, None] * len(lattice) + local
    return new.reshape(-1, points.shape[1]), nodes.reshape(-1, local.shape[1])


def _lattice_halves(dimension: int) -> Ints:
    """The halves (2^t, nodes) on a lattice of 5^t points."""
    return np.array([[0, 2, 1], [2, 4, 3]]) if dimension == 1 else lattice_cells((2,) * dimension, 2)
