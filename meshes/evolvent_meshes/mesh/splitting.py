"""Second-order quadrilaterals and hexahedra split into smaller ones, by counts that differ between classes of edges.

The parallel edges of a cell must be split alike, and so those of all cells that they pass through: they are a class.
Whatever the counts of the classes, the split mesh is conforming. Its nodes lie on the cells' second-order geometry, and
its functions contain those of the mesh before.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.reference_cells import facet_nodes, line_functions, node_positions
from evolvent_meshes.mesh.structured_grid import lattice_cells, tensor_points, weld

SAME_POINT = 1e-8
"""Points closer than this are one node [mm]; rounding leaves 1e-13, the smallest cells are 1e-3."""


@dataclass(frozen=True)
class SplitMesh:
    """A mesh and where it comes from."""

    mesh: MeshData
    """The smaller cells, with the groups of the mesh before."""
    parent: Ints
    """Cell before the split (cells,) of each cell."""
    values: sp.csr_matrix
    """Shape functions (nodes, nodes before) of the mesh before at the nodes."""


def edge_classes(mesh: MeshData) -> Ints:
    """Class (n_cells, d) of the edges along each reference axis of each cell. Raises MeshError for another mesh."""
    if mesh.order != 2 or mesh.shape not in ("quadrilateral", "hexahedron"):
        raise MeshError(
            f"split: wanted second-order quadrilaterals or hexahedra, found {mesh.shape}s of order {mesh.order}; mesh "
            "with these"
        )
    positions = node_positions(mesh.shape, 2)
    middles = (positions == 1).sum(axis=1) == 1  # a second-order edge has one middle node, which numbers it
    axis = np.argmax(positions == 1, axis=1)
    edges = np.stack([mesh.cells[:, middles & (axis == a)] for a in range(mesh.dimension)], axis=1)
    first, others = np.broadcast_arrays(edges[..., :1], edges[..., 1:])
    size = len(mesh.points)
    links = sp.coo_matrix((np.ones(first.size), (first.ravel(), others.ravel())), shape=(size, size))
    return np.asarray(connected_components(links, directed=False)[1][edges[..., 0]], dtype=np.int64)


def split(mesh: MeshData, counts: Ints) -> SplitMesh:
    """Every cell of a second-order mesh split into counts (n_cells, d) along its reference axes.

    counts: equal within a class of edges. Raises MeshError where they are not.
    """
    _check_counts(edge_classes(mesh), counts)
    kinds, kind = np.unique(counts, axis=0, return_inverse=True)
    lattices = [_Lattice.of(mesh, np.flatnonzero(kind.ravel() == k), tuple(n)) for k, n in enumerate(kinds.tolist())]
    keep, number = weld(np.concatenate([lattice.points for lattice in lattices]), SAME_POINT)
    starts = np.cumsum([0, *(len(lattice.points) for lattice in lattices)])
    cells = np.concatenate([number[start + lattice.cells] for start, lattice in zip(starts, lattices)])
    parent = np.concatenate([lattice.parent for lattice in lattices])
    facets = {
        name: np.concatenate([number[start + lattice.facets(mesh, rows)] for start, lattice in zip(starts, lattices)])
        for name, rows in mesh.facets.items()
    }
    volumes = {name: np.flatnonzero(np.isin(parent, old)) for name, old in mesh.volumes.items()}
    values = sp.vstack([lattice.values(mesh) for lattice in lattices], format="csr")[keep]
    return SplitMesh(MeshData(values @ mesh.points, mesh.shape, 2, cells, facets, volumes), parent, values)


def halved(mesh: MeshData) -> MeshData:
    """Every cell of a second-order mesh cut into halves in every direction: it is finer everywhere by the same factor,
    while a mesh that is made anew with more elements grades differently. Raises MeshError for another mesh."""
    return split(mesh, np.full((len(mesh.cells), mesh.dimension), 2)).mesh


def _check_counts(classes: Ints, counts: Ints) -> None:
    most = np.zeros(classes.max() + 1, dtype=np.int64)
    np.maximum.at(most, classes, counts)
    if counts.min() < 1 or (most[classes] != counts).any():
        cell = int(np.argmax((most[classes] != counts).any(axis=1) | (counts < 1).any(axis=1)))
        raise MeshError(
            f"split: wanted counts of at least 1 that are equal along each class of edges, found {counts[cell]} in "
            f"cell {cell}, whose classes have {most[classes[cell]]}; take the largest of each class"
        )


@dataclass(frozen=True)
class _Lattice:
    """The points of all cells that are split alike.

    parents: (n,) their numbers.
    counts: (d,) of the smaller cells along the reference axes.
    shapes: (q, k) shape functions of a cell at its q lattice points.
    points: (n·q, 3) of all cells, those of a cell together [mm].
    local: (m, k) smaller cells of a cell on its lattice.
    """

    parents: Ints
    counts: tuple[int, ...]
    shapes: Floats
    points: Floats
    local: Ints

    @staticmethod
    def of(mesh: MeshData, parents: Ints, counts: tuple[int, ...]) -> _Lattice:
        at = tensor_points(*(np.linspace(0.0, 1.0, 2 * n + 1) for n in counts))
        positions = node_positions(mesh.shape, 2)
        lines = line_functions(2, at)[0]
        shapes = np.prod([lines[:, a, positions[:, a]] for a in range(len(counts))], axis=0)
        points = np.einsum("qk,nkx->nqx", shapes, mesh.points[mesh.cells[parents]]).reshape(-1, 3)
        return _Lattice(parents, counts, shapes, points, lattice_cells(counts, 2))

    @property
    def cells(self) -> Ints:
        """Cells (n·m, k) on the points of all cells."""
        return self._of_all(self.local)

    @property
    def parent(self) -> Ints:
        """Cell before the split (n·m,) of each cell."""
        return np.repeat(self.parents, len(self.local))

    def values(self, mesh: MeshData) -> sp.csr_matrix:
        """Shape functions (n·q, nodes before) at all points."""
        columns = np.repeat(mesh.cells[self.parents], len(self.shapes), axis=0)
        data = np.tile(self.shapes, (len(self.parents), 1))
        ends = data.shape[1] * np.arange(len(data) + 1)
        matrix = sp.csr_matrix((data.ravel(), columns.ravel(), ends), shape=(len(data), len(mesh.points)))
        matrix.data[np.abs(matrix.data) < 1e-14] = 0.0
        matrix.eliminate_zeros()
        return matrix

    def facets(self, mesh: MeshData, wanted: Ints) -> Ints:
        """The smaller facets of those of the `wanted` (f, nodes) that belong to these cells."""
        centres = mesh.cells[self.parents][:, [face[-1] for face in facet_nodes(mesh.shape, 2)]]
        found = [self._side(side)[np.isin(centres[:, side], wanted[:, -1])] for side in range(centres.shape[1])]
        return np.concatenate([facets.reshape(-1, wanted.shape[1]) for facets in found])

    def _side(self, side: int) -> Ints:
        """The smaller facets (n, m, nodes) of all cells on a local facet."""
        shape = {2: "quadrilateral", 3: "hexahedron"}[len(self.counts)]
        centre = node_positions(shape, 2)[facet_nodes(shape, 2)[side][-1]]
        axis = int(np.argmax(centre != 1))
        numbers = np.arange(len(self.shapes)).reshape([2 * n + 1 for n in self.counts])
        on_side = np.take(numbers, -int(centre[axis] > 0), axis=axis).ravel()
        others = tuple(n for a, n in enumerate(self.counts) if a != axis)
        local = on_side[_lattice_facets(others)]
        return self._of_all(local).reshape(len(self.parents), len(local), -1)

    def _of_all(self, local: Ints) -> Ints:
        """Nodes (m, k) on the lattice of a cell, of all cells (n·m, k)."""
        first = len(self.shapes) * np.arange(len(self.parents))
        return (first[:, None, None] + local).reshape(-1, local.shape[1])


def _lattice_facets(counts: tuple[int, ...]) -> Ints:
    """Intervals or quadrilaterals on a lattice, in the order of gmsh."""
    if len(counts) > 1:
        return lattice_cells(counts, 2)
    return np.asarray(2 * np.arange(counts[0])[:, None] + np.array([0, 2, 1]), dtype=np.int64)
