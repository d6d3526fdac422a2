"""Reference cells in the node order of gmsh: node positions, facets, gradients of shape functions.

Positions are integers: 0 and 2 are the ends of a reference edge, 1 is its middle. Source of the tables: gmsh reference
manual, "Node ordering".
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, FACET_SHAPE

CORNERS: dict[str, list[tuple[int, ...]]] = {
    "interval": [(0,), (2,)],
    "triangle": [(0, 0), (2, 0), (0, 2)],
    "quadrilateral": [(0, 0), (2, 0), (2, 2), (0, 2)],
    "tetrahedron": [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)],
    "hexahedron": [
        *((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)),
        *((0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)),
    ],
}

_HEXAHEDRON_EDGES = "01 03 04 12 15 23 26 37 45 47 56 67"
SECOND_ORDER_MEANS: dict[str, str] = {
    "interval": "01",
    "triangle": "01 12 20",
    "quadrilateral": "01 12 23 30 0123",
    "tetrahedron": "01 12 20 30 23 13",
    "hexahedron": _HEXAHEDRON_EDGES + " 0321 0154 0473 1265 2376 4567 01234567",
}
"""Shape -> for each second-order node, in the order of gmsh, the corners whose mean is its position."""

FACET_CORNERS: dict[str, str] = {
    "triangle": "01 12 20",
    "quadrilateral": "01 12 23 30",
    "tetrahedron": "021 013 032 123",
    "hexahedron": "0321 0154 0473 1265 2376 4567",
}


@lru_cache
def node_positions(shape: str, order: int) -> Ints:
    """Integer reference positions (n, d) of the nodes in the order of gmsh; 0 and 2 are ends, 1 is the middle."""
    corners = np.array(CORNERS[shape], dtype=np.int64)
    if order == 1:
        return corners
    middles = [corners[[int(c) for c in group]].mean(axis=0) for group in SECOND_ORDER_MEANS[shape].split()]
    return np.vstack([corners, np.array(middles)]).astype(np.int64)


@lru_cache
def corner_count(shape: str) -> int:
    """Number of corners of a cell shape."""
    return len(CORNERS[shape])


@lru_cache
def _position_index(shape: str, order: int) -> dict[tuple[int, ...], int]:
    return {tuple(p): i for i, p in enumerate(node_positions(shape, order).tolist())}


@lru_cache
def node_count(shape: str, order: int) -> int:
    """Number of nodes of a cell or facet of order 1 or 2."""
    return len(node_positions(shape, order))


def sub_cell_nodes(shape: str, sub_shape: str, corners: Ints, order: int) -> Ints:
    """Local node numbers (n, nodes of sub_shape) of sub-cells, facets or simplices, of a cell.

    corners: (n, corners of sub_shape) local corner numbers of the sub-cells.
    Each second-order node of a sub-cell is the mean of its corners and therefore a node of the cell: a 27-node
    hexahedron is split into 10-node tetrahedra without new nodes.
    """
    index = _position_index(shape, order)
    positions = np.array(CORNERS[shape])[corners]
    groups = [[i] for i in range(corner_count(sub_shape))]
    if order == 2:
        groups += [[int(c) for c in group] for group in SECOND_ORDER_MEANS[sub_shape].split()]
    means = np.stack([positions[:, group].mean(axis=1).round().astype(int) for group in groups], axis=1)
    return np.array([[index[tuple(p)] for p in row] for row in means.tolist()], dtype=np.int64)


@lru_cache
def facet_nodes(shape: str, order: int) -> Ints:
    """Local node numbers (n_facets, nodes per facet) of the facets of a cell, in the node order of gmsh."""
    corners = np.array([[int(c) for c in facet] for facet in FACET_CORNERS[shape].split()])
    return sub_cell_nodes(shape, FACET_SHAPE[shape], corners, order)


@lru_cache
def mirrored_nodes(shape: str, order: int) -> Ints:
    """perm (n,): cells[:, perm] are the same cells with the opposite sign of the Jacobian."""
    index = _position_index(shape, order)
    return np.array([index[(y, x, *z)] for x, y, *z in node_positions(shape, order).tolist()], dtype=np.int64)


def shape_gradients(shape: str, order: int, where: Floats) -> Floats:
    """Gradients (p, k, d) of the k Lagrange shape functions at reference points `where` (p, d).

    Reference cells: [0, 1]^d or the unit simplex.
    """
    if shape in ("triangle", "tetrahedron"):
        return _simplex_gradients(shape, order, where)
    return _tensor_gradients(shape, order, where)


def _tensor_gradients(shape: str, order: int, where: Floats) -> Floats:
    positions = node_positions(shape, order) if order == 2 else node_positions(shape, order) // 2
    values, slopes = line_functions(order, where)
    dimension = CELL_DIMENSION[shape]
    gradients = np.ones((len(where), len(positions), dimension))
    for direction in range(dimension):
        for axis in range(dimension):
            table = slopes if axis == direction else values
            gradients[:, :, direction] *= table[:, axis, positions[:, axis]]
    return gradients


def line_functions(order: int, x: Floats) -> tuple[Floats, Floats]:
    """Values and derivatives (..., order + 1) of the Lagrange polynomials on [0, 1], nodes in increasing order."""
    if order == 1:
        return np.stack([1 - x, x], axis=-1), np.stack([-np.ones_like(x), np.ones_like(x)], axis=-1)
    values = np.stack([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)], axis=-1)
    slopes = np.stack([4 * x - 3, 4 - 8 * x, 4 * x - 1], axis=-1)
    return values, slopes


def _simplex_gradients(shape: str, order: int, where: Floats) -> Floats:
    dimension = CELL_DIMENSION[shape]
    barycentric = np.column_stack([1 - where.sum(axis=1), where])
    slopes = np.vstack([-np.ones(dimension), np.eye(dimension)])
    if order == 1:
        return np.broadcast_to(slopes, (len(where), *slopes.shape)).copy()
    corners = (4 * barycentric - 1)[:, :, None] * slopes
    edges = [[int(c) for c in group] for group in SECOND_ORDER_MEANS[shape].split()]
    middles = [4 * (barycentric[:, [i]] * slopes[j] + barycentric[:, [j]] * slopes[i]) for i, j in edges]
    return np.concatenate([corners, np.stack(middles, axis=1)], axis=1)
