"""The smallest sphere that holds given points.

It is determined by a few points on it, at most one more than the dimension of what they span. Starting from two, the
point that lies furthest outside is taken in, and the sphere of these few found among the circumspheres of all their
subsets (the exchange of bases of Sharir and Welzl, STACS 1992, LNCS 577, 567-579). Its radius grows each time, so that
no subset comes twice.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from evolvent_meshes.arrays import Floats

ROUNDING = 1e-10
"""Tolerance over the size of the set: points so little outside lie on the sphere, and thinner sets are flat."""


def centre(points: Floats) -> Floats:
    """Centre (d,) of the smallest sphere that holds points (n, d)."""
    middle = points.mean(axis=0)
    size, axes = np.linalg.svd(points - middle, full_matrices=False)[1:]
    axes = axes[size > ROUNDING * max(size[0], 1e-300)]
    if len(axes) == 0:
        return np.asarray(middle)
    return np.asarray(middle + _centre((points - middle) @ axes.T) @ axes)


def _centre(points: Floats) -> Floats:
    """Centre (d,) of the smallest sphere that holds points (n, d) which span their space."""
    tolerance = ROUNDING * float(np.abs(points).max())
    held = points[:1]
    at, radius = held[0], 0.0
    while True:
        distance = np.linalg.norm(points - at, axis=1)
        far = int(np.argmax(distance))
        if distance[far] <= radius + tolerance:
            return np.asarray(at)
        at, radius, held = _of_few(held, points[far], tolerance)


def _of_few(held: Floats, further: Floats, tolerance: float) -> tuple[Floats, float, Floats]:
    """Centre and radius of the smallest sphere that holds a few points and one outside their sphere, and the points
    that determine it: the further one is among them."""
    every = np.vstack([held, further])
    spheres = []
    for chosen in _subsets(held):
        subset = np.vstack([chosen, further])
        at = _circumcentre(subset)
        radius = float(np.linalg.norm(further - at))
        if np.linalg.norm(every - at, axis=1).max() <= radius + tolerance:
            spheres.append((radius, at, subset))
    radius, at, subset = min(spheres, key=lambda sphere: sphere[0])
    return at, radius, subset


def _subsets(held: Floats) -> Iterator[Floats]:
    """Subsets of points, of at least one, and at most as many as the dimension."""
    for count in range(1, min(held.shape) + 1):
        for chosen in combinations(range(len(held)), count):
            yield held[list(chosen)]


def _circumcentre(points: Floats) -> Floats:
    """Centre (d,) of the smallest sphere on which points (k, d) lie; where they do not lie on one, of the least
    squares."""
    edges = points[1:] - points[0]
    shares = np.linalg.lstsq(2.0 * edges @ edges.T, np.einsum("ij,ij->i", edges, edges), rcond=None)[0]
    return np.asarray(points[0] + shares @ edges)
