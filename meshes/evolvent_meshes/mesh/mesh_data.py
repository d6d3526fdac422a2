"""A mesh as plain arrays with named groups, the interface between gmsh and the solver."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError

CELL_DIMENSION = {"triangle": 2, "quadrilateral": 2, "tetrahedron": 3, "hexahedron": 3}
FACET_SHAPE = {
    "triangle": "interval",
    "quadrilateral": "interval",
    "tetrahedron": "triangle",
    "hexahedron": "quadrilateral",
}
REVERSED_CELL = {
    ("triangle", 1): [0, 2, 1],
    ("triangle", 2): [0, 2, 1, 5, 4, 3],
    ("quadrilateral", 1): [0, 3, 2, 1],
    ("quadrilateral", 2): [0, 3, 2, 1, 7, 6, 5, 4, 8],
}
"""(shape, order) -> permutation of a plane cell's nodes (gmsh order) that reverses its sense of rotation."""


class MeshError(InputError):
    """A mesh that cannot be used; the message says what was wanted, what was found and what to do."""


@dataclass(frozen=True)
class MeshData:
    """Mesh of one body: Lagrange cells of one shape, with named groups of facets and cells.

    points: (n, 3) node coordinates [mm]; a 2D mesh has z = 0.
    shape: of the cells, "triangle", "quadrilateral", "tetrahedron" or "hexahedron".
    order: of the cells, 1 or 2 (complete Lagrange: quad9, hex27, tri6, tet10).
    cells: (n_cells, nodes per cell) node indices in the node order of gmsh.
    facets: name -> (n_f, nodes per facet) node indices in the node order of gmsh (line2/3, quad4/9, tri3/6), of any
        orientation.
    volumes: name -> (n_c,) cell indices.

    >>> points = np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 0.0], [40.0, 20.0, 0.0], [0.0, 20.0, 0.0]])
    >>> facets = {"bottom": np.array([[0, 1]]), "top": np.array([[2, 3]])}
    >>> mesh = MeshData(points, "quadrilateral", 1, np.array([[0, 1, 2, 3]]), facets, {"block": np.array([0])})
    >>> mesh.dimension
    2
    """

    points: Floats
    shape: str
    order: int
    cells: Ints
    facets: dict[str, Ints]
    volumes: dict[str, Ints]

    def __post_init__(self) -> None:
        """Converts arrays of numbers to float64 and int64; `soundness.check_mesh` refuses anything else."""
        given = {"points": _converted(self.points, "f", np.float64), "cells": _converted(self.cells, "iu", np.int64)}
        if isinstance(self.facets, dict):
            given["facets"] = {name: _converted(rows, "iu", np.int64) for name, rows in self.facets.items()}
        for name, value in given.items():
            object.__setattr__(self, name, value)

    @property
    def dimension(self) -> int:
        """Topological dimension, 2 or 3."""
        return CELL_DIMENSION[self.shape]

    def turned_over(self) -> MeshData:
        """A copy of a 2D mesh with the opposite sense of rotation of its cells, counter-clockwise instead of clockwise.

        Raises MeshError in 3D.
        """
        if self.dimension == 3:
            raise MeshError(f"turn over: wanted a 2D mesh, found {self.shape}s; renumber the nodes of its cells")
        return replace(self, cells=np.ascontiguousarray(self.cells[:, REVERSED_CELL[self.shape, self.order]]))


def _converted(value: Any, kinds: str, dtype: type) -> Any:
    """An array of one of these kinds as `dtype`, copied only where necessary; anything else unchanged."""
    return value.astype(dtype, copy=False) if isinstance(value, np.ndarray) and value.dtype.kind in kinds else value
