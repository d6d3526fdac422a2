"""Checks of a mesh before it is used: types, indices, finite points, groups, cells without folds."""

from __future__ import annotations

from typing import Any

import numpy as np

from evolvent_meshes.arrays import Ints
from evolvent_meshes.input_checks import is_index, kind_of, refuse_huge, shown
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, FACET_SHAPE, MeshData, MeshError
from evolvent_meshes.mesh.quality import least_determinants
from evolvent_meshes.mesh.reference_cells import corner_count, node_count

FLAT = 1e-9  # largest extent in z of a 2D mesh over that in x and y


def check_mesh(mesh: MeshData, name: str) -> None:
    """Raises MeshError for a mesh that the solver cannot use or that gives wrong results.

    name: of the body, first in the message.
    """
    if not isinstance(mesh, MeshData):
        raise MeshError(f"{name}: wanted a MeshData, found {shown(mesh)}; read a gmsh file with read_msh(path)")
    check_cells(mesh.points, mesh.cells, mesh.shape, mesh.order, name)
    loose = np.flatnonzero(np.bincount(mesh.cells.ravel(), minlength=len(mesh.points)) == 0)
    if len(loose):
        raise MeshError(
            f"{name}: wanted every point in a cell, found {len(loose)} points in none, the first is point {loose[0]}; "
            "remove them and renumber the others"
        )
    _check_groups(mesh, name)
    if mesh.dimension == 2 and np.ptp(mesh.points[:, 2]) > FLAT * np.ptp(mesh.points[:, :2]):
        low, high = mesh.points[:, 2].min(), mesh.points[:, 2].max()
        raise MeshError(
            f"{name}: wanted {mesh.shape}s in the plane z = 0, found z from {low:g} to {high:g}; flatten them"
        )
    _check_distinct(mesh, name)
    _check_folds(mesh, name)


def check_cells(points: Any, cells: Any, shape: Any, order: Any, name: str) -> None:
    """Raises MeshError unless these are finite points (n, 3) and complete Lagrange cells on them.

    name: of the body, first in the message.
    """
    if not isinstance(shape, str) or shape not in CELL_DIMENSION:
        raise MeshError(
            f"{name}: wanted cells of shape {', '.join(CELL_DIMENSION)}, found {shown(shape)}; mesh with these"
        )
    if not is_index(order) or order not in (1, 2):
        raise MeshError(f"{name}: wanted cells of order 1 or 2, found {shown(order)}; set Mesh.ElementOrder in gmsh")
    if not isinstance(points, np.ndarray) or points.dtype.kind != "f" or points.ndim != 2 or points.shape[1] != 3:
        raise MeshError(
            f"{name}: wanted points (n, 3) of type float64 in mm, found {_array(points)}; a 2D mesh has z = 0"
        )
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise MeshError(
            f"{name}: wanted finite coordinates, found {len(bad)} points of {len(points)} that are not, the first is "
            f"point {bad[0]}; correct the file"
        )
    refuse_huge(f"{name}, points", points)
    _check_indices(f"{name}: cells", cells, node_count(shape, order), f"{shape} cells of order {order}", len(points))
    if not len(cells):
        raise MeshError(f"{name}: wanted at least one cell, found none; generate the mesh first")


def _check_indices(what: str, value: Any, width: int, of: str, count: int) -> None:
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "iu" or value.ndim != 2 or value.shape[1] != width:
        raise MeshError(
            f"{what}: wanted integers (n, {width}) for {of}, found {_array(value)}; gmsh must write complete "
            "second-order cells (Mesh.SecondOrderIncomplete = 0)"
        )
    if len(value) and not (value.min() >= 0 and value.max() < count):
        row = int(np.argmax(((value < 0) | (value >= count)).any(axis=1)))
        raise MeshError(
            f"{what}: wanted points from 0 to {count - 1}, found {value[row].tolist()} in row {row}; count the points "
            "from 0"
        )


def _array(value: Any) -> str:
    return f"shape {value.shape} of type {value.dtype}" if isinstance(value, np.ndarray) else kind_of(value)


def _check_groups(mesh: MeshData, name: str) -> None:
    if not isinstance(mesh.facets, dict) or not all(isinstance(key, str) for key in mesh.facets):
        raise MeshError(f"{name}: wanted facet groups by their names, found {shown(mesh.facets)}; give a dict")
    shape = FACET_SHAPE[mesh.shape]
    for group, facets in mesh.facets.items():
        of = f"{shape} facets of order {mesh.order}"
        _check_indices(f"{name}: facet group {group!r}", facets, node_count(shape, mesh.order), of, len(mesh.points))


def _check_distinct(mesh: MeshData, name: str) -> None:
    corners: Ints = np.sort(mesh.cells[:, : corner_count(mesh.shape)], axis=1)
    corners = corners[np.lexsort(corners.T)]
    twice = int(np.count_nonzero((corners[1:] == corners[:-1]).all(axis=1)))
    if twice:
        raise MeshError(f"{name}: wanted every cell once, found {twice} that are there again; leave the copies out")


def _check_folds(mesh: MeshData, name: str) -> None:
    """Raises MeshError for cells that are folded, flat or numbered clockwise; their stiffness would be wrong."""
    least = least_determinants(mesh)
    bad = least <= 0.0
    if not bad.any():
        return
    if mesh.dimension == 2 and (least < 0.0).all() and not (least_determinants(mesh.turned_over()) <= 0.0).any():
        raise MeshError(
            f"{name}: wanted cells numbered counter-clockwise, found all {len(bad)} the other way round; use "
            "MeshData.turned_over()"
        )
    worst = int(np.argmin(least))
    x, y, z = mesh.points[mesh.cells[worst]].mean(axis=0)
    raise MeshError(
        f"{name}: wanted cells with a Jacobian above zero everywhere, found {np.count_nonzero(bad)} of {len(bad)} "
        f"cells folded or flat, the worst is cell {worst} at ({x:.4g}, {y:.4g}, {z:.4g}) mm; correct the mesh there, "
        "or number these cells the other way round if only that is wrong"
    )
