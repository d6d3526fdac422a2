"""Steps 2 and 3 of the pairing: the overlap of facet pairs, cut into simplices in the reference plane of facet 1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.search.clipping import EMPTY, clip, fan
from evolvent.contact.search.facet_candidates import facet_balls
from evolvent.contact.search.projection import dot, project
from evolvent.fem.reference_facets import cross, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints

STRAIGHT = 5e-3
"""Bend of edges, over their length, up to which they count as straight. Points between an edge and its chord get their
partners on the polynomial of the neighbouring facet, which is continuous with its own."""


@dataclass(frozen=True)
class Segments:
    """Simplices of the overlap of facet pairs, with dt = d − 1 reference coordinates.

    facet1: (t,) facets of surface 1.
    facet2: (t,) facets of surface 2.
    corners1: (t, dt+1, dt) in the reference plane of facet 1.
    corners2: (t, dt+1, dt) approximately in the reference plane of facet 2, as a guess of the partners.
    trusted: (t,) whether the outline of facet 2 could be projected near facet 1.
    """

    facet1: Ints
    facet2: Ints
    corners1: Floats
    corners2: Floats
    trusted: Bools


def segments_2d(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints) -> Segments:
    """Intervals common to the image of facet 2 and the sub-facets of facet 1; i1, i2: (p,) the facet pairs."""
    ends = np.broadcast_to(np.array([[1.0], [0.0]]), (len(i1), 2, 1))  # facet 2 runs the other way
    image, _, projected = project(surface1, i1, surface2.positions(i2, ends))
    image = image[..., 0]
    cells = reference_cell(surface1.shape, surface1.order).subcells[..., 0]
    low = np.maximum(image[:, None, 0], cells[:, 0])
    high = np.minimum(image[:, None, 1], cells[:, 1])
    pair, _ = np.nonzero(high - low > EMPTY)
    both = np.stack([low, high], axis=-1)[high - low > EMPTY]
    first, last = image[pair, :1], image[pair, 1:]
    return Segments(i1[pair], i2[pair], both[..., None], ((last - both) / (last - first))[..., None],
                    projected.all(axis=1)[pair])


def segments_3d(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints, max_gap: float,
                max_overlap: float) -> Segments:
    """Triangles that fill the image of facet 2 inside each sub-facet of facet 1; i1, i2: (p,) the facet pairs."""
    outline = _outline(surface2, _pieces(surface1, surface2, i1, i2))
    around = np.broadcast_to(outline, (len(i1), *outline.shape))
    image, gap, projected = project(surface1, i1, surface2.positions(i2, around))
    margin = 0.25 * facet_balls(surface2, i2)[1]  # facet 2 may bulge towards facet 1 between its nodes
    inside = (gap.min(axis=1) - margin <= max_gap) & (gap.max(axis=1) + margin >= -max_overlap)
    cells = reference_cell(surface1.shape, surface1.order).subcells
    low, high = image.min(axis=1)[:, None], image.max(axis=1)[:, None]
    meets = np.all((low < cells.max(axis=1)) & (cells.min(axis=1) < high), axis=2) & inside[:, None]
    pair, which = np.nonzero(meets)
    polygons = np.concatenate([image[pair], around[pair]], axis=2)
    polygons, count = clip(polygons, np.full(len(pair), len(outline)), cells[which])
    owner, triangles = fan(polygons, count)
    pair = pair[owner]
    return Segments(i1[pair], i2[pair], triangles[..., :2], triangles[..., 2:], projected.all(axis=1)[pair])


def _pieces(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints) -> int:
    """Number of chords that replace an edge of facet 2: one if all edges are nearly straight, two if either side is
    curved, more if facet 1 is much smaller."""
    order = max(surface1.order, surface2.order)
    if len(i1) == 0:
        return order
    bends = max(_bend(surface1, np.unique(i1)), _bend(surface2, np.unique(i2)))
    ratio = float((facet_balls(surface2, i2)[1] / facet_balls(surface1, i1)[1]).max())
    return (order if bends > STRAIGHT else 1) * min(max(1, int(np.ceil(0.5 * ratio))), 8)


def _bend(surface: Surface, facets: Ints) -> float:
    """Largest distance of the middle of an edge from its chord, in the plane of the facet there, over the chord."""
    if surface.order == 1:
        return 0.0
    corners = reference_cell(surface.shape, surface.order).corners
    following = np.roll(corners, -1, axis=0)
    a, b, middles = (
        np.broadcast_to(xi, (len(facets), *xi.shape)) for xi in (corners, following, 0.5 * (corners + following))
    )
    start, end, middle = (surface.positions(facets, xi) for xi in (a, b, middles))
    chord = end - start
    across = cross(chord, surface.area_vectors(facets, middles))
    off = np.abs(dot(middle - 0.5 * (start + end), across))
    return float((off / np.sqrt(dot(across, across) * dot(chord, chord))).max())


def _outline(surface: Surface, pieces: int) -> Floats:
    """Points around the reference cell, clockwise (counter-clockwise as seen from the facing side): (v, 2)."""
    corners = reference_cell(surface.shape, surface.order).corners[::-1]
    sides = (np.roll(corners, -1, axis=0) - corners)[:, None]
    return (corners[:, None] + np.arange(pieces)[:, None] / pieces * sides).reshape(-1, 2)
