"""A mesh as plain arrays, with named groups; the only thing that passes from gmsh to the solver."""

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

def _as(value: Any, kinds: str, wanted: type) -> Any:
    """An array of one of these kinds in the wanted type, not copied where it is; anything else as it is."""
    return value.astype(wanted, copy=False) if isinstance(value, np.ndarray) and value.dtype.kind in kinds else value


TURNED = {
    ("triangle", 1): [0, 2, 1],
    ("triangle", 2): [0, 2, 1, 5, 4, 3],
    ("quadrilateral", 1): [0, 3, 2, 1],
    ("quadrilateral", 2): [0, 3, 2, 1, 7, 6, 5, 4, 8],
}
"""Nodes of a plane cell in gmsh's order that make it run the other way round."""


class MeshError(InputError):
    """A mesh that cannot be used as it is; the message says what was wanted, what was found and what to do."""


@dataclass(frozen=True)
class MeshData:
    """One body's mesh, Lagrange cells of order 1 or 2, node numbering as gmsh's.

    points: (n, 3) node coordinates [mm]; a 2D mesh has z = 0.
    shape: "triangle", "quadrilateral", "tetrahedron" or "hexahedron".
    order: 1 or 2 (complete Lagrange: quad9, hex27, tri6, tet10).
    cells: (n_cells, nodes per cell) node indices in gmsh's node order.
    facets: name -> (n_f, nodes per facet) node indices in gmsh's node order (line2/3, quad4/9, tri3/6), outward
        orientation not guaranteed.
    volumes: name -> (n_c,) cell indices.
    """

    points: Floats
    shape: str
    order: int
    cells: Ints
    facets: dict[str, Ints]
    volumes: dict[str, Ints]

    def __post_init__(self) -> None:
        """Arrays of numbers in the types that the solver works with; `soundness` refuses all others."""
        given = {"points": _as(self.points, "f", np.float64), "cells": _as(self.cells, "iu", np.int64)}
        if isinstance(self.facets, dict):
            given["facets"] = {name: _as(rows, "iu", np.int64) for name, rows in self.facets.items()}
        for name, value in given.items():
            object.__setattr__(self, name, value)

    @property
    def dimension(self) -> int:
        """Topological dimension, 2 or 3."""
        return CELL_DIMENSION[self.shape]

    def turned_over(self) -> MeshData:
        """The same mesh with the nodes of its 2D cells in the opposite sense of rotation: of a mesh that is numbered
        clockwise, one that is numbered counter-clockwise. Raises MeshError in 3D."""
        if self.dimension == 3:
            raise MeshError(f"turn over: wanted a 2D mesh, found {self.shape}s; number the cells of a 3D mesh anew")
        return replace(self, cells=np.ascontiguousarray(self.cells[:, TURNED[self.shape, self.order]]))
