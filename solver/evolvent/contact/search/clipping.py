"""Clipping of many small polygons by convex windows, and their triangulation, all at once."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats, Ints

EMPTY = 1e-14  # reference measure below which a piece is dropped
ROUND_OFF = 1e-12  # difference of areas that count as equal


def clip(polygons: Floats, count: Ints, windows: Floats) -> tuple[Floats, Ints]:
    """Clips polygons by convex windows (Sutherland & Hodgman 1974).

    polygons: (p, v, c) vertices; columns 0, 1 are coordinates in the plane, the others are interpolated linearly.
    count: (p,) number of vertices in use.
    windows: (p, w, 2) counter-clockwise.
    Returns the clipped polygons (p, v', c) and their numbers of vertices (p,), 0 if nothing is left.
    """
    for side in range(windows.shape[1]):
        start, end = windows[:, side, None], windows[:, (side + 1) % windows.shape[1], None]
        along, rest = end - start, polygons[..., :2] - start
        distance = along[..., 0] * rest[..., 1] - along[..., 1] * rest[..., 0]
        polygons, count = cut(polygons, count, distance)
    return polygons, count


def cut(polygons: Floats, count: Ints, distance: Floats) -> tuple[Floats, Ints]:
    """Keep the part of the polygons (p, v, c) with distance (p, v) >= 0."""
    index = np.arange(polygons.shape[1])
    used = index < count[:, None]
    following = np.where(index + 1 < count[:, None], index + 1, 0)
    next_distance = np.take_along_axis(distance, following, axis=1)
    next_vertex = np.take_along_axis(polygons, following[..., None], axis=1)
    inside = used & (distance >= 0.0)
    crossing = used & ((distance >= 0.0) != (next_distance >= 0.0))
    share = distance / np.where(crossing, distance - next_distance, 1.0)
    hit = polygons + share[..., None] * (next_vertex - polygons)
    slots = (len(polygons), 2 * polygons.shape[1])
    keep = np.stack([inside, crossing], axis=2).reshape(slots)
    vertices = np.stack([polygons, hit], axis=2).reshape(*slots, polygons.shape[2])
    place = np.cumsum(keep, axis=1) - 1
    new_count = keep.sum(axis=1)
    result = np.zeros((len(polygons), int(new_count.max(initial=0)), polygons.shape[2]))
    row, column = np.nonzero(keep)
    result[row, place[row, column]] = vertices[row, column]
    return result, new_count


def fan(polygons: Floats, count: Ints) -> tuple[Ints, Floats]:
    """Triangulates polygons (p, v, c) with count (p,) vertices: index of the polygon (t,) and corners (t, 3, c).

    The triangles of a polygon share one vertex, the apex. It is chosen for the least overlap of triangles (none if the
    polygon is convex), then for the fewest triangles, then for its position, lowest and leftmost first. The signed
    areas always sum to that of the polygon.
    """
    keep = count >= 3
    owner, polygons, count = np.flatnonzero(keep), polygons[keep], count[keep]
    index = np.arange(polygons.shape[1])
    order = (index[:, None] + index) % np.maximum(count, 1)[:, None, None]  # (p, apex, position)
    edge = (index > 0) & (index + 1 < count[:, None])
    apex = index[None, :] < count[:, None]
    x, y = (np.take_along_axis(polygons[:, None, :, i], order, axis=2) for i in (0, 1))
    dx, dy = x - x[..., :1], y - y[..., :1]
    area = dx * np.roll(dy, -1, axis=2) - dy * np.roll(dx, -1, axis=2)
    area = np.where(edge[:, None], area, 0.0)
    spent = np.where(apex, np.abs(area).sum(axis=2), np.inf)
    least = spent <= spent.min(axis=1, initial=np.inf)[:, None] + ROUND_OFF
    filled = np.where(least, (np.abs(area) > ROUND_OFF).sum(axis=2), len(index))
    # among equals the position decides, since the order of the corners depends on round-off
    place = np.round(polygons[..., 0] + np.pi * polygons[..., 1], 9)
    rank = np.where(filled == filled.min(axis=1, initial=len(index))[:, None], place, np.inf)
    best = np.argmin(rank, axis=1) if len(polygons) else np.empty(0, dtype=np.int64)
    row = np.arange(len(polygons))
    turned = np.take_along_axis(polygons, order[row, best][..., None], axis=1)
    which, position = np.nonzero(np.abs(area[row, best]) > EMPTY)
    corners = [turned[which, np.zeros_like(position)], turned[which, position], turned[which, position + 1]]
    return owner[which], np.stack(corners, axis=1)
