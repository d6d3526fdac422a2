"""Quality of curved cells: scaled Jacobians and determinants of the Jacobian."""

from __future__ import annotations

from itertools import product

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, MeshData, MeshError
from evolvent_meshes.mesh.reference_cells import node_positions, shape_gradients

_CHUNK = 20_000
_ROUNDING = 1e-12  # a cell is flat whose volume over that of its bounding cube is below this


def scaled_jacobians(mesh: MeshData) -> Floats:
    """Smallest scaled Jacobian of each cell (n_cells,) over its nodes and Gauss points.

    Quadrilaterals and hexahedra: det J / product of the lengths of J's columns. Triangles and tetrahedra: the same at
    the least favourable corner, times 2/√3 or √2. It is 1 for a square, cube or regular simplex, and negative for an
    inverted cell, in 2D a clockwise one.

    Source: "scaled Jacobian" of the Verdict library (Stimpson et al. 2007, Sandia SAND2007-1751), here at more points
    than the corners because the cells are curved.
    """
    dimension = CELL_DIMENSION[mesh.shape]
    gradients = shape_gradients(mesh.shape, mesh.order, _sample_points(mesh.shape, mesh.order))
    smallest = np.empty(len(mesh.cells))
    for start in range(0, len(mesh.cells), _CHUNK):
        nodes = mesh.points[mesh.cells[start : start + _CHUNK], :dimension]
        jacobians = np.einsum("cni,pnj->cpij", nodes, gradients)
        smallest[start : start + _CHUNK] = _scaled(mesh.shape, jacobians).min(axis=1)
    return smallest


def least_determinants(mesh: MeshData) -> Floats:
    """Smallest det J of each cell (n_cells,) over its nodes and Gauss points, divided by the largest |det J| there.

    Zero where it is below rounding; negative in 2D for cells that are numbered clockwise.
    """
    dimension = CELL_DIMENSION[mesh.shape]
    affine = mesh.order == 1 and mesh.shape in ("triangle", "tetrahedron")
    where = np.zeros((1, dimension)) if affine else _sample_points(mesh.shape, mesh.order)
    gradients = shape_gradients(mesh.shape, mesh.order, where)
    count = gradients.shape[1]
    operator = np.moveaxis(gradients, 1, 0).reshape(count, -1)
    smallest = np.empty(len(mesh.cells))
    for start in range(0, len(mesh.cells), _CHUNK):
        nodes = mesh.points[mesh.cells[start : start + _CHUNK], :dimension]
        columns = (np.swapaxes(nodes, 1, 2) @ operator).reshape(len(nodes), dimension, len(where), dimension)
        determinant = _determinants(np.moveaxis(columns, (1, 3), (0, 1)))
        size = np.ptp(nodes, axis=1).max(axis=1) ** dimension
        largest = np.abs(determinant).max(axis=1)
        solid = largest > _ROUNDING * size
        least = np.where(np.abs(determinant) > _ROUNDING * largest[:, None], determinant, 0.0).min(axis=1)
        smallest[start : start + _CHUNK] = np.where(solid, least / np.where(solid, largest, 1.0), 0.0)
    return smallest


def _determinants(J: Floats) -> Floats:
    """Determinants (...) of matrices (d, d, ...)."""
    if len(J) == 2:
        return np.asarray(J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0])
    cofactors = (J[1, b] * J[2, c] - J[1, c] * J[2, b] for b, c in ((1, 2), (2, 0), (0, 1)))
    return np.asarray(sum(row * cofactor for row, cofactor in zip(J[0], cofactors)))


def check_quality(mesh: MeshData, minimum: float) -> None:
    """Raises MeshError, with the position of the worst cell, if a scaled Jacobian is below `minimum`."""
    values = scaled_jacobians(mesh)
    worst = int(np.argmin(values))
    if not values[worst] >= minimum:
        x, y, z = mesh.points[mesh.cells[worst]].mean(axis=0)
        raise MeshError(
            f"mesh quality: wanted scaled Jacobians of at least {minimum:g}, found {values[worst]:.4f} in cell {worst} "
            f"at ({x:.4f}, {y:.4f}, {z:.4f}) mm and {np.count_nonzero(values < minimum)} such cells of "
            f"{len(values)}; refine or smooth the mesh there, or check the orientation of the cells"
        )


def _sample_points(shape: str, order: int) -> Floats:
    """Nodes and Gauss points (n, d) of the reference cell: three a direction, of simplices three or four points."""
    nodes = node_positions(shape, order) / 2.0
    dimension = CELL_DIMENSION[shape]
    if shape in ("triangle", "tetrahedron"):
        near, far = 1 / (2 * dimension), 1 - 1 / 2
        gauss = np.vstack([np.full(dimension, near), near + (far - near) * np.eye(dimension)])
    else:
        line = 0.5 + 0.5 * np.polynomial.legendre.leggauss(3)[0]
        gauss = np.array(list(product(line, repeat=dimension)))
    return np.vstack([nodes, gauss])


def _scaled(shape: str, jacobians: Floats) -> Floats:
    """Scaled Jacobians (...,) of Jacobian matrices (..., d, d)."""
    columns = np.moveaxis(jacobians, -1, 0)
    determinant = np.linalg.det(jacobians)
    if shape in ("quadrilateral", "hexahedron"):
        product_of_lengths = np.prod(np.linalg.norm(columns, axis=-1), axis=0)
        return _ratio(determinant, product_of_lengths)
    corners = np.concatenate([np.zeros_like(columns[:1]), columns])
    lengths = np.linalg.norm(corners[:, None] - corners[None, :], axis=-1)
    lengths[np.arange(len(corners)), np.arange(len(corners))] = 1.0
    regular = 2 / np.sqrt(3) if shape == "triangle" else np.sqrt(2)
    return _ratio(regular * determinant, lengths.prod(axis=1).max(axis=0))


def _ratio(determinant: Floats, scale: Floats) -> Floats:
    return np.asarray(np.divide(determinant, scale, out=np.full_like(determinant, -1.0), where=scale > 0))
