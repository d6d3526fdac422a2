"""Newton's method on curved facets, for many points at once: projection of points, and intersection with rays."""

from __future__ import annotations

import numpy as np

from evolvent.fem.reference_facets import cross, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints

EXTENSION = 1.1  # of a facet's size: for projection it is continued linearly beyond, as polynomials soon fold
RANGE = 2.0  # of a facet's size: rays are intersected with its polynomial up to there
TOLERANCE = 1e-12  # of Newton steps (reference units)
SMALL_STEP = 1e-7  # a Newton step below this, squared by the next one, is below TOLERANCE
MAX_ITERATIONS = 100  # far outside a warped facet convergence is linear only


def _continued(surface: Surface, field: Floats, facets: Ints, xi: Floats,
               limit: float) -> tuple[Floats, list[Floats]]:
    """Values and derivatives of a field (n, d or 2d), whose first d columns are the points, at xi that may lie far
    outside the facets.

    Beyond `limit` times the facet the points are continued linearly and the other columns constantly, so that a far
    point has one image.
    """
    cell = reference_cell(surface.shape, surface.order)
    far = gauge(cell.corners, xi)
    outside = far > limit
    inner = xi.copy()
    inner[outside] = cell.centre + (xi[outside] - cell.centre) * (limit / far[outside])[:, None]
    value, slopes = surface.evaluate(field, facets, inner)
    if outside.any():
        d = surface.points.shape[1]
        for i, slope in enumerate(slopes):
            slope[outside, d:] = 0.0
            value[outside] += slope[outside] * (xi - inner)[outside, i, None]
    return value, slopes


def gauge(corners: Floats, xi: Floats) -> Floats:
    """Relative distance of xi (..., dt) from the centre of the cell: linear along rays, 1 on the boundary."""
    centred = xi - corners.mean(axis=0)
    if len(corners) == 3:
        x, y = centred[..., 0], centred[..., 1]
        return 3.0 * np.maximum(np.maximum(-x, -y), x + y)
    return 2.0 * largest(centred)


def largest(v: Floats) -> Floats:
    """Largest absolute entry along a short last axis, on which NumPy's own reduction is slow."""
    size = np.abs(v[..., 0])
    for i in range(1, v.shape[-1]):
        size = np.maximum(size, np.abs(v[..., i]))
    return size


def dot(a: Floats, b: Floats) -> Floats:
    """Dot product a·b along a short last axis, on which NumPy's own reduction is slow."""
    total = a[..., 0] * b[..., 0]
    for i in range(1, a.shape[-1]):
        total = total + a[..., i] * b[..., i]
    return total


def _solve(columns: list[Floats], right: Floats) -> Floats:
    """Solve [columns] y = right, all (..., d) with d = 2 or 3, by Cramer's rule: (..., d), not finite if singular."""
    if len(columns) == 2:
        a, b = columns
        det = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
        first = right[..., 0] * b[..., 1] - right[..., 1] * b[..., 0]
        second = a[..., 0] * right[..., 1] - a[..., 1] * right[..., 0]
        return _over(np.stack([first, second], axis=-1), det)
    a, b, c = columns
    bc = cross(b, c)
    parts = [dot(right, v) for v in (bc, cross(c, a), cross(a, b))]
    return _over(np.stack(parts, axis=-1), dot(a, bc))


def _over(v: Floats, divisor: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(v / divisor[..., None])


def project(surface: Surface, facets: Ints, targets: Floats) -> tuple[Floats, Floats, Bools]:
    """Projection of targets (t, p, d) along the normals of facets (t,), continued linearly: (xi, gap, converged) with
    x(xi) + gap n(xi) = target.

    The result depends on facet and target alone, not on the rest of the batch: neighbours agree on common points.
    """
    cell, d = reference_cell(surface.shape, surface.order), targets.shape[-1]
    xi = np.broadcast_to(cell.centre, (*targets.shape[:2], d - 1)).copy()
    gap = np.zeros(targets.shape[:2])
    field = np.concatenate([surface.points, surface.normals], axis=1)
    active = np.ones(gap.shape, dtype=bool)
    for _ in range(MAX_ITERATIONS):
        rows = np.flatnonzero(active.any(axis=1))
        value, slopes = _continued(surface, field, facets[rows], xi[rows], EXTENSION)
        length = np.sqrt(dot(value[..., d:], value[..., d:]))[..., None]
        n = value[..., d:] / length
        height = gap[rows, :, None]
        columns = [s[..., :d] + height * _tangential(s[..., d:], n) / length for s in slopes] + [n]
        step = _solve(columns, targets[rows] - value[..., :d] - height * n)
        size = largest(step)
        limit = 4.0 / np.maximum(largest(step[..., :-1]), 4.0)
        usable = active[rows] & np.isfinite(size)
        step = np.where(usable[..., None], step * limit[..., None], 0.0)
        xi[rows] += step[..., :-1]
        gap[rows] += step[..., -1]
        near = gauge(cell.corners, xi[rows]) < EXTENSION
        settled = largest(step[..., :-1]) <= np.where(near, SMALL_STEP, TOLERANCE)
        active[rows] &= ~(settled & np.isfinite(size))
        if not active.any():
            break
    return xi, gap, ~active | (gauge(cell.corners, xi) >= EXTENSION)


def _tangential(v: Floats, n: Floats) -> Floats:
    return v - dot(v, n)[..., None] * n


def locate(surface: Surface, facets: Ints, start: Floats, direction: Floats,
            guess: Floats) -> tuple[Floats, Floats, Bools]:
    """Intersection of rays with facets (t,): (xi, gap, converged) with x(xi) = start + gap direction.

    start, direction: (t, p, d) of the rays. guess: (t, p, d−1) of xi. Intersections lie on the facet's polynomial up to
    RANGE times its size.
    """
    xi, gap = guess.copy(), np.zeros(guess.shape[:2])
    active = np.ones(gap.shape, dtype=bool)
    for _ in range(MAX_ITERATIONS):
        rows = np.flatnonzero(active.any(axis=1))
        value, slopes = _continued(surface, surface.points, facets[rows], xi[rows], RANGE)
        step = _solve([*slopes, -direction[rows]], start[rows] - value)  # the last entry is the gap itself
        size = largest(step[..., :-1])
        xi[rows] += step[..., :-1] * np.minimum(1.0, 1.0 / np.maximum(size, 1e-300))[..., None]
        gap[rows] = step[..., -1]
        active[rows] = size > SMALL_STEP
        if not active.any():
            break
    corners = reference_cell(surface.shape, surface.order).corners
    return xi, gap, ~active & (gauge(corners, xi) <= RANGE)
