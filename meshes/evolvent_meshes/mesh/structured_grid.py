"""Structured grids as plain arrays: graded lines, lattices, welding, boundary facets, splitting into simplices."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData, MeshError
from evolvent_meshes.mesh.reference_cells import CORNERS, corner_count, facet_nodes, node_positions, sub_cell_nodes

TENSOR_SHAPE = {2: "quadrilateral", 3: "hexahedron"}
SIMPLEX = {"quadrilateral": "triangle", "hexahedron": "tetrahedron"}


def subdivided(ends: Floats, order: int) -> Floats:
    """Node positions on a line of cells: the cell ends (n + 1,) and, at order 2, the middles between them."""
    if order == 1:
        return ends
    return np.insert(ends, np.arange(1, len(ends)), 0.5 * (ends[1:] + ends[:-1]))


def graded_ends(length: float, size: float, fine: float, growth: float = 1.3) -> Floats:
    """Cell ends (n + 1,) of a graded line from 0 to `length` [mm].

    size: largest cells over [0, fine] [mm].
    fine: end of the fine part [mm].
    growth: largest ratio of a cell's length to that of the one before, outside the fine part.
    Raises MeshError unless size > 0, 0 <= fine < length and growth >= 1.
    """
    if not (size > 0 and 0 <= fine < length and growth >= 1):
        raise MeshError(
            f"graded line: wanted size > 0, 0 <= fine < length and growth >= 1, found size {size}, fine {fine}, "
            f"length {length}, growth {growth}"
        )
    n_fine = int(np.ceil(fine / size - 1e-9))
    step = fine / n_fine if n_fine else size
    sizes = [step * growth]
    while sum(sizes) < length - fine:
        sizes.append(sizes[-1] * growth)
    coarse = np.cumsum(sizes) * (length - fine) / sum(sizes)
    return np.concatenate([np.linspace(0, fine, n_fine + 1), fine + coarse])


def mirrored_line(ends: Floats) -> Floats:
    """Cell ends (2n + 1,) of a line (n + 1,) that starts at 0 and of its mirror image."""
    return np.concatenate([-ends[:0:-1], ends])


def lattice_cells(counts: tuple[int, ...], order: int) -> Ints:
    """Quadrilaterals or hexahedra (n_cells, nodes per cell) of a lattice of points, as indices in the order of gmsh.

    counts: cells n in each direction; the lattice has order * n + 1 points in each, in C order.
    """
    numbers = np.arange(np.prod([order * n + 1 for n in counts])).reshape([order * n + 1 for n in counts])
    first = numbers[tuple(slice(0, order * n, order) for n in counts)].ravel()
    offsets = node_positions(TENSOR_SHAPE[len(counts)], order) * order // 2
    origin = numbers[(0,) * len(counts)]
    return np.asarray(first[:, None] + (numbers[tuple(offsets.T)] - origin), dtype=np.int64)


def tensor_points(*lines: Floats) -> Floats:
    """Points (n, number of lines) of the tensor product of lines, in C order."""
    return np.stack([x.ravel() for x in np.meshgrid(*lines, indexing="ij")], axis=1)


def weld(points: Floats, tolerance: float) -> tuple[Ints, Ints]:
    """Merge points (n, d) closer than `tolerance`: indices of the points kept (m,), new number of each point (n,)."""
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    _, group = connected_components(links, directed=False)
    _, keep, number = np.unique(group, return_index=True, return_inverse=True)
    return keep.astype(np.int64), number.ravel().astype(np.int64)


def transfinite(south: Floats, north: Floats, west: Floats, east: Floats, s: Floats, t: Floats) -> Floats:
    """Transfinite interpolation: grid (n, m, d) between edges south and north (n, d), west and east (m, d).

    s: (n,) and t: (m,) blending parameters from 0 to 1.
    """
    across, along = s[:, None, None], t[None, :, None]
    between_sides = (1 - across) * west[None] + across * east[None]
    between_ends = (1 - along) * south[:, None] + along * north[:, None]
    low, high = ((1 - across) * west[k] + across * east[k] for k in (0, -1))
    return np.asarray(between_sides + between_ends - (1 - along) * low - along * high)


def all_facets(shape: str, order: int, cells: Ints) -> Ints:
    """Facets (n, nodes per facet) of all cells (n_cells, nodes per cell), each once."""
    return _facets_and_counts(shape, order, cells)[0]


def boundary_facets(shape: str, order: int, cells: Ints) -> Ints:
    """Facets (n, nodes per facet) of a single cell, which are the boundary."""
    facets, counts = _facets_and_counts(shape, order, cells)
    return facets[counts == 1]


def _facets_and_counts(shape: str, order: int, cells: Ints) -> tuple[Ints, Ints]:
    local = facet_nodes(shape, order)
    facets = cells[:, local].reshape(-1, local.shape[1])
    if order == 2 and FACET_SHAPE[shape] != "triangle":  # the node in the middle of a facet belongs to it alone
        _, index, counts = np.unique(facets[:, -1], return_index=True, return_counts=True)
    else:
        corners = np.sort(facets[:, : corner_count(FACET_SHAPE[shape])], axis=1)
        _, index, counts = np.unique(corners, axis=0, return_index=True, return_counts=True)
    order_of_cells = np.argsort(index)
    return facets[index[order_of_cells]], counts[order_of_cells]


def facets_where(facets: Ints, nodes: Bools) -> Ints:
    """The facets of which all nodes are True in `nodes` (n_points,)."""
    return facets[nodes[facets].all(axis=1)]


def _triangles_on(triangles: Ints, quadrilaterals: Ints) -> Ints:
    """The triangles whose corners are corners of one of the quadrilaterals."""
    halves = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]]
    wanted = np.sort(quadrilaterals[:, halves].reshape(-1, 3), axis=1)
    corners = np.sort(triangles[:, :3], axis=1)
    _, number = np.unique(np.vstack([wanted, corners]), axis=0, return_inverse=True)
    number = number.ravel()
    return triangles[np.isin(number[len(wanted) :], number[: len(wanted)])]


def split_to_simplices(mesh: MeshData, key: Ints | None = None) -> MeshData:
    """A conforming mesh of simplices on the same nodes: 2 triangles a quadrilateral, 6 tetrahedra a hexahedron.

    Hexahedra must be swept from their face 0123 to 4567, throughout the mesh in the same direction.

    key: (n_points,) numbers that are equal along a line of the sweep and differ between the corners of a section's
        cell. Diagonals run from the smaller key at the bottom to the larger one at the top: faces with equal keys have
        equal diagonals. Default in 2D: the node numbers.
    Raises MeshError for simplices, and for hexahedra without a key.
    """
    if mesh.shape == "quadrilateral":
        local = _two_triangles(mesh.cells, np.arange(len(mesh.points)) if key is None else key)
        cells = _simplices(mesh, "triangle", local)
        return _with_simplices(mesh, cells, 2)
    if mesh.shape != "hexahedron" or key is None:
        raise MeshError(
            f"split to simplices: wanted quadrilaterals, or hexahedra with a column key, found {mesh.shape} and "
            f"{'no' if key is None else 'a'} key"
        )
    cells = _simplices(mesh, "tetrahedron", _six_tetrahedra(mesh.cells, key))
    return _with_simplices(mesh, cells, 6)


def _two_triangles(cells: Ints, key: Ints) -> Ints:
    """Local corners (n_cells, 2, 3) of two triangles; the diagonal starts at the corner with the smallest key."""
    first = np.argmin(key[cells[:, :4]], axis=1)[:, None]
    return (first[:, None] + np.array([[0, 1, 2], [0, 2, 3]])) % 4


def _six_tetrahedra(cells: Ints, key: Ints) -> Ints:
    """Local corners (n_cells, 6, 4) of six tetrahedra, positively oriented."""
    triangles = _two_triangles(cells, key)
    keys = key[np.take_along_axis(cells[:, None, :4], triangles, axis=2)]
    bottom = np.take_along_axis(triangles, np.argsort(keys, axis=2), axis=2)
    prism = np.concatenate([bottom, bottom + 4], axis=2)
    tets = prism[:, :, [[0, 1, 2, 5], [0, 1, 4, 5], [0, 3, 4, 5]]].reshape(len(cells), 6, 4)
    position = np.array(CORNERS["hexahedron"])[tets]
    negative = np.linalg.det(position[:, :, 1:] - position[:, :, :1]) < 0
    tets[negative] = tets[negative][:, [1, 0, 2, 3]]
    return tets


def _simplices(mesh: MeshData, simplex: str, corners: Ints) -> Ints:
    """Simplices (n, nodes per simplex) in the order of gmsh from local corners (n_cells, simplices a cell, corners)."""
    flat = corners.reshape(-1, corners.shape[2])
    kinds, kind = np.unique(flat, axis=0, return_inverse=True)
    local = sub_cell_nodes(mesh.shape, simplex, kinds, mesh.order)[kind.ravel()]
    parents = np.repeat(mesh.cells, corners.shape[1], axis=0)
    return np.take_along_axis(parents, local, axis=1)


def _with_simplices(mesh: MeshData, cells: Ints, per_cell: int) -> MeshData:
    simplex = SIMPLEX[mesh.shape]
    facets = mesh.facets
    if simplex == "tetrahedron":
        candidates = all_facets(simplex, mesh.order, cells)
        facets = {name: _triangles_on(candidates, quads) for name, quads in mesh.facets.items()}
    volumes = {name: (index[:, None] * per_cell + np.arange(per_cell)).ravel() for name, index in mesh.volumes.items()}
    return MeshData(mesh.points, simplex, mesh.order, cells, facets, volumes)
