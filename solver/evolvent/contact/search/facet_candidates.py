"""Step 1 of the pairing: facet pairs within reach whose normals oppose."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import chain

import numpy as np
from scipy.spatial import cKDTree

from evolvent.fem.reference_facets import area_vector, cross, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints

OPPOSED = -0.2
"""Product n1·n2 of the normals at the centres of two facets above which they cannot face each other."""
AT_ONCE = 2000
"""Facets of surface 1: their candidates are lists of Python, which take forty bytes each."""
SLIGHTLY_MORE = 1.0 + 1e-9  # of a radius: against rounding


def facet_candidates(surface1: Surface, surface2: Surface, facets1: Ints, max_gap: float,
                     max_overlap: float) -> tuple[Ints, Ints]:
    """Facet pairs that may face each other: indices of the facets of surface 1 and of surface 2, (p,) each.

    facets1: facets of surface 1 to pair. max_gap, max_overlap: largest distances [mm].
    """
    if not (len(facets1) and len(surface2.facets)):
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    balls2 = facet_balls(surface2, np.arange(len(surface2.facets)))
    tree, found = cKDTree(balls2[0]), []
    for chosen in np.array_split(facets1, math.ceil(len(facets1) / AT_ONCE)):
        centre1, radius1 = facet_balls(surface1, chosen)
        frame1 = _frames(surface1, chosen)
        beside = radius1 + max(max_gap, max_overlap) * _tilt(surface1.normals[surface1.facets[chosen]], frame1[:, 0])
        layers = _Layers(centre1, radius1, frame1[:, 0], beside, (max_gap, max_overlap))
        i1, i2 = layers.candidates(tree, *balls2)
        near, place = np.unique(i2, return_inverse=True)
        keep = np.einsum("pd,pd->p", frame1[i1, 0], _frames(surface2, near)[place, 0]) < OPPOSED
        i1, i2 = i1[keep], i2[keep]
        keep = _boxes_meet(surface1, surface2, chosen[i1], i2, frame1[i1], max_gap, max_overlap)
        found.append((chosen[i1[keep]], i2[keep]))
    first, second = (np.concatenate(each) for each in zip(*found))
    return first, second


@dataclass(frozen=True)
class _Layers:
    """Space in which the partners of some facets of surface 1 lie: within reach along their normals.

    centre, radius: of balls around the facets, (m, d), (m,) [mm].
    normal: (m, d) at their centres.
    beside: (m,) how far across the normal partners may lie [mm].
    reach: largest gap and largest overlap [mm].
    """

    centre: Floats
    radius: Floats
    normal: Floats
    beside: Floats
    reach: tuple[float, float]

    def candidates(self, tree: cKDTree, centre2: Floats, radius2: Floats) -> tuple[Ints, Ints]:
        """Pairs (p,), (p,) of these facets with those of surface 2 whose balls reach into the layers, sorted. tree: of
        the balls' centres.

        The tree is asked for balls of the size of a facet one after the other along the normal: one that holds a whole
        layer, which may be thirty times as high as a facet is wide, holds hundreds of facets beside it. In 2D they lie
        in a row, and one ball is quicker.
        """
        most = self.radius + radius2.max()
        low, height = -self.reach[1] - most, sum(self.reach) + 2.0 * most
        across = self.beside + radius2.max()
        count = 1 if self.centre.shape[1] == 2 else math.ceil(float((height / across).max()) / 2.0)
        step = height / count
        i1, i2 = self._in_slabs(tree, centre2, low, step, np.hypot(0.5 * step, across), count)
        keep = self._meet(i1, i2, centre2, radius2)
        order = np.lexsort((i2[keep], i1[keep]))
        return i1[keep][order], i2[keep][order]

    def _meet(self, i1: Ints, i2: Ints, centre2: Floats, radius2: Floats) -> Bools:
        """Whether the balls of pairs (p,) may have points within reach of each other."""
        distance, radii = centre2[i2] - self.centre[i1], self.radius[i1] + radius2[i2]
        return _balls_meet(distance, self.normal[i1], radii, self.beside[i1] + radius2[i2], self.reach)

    def _in_slabs(
        self, tree: cKDTree, centre2: Floats, low: Floats, step: Floats, radius: Floats, count: int
    ) -> tuple[Ints, Ints]:
        """Pairs, each once: in the slab whose distance along the normal is from low + number · step to one step more.

        One query asks for the balls of all slabs: most hold nothing, so that arrays of each slab take longer than it.
        """
        along = low + (np.arange(count)[:, None] + 0.5) * step
        middles = self.centre + along[..., None] * self.normal
        near = tree.query_ball_point(middles.reshape(-1, middles.shape[-1]), np.tile(SLIGHTLY_MORE * radius, count))
        held = np.fromiter(map(len, near), dtype=np.int64, count=len(near))
        number, i1 = np.divmod(np.repeat(np.arange(len(near)), held), len(low))
        i2 = np.fromiter(chain.from_iterable(near), dtype=np.int64, count=len(i1))
        distance = np.einsum("pd,pd->p", centre2[i2] - self.centre[i1], self.normal[i1])
        keep = np.floor((distance - low[i1]) / step[i1]) == number
        return i1[keep], i2[keep]


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


def _frames(surface: Surface, facets: Ints) -> Floats:
    """Orthonormal frame of facets (m,) at their centres, rows n, t1, (t2): (m, d, d)."""
    centre = reference_cell(surface.shape, surface.order).centre
    centres = np.broadcast_to(centre, (len(facets), 1, len(centre)))
    tangents = [t[:, 0] for t in surface.evaluate(surface.points, facets, centres)[1]]
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
