"""Reference implementation of pairing.py in plain loops, slow and readable, with SciPy's root finder.

Tests compare the two. Every facet of surface 1 is tried against every facet of surface 2, one point at a time. They
share definitions (continuation of facets beyond their edges, chords in place of curved edges), but no code except
`Surface`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import root

from evolvent.contact.search.pairing import Pairing
from evolvent.fem.lagrange import quadrature, tabulate
from evolvent.fem.reference_facets import area_vector, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats

EXTENSION = 1.1  # as in projection.py: facets are continued linearly beyond 1.1 times their size
OPPOSED = -0.2  # as in facet_candidates.py: n1·n2 of facets that can meet

_Row = tuple[int, Floats, int, Floats, float, float]


def pair_surfaces_slowly(surface1: Surface, surface2: Surface, max_gap: float, max_overlap: float,
                         degree: int = 4) -> Pairing:
    """Reference for `pairing.pair_surfaces`, for a few facets. Raises RuntimeError where a root is not found."""
    rows = []
    for f1 in range(len(surface1.facets)):
        for f2 in range(len(surface2.facets)):
            if _may_meet(surface1, f1, surface2, f2, max(max_gap, max_overlap)):
                rows += _pair(surface1, f1, surface2, f2, degree)
    rows = [r for r in rows if -max_overlap <= r[5] <= max_gap]
    facet1, xi1, facet2, xi2, weight, gap = zip(*rows, strict=True) if rows else ((),) * 6
    d = surface1.points.shape[1]
    return Pairing(np.array(facet1, dtype=np.int64), np.array(xi1).reshape(-1, d - 1), np.array(facet2, dtype=np.int64),
                   np.array(xi2).reshape(-1, d - 1), np.array(weight), np.array(gap), 0.0)


def _may_meet(surface1: Surface, f1: int, surface2: Surface, f2: int, reach: float) -> bool:
    x1, x2 = surface1.points[surface1.facets[f1]], surface2.points[surface2.facets[f2]]
    radius1 = np.linalg.norm(x1 - x1.mean(axis=0), axis=1).max()
    radius2 = np.linalg.norm(x2 - x2.mean(axis=0), axis=1).max()
    near = np.linalg.norm(x1.mean(axis=0) - x2.mean(axis=0)) < 1.1 * (radius1 + radius2) + reach
    return bool(near and _facet_normal(surface1, f1) @ _facet_normal(surface2, f2) < OPPOSED)


def _facet_normal(surface: Surface, f: int) -> Floats:
    vector = _area(surface, f, reference_cell(surface.shape, surface.order).centre)
    return vector / np.linalg.norm(vector)


def _area(surface: Surface, f: int, xi: Floats) -> Floats:
    """Area vector (d,) at one point."""
    tangents = tabulate(surface.shape, surface.order, xi[None])[1][0] @ surface.points[surface.facets[f]]
    return area_vector(list(tangents))


def _at(surface: Surface, f: int, xi: Floats, limit: float = np.inf) -> tuple[Floats, Floats]:
    """Point and unit normal (d,) at one point of the facet, continued linearly beyond `limit` times its size."""
    nodes = surface.facets[f]
    inner = _pulled_in(surface, xi, limit)
    values, slopes = tabulate(surface.shape, surface.order, inner[None])
    x = values[0] @ surface.points[nodes] + (xi - inner) @ (slopes[0] @ surface.points[nodes])
    n = values[0] @ surface.normals[nodes]
    return x, n / np.linalg.norm(n)


def _pulled_in(surface: Surface, xi: Floats, limit: float) -> Floats:
    """Reference point xi, or the point at the limit on the line from the centre to it."""
    cell = reference_cell(surface.shape, surface.order)
    size = 1.0
    for a, b in zip(cell.corners, np.roll(cell.corners, -1, axis=0), strict=True):
        inward = np.array([a[1] - b[1], b[0] - a[0]]) if len(a) == 2 else b - a
        size = max(size, float(inward @ (cell.centre - xi) / (inward @ (cell.centre - a))) / limit)
    return cell.centre + (xi - cell.centre) / size


def _root(function: Callable[[Floats], Floats], start: Floats) -> Floats:
    result = root(function, start, tol=1e-14)
    residual = function(result.x)
    if np.abs(residual).max() > 1e-9:
        raise RuntimeError(f"wanted the root of a projection, found a residual of {residual}: {result.message}")
    return result.x


def _project(surface: Surface, f: int, target: Floats) -> Floats:
    """Reference point xi with x(xi) + gap n(xi) = target."""

    def miss(y: Floats) -> Floats:
        x, n = _at(surface, f, y[:-1], EXTENSION)
        return x + y[-1] * n - target

    return _root(miss, np.append(reference_cell(surface.shape, surface.order).centre, 0.0))[:-1]


def _follow(surface: Surface, f: int, x1: Floats, n1: Floats) -> tuple[Floats, float]:
    """Reference point xi and gap with x(xi) = x1 + gap n1."""
    centre = reference_cell(surface.shape, surface.order).centre
    solution = _root(lambda y: _at(surface, f, y[:-1])[0] - x1 - y[-1] * n1, np.append(centre, 0.0))
    return solution[:-1], float(solution[-1])


def _pair(surface1: Surface, f1: int, surface2: Surface, f2: int, degree: int) -> list[_Row]:
    """Rows (facet1, xi1, facet2, xi2, weight, gap) of one pair of facets."""
    image = [_project(surface1, f1, _at(surface2, f2, xi)[0]) for xi in _outline(surface2, surface1.order)]
    rows = []
    for window in reference_cell(surface1.shape, surface1.order).subcells:
        for simplex in _common(image, window):
            rows += _rows(surface1, f1, surface2, f2, simplex, degree)
    return rows


def _outline(surface: Surface, other_order: int) -> list[Floats]:
    """Corners, and midpoints of the sides if either surface is curved, clockwise."""
    corners = reference_cell(surface.shape, surface.order).corners[::-1]
    if surface.shape == "interval":
        return list(corners)
    points = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        points += [a] if surface.order == other_order == 1 else [a, 0.5 * (a + b)]
    return points


def _common(image: list[Floats], window: Floats) -> list[Floats]:
    """Simplices (dt+1, dt) whose signed sum is the part of the image in the convex window."""
    if window.shape[1] == 1:
        low, high = max(image[0][0], window[0, 0]), min(image[1][0], window[1, 0])
        return [np.array([[low], [high]])] if high > low else []
    polygon = image
    for a, b in zip(window, np.roll(window, -1, axis=0), strict=True):
        polygon = _cut(polygon, a, b)
    return [np.array([polygon[0], polygon[i], polygon[i + 1]]) for i in range(1, len(polygon) - 1)]


def _cut(polygon: list[Floats], a: Floats, b: Floats) -> list[Floats]:
    """The part of a polygon to the left of the line from a to b."""

    def left(p: Floats) -> float:
        return float((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]))

    result = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        if left(p) >= 0.0:
            result.append(p)
        if (left(p) >= 0.0) != (left(q) >= 0.0):
            result.append(p + left(p) / (left(p) - left(q)) * (q - p))
    return result


def _rows(surface1: Surface, f1: int, surface2: Surface, f2: int, simplex: Floats, degree: int) -> list[_Row]:
    """Rows of one simplex (dt+1, dt)."""
    edges = simplex[1:] - simplex[0]
    size = float(np.linalg.det(edges))
    if abs(size) < 1e-15:
        return []
    x, w = quadrature("interval", max(degree, 5)) if len(edges) == 1 else quadrature("triangle", degree)
    rows = []
    for point, weight in zip(x, w, strict=True):
        xi1 = simplex[0] + point @ edges
        xi2, gap = _follow(surface2, f2, *_at(surface1, f1, xi1))
        rows.append((f1, xi1, f2, xi2, weight * size * float(np.linalg.norm(_area(surface1, f1, xi1))), gap))
    return rows
