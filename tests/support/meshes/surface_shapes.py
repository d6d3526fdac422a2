"""Surfaces built directly from arrays, for the tests of surfaces and search; no gmsh."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from evolvent.fem.reference_facets import REVERSED_FACET, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats

Place = Callable[[Floats, Floats], Floats]


def lattice(nx: int, ny: int, shape: str, order: int, place: Place) -> Surface:
    """nx × ny quadrilaterals, or twice as many triangles, over [0, 1]² with nodes at place(u, v) -> (n, 3)."""
    rows = order * ny + 1
    u, v = np.meshgrid(np.linspace(0, 1, order * nx + 1), np.linspace(0, 1, rows), indexing="ij")
    local = np.rint(order * reference_cell(shape, order).nodes).astype(int)
    parts = [local] if shape == "quadrilateral" else [local, order - local]
    facets = [(order * i + p[:, 0]) * rows + order * j + p[:, 1] for i in range(nx) for j in range(ny) for p in parts]
    return Surface.from_arrays(place(u.ravel(), v.ravel()), np.array(facets), shape, order)


def curve(n: int, order: int, place: Callable[[Floats], Floats]) -> Surface:
    """n facets over [0, 1] with nodes at place(u) -> (n, 2); outwards is to the right of the way it is run."""
    local = np.rint(order * reference_cell("interval", order).nodes[:, 0]).astype(int)
    facets = [order * i + local for i in range(n)]
    return Surface.from_arrays(place(np.linspace(0, 1, order * n + 1)), np.array(facets), "interval", order)


def facing(surface: Surface) -> Surface:
    """The same surface seen from the other side."""
    turned = surface.facets[:, REVERSED_FACET[surface.shape, surface.order]]
    return Surface.from_arrays(surface.points, turned, surface.shape, surface.order)


def shaken(surface: Surface, rng: np.random.Generator) -> Surface:
    """The nodes inside a planar rectangle displaced in the plane, by up to 0.03 / order."""
    x = surface.points.copy()
    inside = np.all((x[:, :2] > x[:, :2].min(axis=0) + 1e-9) & (x[:, :2] < x[:, :2].max(axis=0) - 1e-9), axis=1)
    x[inside, :2] += rng.uniform(-0.03, 0.03, (inside.sum(), 2)) / surface.order
    return Surface.from_arrays(x, surface.facets, surface.shape, surface.order)


def rectangle(low: tuple[float, float], high: tuple[float, float], turn: float = 0.0, z: float = 0.0) -> Place:
    """(u, v) -> the plane z over the rectangle from low to high, turned about the z axis."""
    def place(u: Floats, v: Floats) -> Floats:
        x, y = low[0] + u * (high[0] - low[0]), low[1] + v * (high[1] - low[1])
        return np.stack([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y, 0 * x + z], axis=1)
    return place


def cap(radius: float, half: float, turn: float = 0.0, bend: float = 0.0) -> Place:
    """(u, v) -> a patch of a sphere about the origin, with edges that are also curved in the surface."""
    def place(u: Floats, v: Floats) -> Floats:
        x, y = half * (2 * u - 1), half * (2 * v - 1)
        x, y = x + bend * y * y, y - bend * x * x
        x, y = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
        return radius * np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=1)
    return place
