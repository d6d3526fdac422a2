"""Reference cells of contact facets: monomials, hat functions of the node grid, quadrature on its sub-facets.

The nodes of a second-order facet divide it into sub-facets of half its size. The hat functions ψ are linear, or
bilinear, on each sub-facet; they are not negative, unlike the shape functions N of second order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from evolvent.fem.lagrange import node_points, quadrature, tabulate
from evolvent_meshes.arrays import Floats, Ints

REVERSED_FACET = {
    ("interval", 1): [1, 0],
    ("interval", 2): [1, 0, 2],
    ("triangle", 1): [0, 2, 1],
    ("triangle", 2): [0, 2, 1, 3, 5, 4],
    ("quadrilateral", 1): [0, 2, 1, 3],
    ("quadrilateral", 2): [0, 2, 1, 3, 5, 4, 7, 6, 8],
}
"""(shape, order) -> permutation of a facet's nodes (basix order) that reverses its normal."""


@dataclass(frozen=True)
class ReferenceCell:
    """Reference cell of a facet of dimension dt = 1 or 2.

    nodes: (k, dt) Lagrange nodes, in the order of basix.
    corners: (c, dt) counter-clockwise.
    centre: (dt,) centroid.
    measure: length or area.
    exponents: (k, dt) exponents of the monomials.
    coefficients: (k, k) with N_k = Σ_i monomial_i coefficients_ik.
    subcells: (s, c, dt) corners of the sub-facets, counter-clockwise; hats are smooth on each of them.
    """

    nodes: Floats
    corners: Floats
    centre: Floats
    measure: float
    exponents: Ints
    coefficients: Floats
    subcells: Floats


@cache
def reference_cell(shape: str, order: int) -> ReferenceCell:
    """The reference cell of a facet: interval, quadrilateral or triangle, order 1 or 2. Raises ValueError."""
    if (shape, order) not in REVERSED_FACET:
        raise ValueError(f"facet: wanted one of {sorted(REVERSED_FACET)}, found {(shape, order)}; mesh with these")
    nodes = node_points(shape, order)
    dimension = nodes.shape[1]
    powers = np.array(list(np.ndindex(*(order + 1,) * dimension)), dtype=np.int64)
    exponents = powers[powers.sum(axis=1) <= order] if shape == "triangle" else powers
    vandermonde = np.prod(nodes[:, None, :] ** exponents, axis=2)
    corners = nodes[[0, 1, 3, 2]] if shape == "quadrilateral" else nodes[: dimension + 1]
    return ReferenceCell(
        nodes=nodes,
        corners=corners,
        centre=corners.mean(axis=0),
        measure=0.5 if shape == "triangle" else 1.0,
        exponents=exponents,
        coefficients=np.rint(np.linalg.inv(vandermonde)),  # integers for equispaced nodes of order 1 and 2
        subcells=corners[None] if order == 1 else _halved(shape, corners),
    )


def _halved(shape: str, corners: Floats) -> Floats:
    """Corners (s, c, dt) of the sub-facets: one at each corner and, in a triangle, an inverted one in the middle."""
    cells = 0.5 * (corners[:, None, :] + corners[None, :, :])
    if shape == "triangle":
        middle = 0.5 * (corners + np.roll(corners, -1, axis=0))
        cells = np.concatenate([cells, middle[None]])
    return cells


def monomials(cell: ReferenceCell, xi: Floats) -> tuple[Floats, list[Floats]]:
    """Monomials (..., k) of a reference cell, and their derivatives along each direction, at points xi (..., dt)."""
    columns = [_powers(xi[..., i], e) for i, e in enumerate(cell.exponents.T)]
    value, first = columns[0]
    if len(columns) == 1:
        return value, [first]
    value2, first2 = columns[1]
    return value * value2, [first * value2, value * first2]


def _powers(x: Floats, exponents: Ints) -> tuple[Floats, Floats]:
    """Powers x**e (..., k) and their derivatives (..., k), for x (...) and exponents e (k,) of at most 2."""
    value, first = np.empty((*x.shape, len(exponents))), np.empty((*x.shape, len(exponents)))
    for k, e in enumerate(exponents):
        value[..., k] = 1.0 if e == 0 else x if e == 1 else x * x
        first[..., k] = 0.0 if e == 0 else 1.0 if e == 1 else 2.0 * x
    return value, first


def hats(shape: str, order: int, xi: ArrayLike) -> Floats:
    """Hat functions ψ (q, k) of a facet at reference points xi (q, dt).

    Piecewise linear or bilinear, not negative inside the facet, one at their node, and of sum one. In order 2 they are
    smooth only on each sub-facet (2 of an interval, 4 of a quadrilateral or a triangle).
    """
    x = np.asarray(xi, dtype=np.float64)
    if order == 1:
        return tabulate(shape, order, x)[0]
    if shape == "triangle":
        return _triangle_hats(x)
    nodes = reference_cell(shape, order).nodes
    return np.prod(np.maximum(0.0, 1.0 - 2.0 * np.abs(x[..., None, :] - nodes)), axis=-1)


def _triangle_hats(x: Floats) -> Floats:
    double = 2.0 * np.concatenate([1.0 - x.sum(axis=-1, keepdims=True), x], axis=-1)  # twice the barycentric
    corners = np.maximum(0.0, double - 1.0)
    edges = [np.minimum(np.minimum(double[..., i], double[..., j]), 1.0 - double[..., 3 - i - j]) for i, j in
             ((1, 2), (0, 2), (0, 1))]
    return np.concatenate([corners, np.maximum(0.0, np.stack(edges, axis=-1))], axis=-1)


def subcell_rule(shape: str, order: int, degree: int) -> tuple[Floats, Floats]:
    """Points (q, dt) and weights (q,) of a rule that is exact for polynomials of this degree on every sub-facet."""
    cell = reference_cell(shape, order)
    x, w = quadrature(shape, degree)
    edges = np.stack([cell.subcells[:, 1], cell.subcells[:, -1]][: x.shape[1]], axis=1) - cell.subcells[:, :1]
    points = cell.subcells[:, :1] + x @ edges
    weights = np.abs(np.linalg.det(edges))[:, None] * w
    return points.reshape(-1, x.shape[1]), weights.reshape(-1)


def cross(a: Floats, b: Floats) -> Floats:
    """Cross product a × b (..., 3); numpy.cross takes several times longer on short vectors."""
    return np.stack(
        [
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ],
        axis=-1,
    )


def area_vector(tangents: Sequence[Floats]) -> Floats:
    """Outward normal times dA/dξ (..., d), from the tangents ∂x/∂ξ_i (..., d)."""
    if len(tangents) == 2:
        return cross(tangents[0], tangents[1])
    return np.stack([tangents[0][..., 1], -tangents[0][..., 0]], axis=-1)
