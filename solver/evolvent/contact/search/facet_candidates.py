"""Step 1 of the pairing: facet pairs within reach whose normals oppose."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from evolvent.fem.reference_facets import area_vector, cross, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints

OPPOSED = -0.2
"""n1·n2 at the centres of two facets above which they cannot face each other."""


def facet_candidates(surface1: Surface, surface2: Surface, facets1: Ints, max_gap: float,
                     max_overlap: float) -> tuple[Ints, Ints]:
    """Facet pairs that may face each other: indices of the facets of surface 1 and of surface 2, (p,) each.

    facets1: facets of surface 1 to pair. max_gap, max_overlap: largest distances [mm].
    """
    centre1, radius1 = facet_balls(surface1, facets1)
    centre2, radius2 = facet_balls(surface2, np.arange(len(surface2.facets)))
    if len(centre1) == 0 or len(centre2) == 0:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    reach = max(max_gap, max_overlap)
    near = cKDTree(centre2).query_ball_point(centre1, radius1 + radius2.max() + reach, return_sorted=True)
    i1 = np.repeat(np.arange(len(facets1)), [len(n) for n in near])
    i2 = np.concatenate([np.asarray(n, dtype=np.int64) for n in near])
    keep = np.linalg.norm(centre1[i1] - centre2[i2], axis=1) <= radius1[i1] + radius2[i2] + reach
    i1, i2 = i1[keep], i2[keep]
    frame1, frame2 = _frames(surface1)[facets1], _frames(surface2)
    keep = np.einsum("pd,pd->p", frame1[i1, 0], frame2[i2, 0]) < OPPOSED
    i1, i2 = i1[keep], i2[keep]
    beside = radius1 + reach * _tilt(surface1.normals[surface1.facets[facets1]], frame1[:, 0])
    distance, along = centre2[i2] - centre1[i1], frame1[i1, 0]
    keep = _balls_meet(distance, along, radius1[i1] + radius2[i2], beside[i1] + radius2[i2], (max_gap, max_overlap))
    i1, i2 = i1[keep], i2[keep]
    keep = _boxes_meet(surface1, surface2, facets1[i1], i2, frame1[i1], max_gap, max_overlap)
    return facets1[i1[keep]], i2[keep]


def _tilt(normals: Floats, centre: Floats) -> Floats:
    """Largest sine (m,) of the angles between normals (m, k, d) at a facet's nodes and that at its centre (m, d)."""
    across = normals - np.einsum("mkd,md->mk", normals, centre)[..., None] * centre[:, None]
    return np.linalg.norm(across, axis=2).max(axis=1, initial=0.0)


def _balls_meet(
    distance: Floats, normal: Floats, radii: Floats, beside: Floats, reach: tuple[float, float]
) -> Bools:
    """Whether two balls may have points within a gap and an overlap, `reach`, of each other.

    distance: (p, d) between their centres. normal: (p, d) along which the reach is. radii: (p,) both together. beside:
    (p,) how far across the normal points may lie.
    """
    along = np.einsum("pd,pd->p", distance, normal)
    across = np.sqrt(np.maximum(np.einsum("pd,pd->p", distance, distance) - along**2, 0.0))
    return np.asarray((across <= beside) & (along <= radii + reach[0]) & (along >= -radii - reach[1]))


def facet_balls(surface: Surface, facets: Ints) -> tuple[Floats, Floats]:
    """Centre (m, d) and radius (m,) of a ball around each facet [mm]."""
    x = surface.points[surface.facets[facets]]
    centre = x.mean(axis=1)
    return centre, 1.1 * np.linalg.norm(x - centre[:, None], axis=2).max(axis=1, initial=0.0)


def _frames(surface: Surface) -> Floats:
    """Orthonormal frame of each facet at its centre, rows n, t1, (t2): (m, d, d)."""
    every = np.arange(len(surface.facets))
    centre = reference_cell(surface.shape, surface.order).centre
    centres = np.broadcast_to(centre, (len(every), 1, len(centre)))
    tangents = [t[:, 0] for t in surface.evaluate(surface.points, every, centres)[1]]
    normal, first = area_vector(tangents), tangents[0]
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    first = first / np.linalg.norm(first, axis=1, keepdims=True)
    rows = [normal, first] if len(tangents) == 1 else [normal, first, cross(normal, first)]
    return np.stack(rows, axis=1)


def _boxes_meet(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints, frame: Floats, max_gap: float,
                max_overlap: float) -> Bools:
    """Whether facet 2 meets the layer within reach of facet 1 along its normals, both as boxes in the frame of facet 1,
    (p,)."""
    nodes1 = surface1.facets[i1]
    x1, n1 = surface1.points[nodes1], surface1.normals[nodes1]
    turn = np.swapaxes(frame, 1, 2)
    low1, high1 = _box(np.concatenate([x1 - max_overlap * n1, x1 + max_gap * n1], axis=1) @ turn)
    low2, high2 = _box(surface2.points[surface2.facets[i2]] @ turn)
    return np.all((low1 <= high2) & (low2 <= high1), axis=1)


def _box(x: Floats) -> tuple[Floats, Floats]:
    """Bounds (p, d) of the points (p, k, d), slightly enlarged because curved facets extend beyond their nodes."""
    low, high = x[:, 0], x[:, 0]
    for k in range(1, x.shape[1]):
        low, high = np.minimum(low, x[:, k]), np.maximum(high, x[:, k])
    margin = 0.06 * (high - low) + 0.01 * (high - low).max(axis=1, keepdims=True)
    return low - margin, high + margin
