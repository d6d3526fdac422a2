"""Lagrange shape functions and quadrature on reference cells and facets, by basix.

The solver numbers nodes in the order of basix; `gmsh_permutation` converts connectivity from the order of gmsh.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import basix
import numpy as np

from evolvent.fem.backend import dolfinx_compat
from evolvent_meshes.arrays import Floats, Ints


@cache
def _element(shape: str, order: int) -> Any:
    return basix.create_element(
        basix.ElementFamily.P, getattr(basix.CellType, shape), order, basix.LagrangeVariant.equispaced
    )


def tabulate(shape: str, order: int, xi: Floats) -> tuple[Floats, Floats]:
    """Shape functions N (q, k) and their reference gradients ∂N/∂ξ (q, t, k).

    xi: (q, t) points of the reference cell, [0, 1]^t or the unit simplex.
    """
    xi = np.asarray(xi, dtype=float)
    table = _element(shape, order).tabulate(1, xi)[..., 0]
    return table[0], np.ascontiguousarray(np.moveaxis(table[1:], 0, 1))


@cache
def node_points(shape: str, order: int) -> Floats:
    """Reference coordinates (k, t) of the nodes."""
    return np.asarray(_element(shape, order).points, dtype=float)


@cache
def quadrature(shape: str, degree: int) -> tuple[Floats, Floats]:
    """Points (q, t) and weights (q,) of a rule that is exact for polynomials of this degree on the reference cell."""
    points, weights = basix.make_quadrature(getattr(basix.CellType, shape), degree)
    return np.asarray(points, dtype=float), np.asarray(weights, dtype=float)


@cache
def gmsh_permutation(shape: str, order: int) -> Ints:
    """Permutation perm (k,): cells[:, perm] are in the node order of basix where cells are in that of gmsh."""
    return dolfinx_compat.gmsh_permutation(shape, len(node_points(shape, order)))
