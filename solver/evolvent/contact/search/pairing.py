"""Where two surfaces face each other: quadrature points of a contact integral over surface 1, with their partners.

The integral runs over segments, the pieces into which the facets of surface 2, seen along the normals of surface 1,
cut the sub-facets of surface 1: on each of them all hat and shape functions of both sides are smooth, so that
non-matching meshes pass the patch test (Puso & Laursen 2004, doi 10.1016/j.cma.2003.10.010, with curved facets).

Steps, each over all facet pairs at once:
1. candidates: facet pairs within reach whose normals oppose (k-d tree, then boxes in the frame of facet 1);
2. the outline of facet 2 is projected into the reference plane of facet 1 along the interpolated nodal normal;
3. it is clipped against each sub-facet of facet 1 and cut into triangles (in 2D: an interval);
4. each quadrature point is followed along the normal to facet 2.

Nothing is covered twice or missed: in step 2 a point has one image in facet 1, whichever facet 2 asks for it, and the
sides of the outline are straight in that plane for both facets 2 that share them. An edge of facet 2 that is curved
in the plane is therefore replaced by chords, and points between chord and edge lie a little outside their facet 2;
they keep its polynomial continued (x2 = x1 + gap n1 holds exactly).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from evolvent.contact.search.clipping import EMPTY, clip, fan
from evolvent.contact.search.projection import dot, locate, project
from evolvent.fem.lagrange import quadrature
from evolvent.fem.reference_facets import area_vector, cross, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.errors import InputError, ResultError

OPPOSED = -0.2  # facets meet only if n1·n2 at their centres is below this
ALLOWED_LOSS = 1e-3  # share of the covered area whose partner may fail to be found
DOUBLE = 1e-6  # share of a facet that may seem covered twice


class SearchError(ResultError):
    """The partner of more than a thousandth of the covered area was not found, or an area has two partners."""


@dataclass(frozen=True)
class Pairing:
    """Quadrature points of a contact integral over surface 1 facing surface 2, sorted by facet of surface 1.

    facet1, facet2: (q,) facet indices. xi1, xi2: (q, d-1) reference points; xi2 may lie a little outside facet 2.
    weight: (q,) [mm or mm²] quadrature weight, surface measure on 1 included (a few may be slightly negative, where
        the outline of a facet 2 with curved edges is not convex).
    gap: (q,) [mm] signed distance along the normalised interpolated nodal normal n1: x2(xi2) = x1(xi1) + gap n1.
    lost: [mm or mm²] area without points because no partner was found (at most 1e-3 of the covered area).
    """

    facet1: Ints
    xi1: Floats
    facet2: Ints
    xi2: Floats
    weight: Floats
    gap: Floats
    lost: float


@dataclass(frozen=True)
class Segments:
    """Simplices of the overlap in the reference plane of facet 1, with a guess of the partner.

    facet1, facet2: (t,). corners1, corners2: (t, dt+1, dt) in the reference planes of facet 1 and, nearly, facet 2.
    trusted: (t,) whether the outline of facet 2 could be projected near facet 1.
    """

    facet1: Ints
    facet2: Ints
    corners1: Floats
    corners2: Floats
    trusted: Bools


def pair_surfaces(surface1: Surface, surface2: Surface, max_gap: float, max_overlap: float,
                  facets1: ArrayLike | None = None, degree: int = 4) -> Pairing:
    """Pair the points of surface 1 with surface 2 in their present places.

    max_gap, max_overlap: points are kept whose gap lies in [-max_overlap, max_gap], both >= 0 [mm].
    facets1: indices of the facets of surface 1 to look at (default all).
    degree: polynomial degree of the rule on each segment (3D: 4 has 6 points a triangle; 2D: at least 5, 3 points).
    Parts of surface 1 without a partner have no points.
    Raises SearchError (see there), InputError if the two surfaces or the limits do not fit.
    """
    _check(surface1, surface2, max_gap, max_overlap)
    chosen = np.arange(len(surface1.facets)) if facets1 is None else np.unique(np.asarray(facets1, dtype=np.int64))
    pairs = candidates(surface1, surface2, chosen, max_gap, max_overlap)
    if surface1.shape == "interval":
        segments = _segments_2d(surface1, surface2, *pairs)
    else:
        segments = _segments_3d(surface1, surface2, *pairs, max_gap, max_overlap)
    return _points(surface1, surface2, segments, max_gap, max_overlap, degree)


def _check(surface1: Surface, surface2: Surface, max_gap: float, max_overlap: float) -> None:
    if surface1.points.shape[1] != surface2.points.shape[1]:
        raise InputError(f"contact: wanted both surfaces in 2D or both in 3D, found {surface1.points.shape[1]}D facing "
                         f"{surface2.points.shape[1]}D; mesh both alike")
    if not (max_gap >= 0.0 and max_overlap >= 0.0):
        raise InputError(f"contact: wanted a reach >= 0 mm, found {max_gap} for gaps and {max_overlap} for overlaps; "
                         "give it in mm")


# Step 1: candidates ---------------------------------------------------------------------------------------------------


def candidates(surface1: Surface, surface2: Surface, facets1: Ints, max_gap: float,
               max_overlap: float) -> tuple[Ints, Ints]:
    """Facet pairs that may face each other: indices into the facets of surface 1 and of surface 2, (p,) each."""
    centre1, radius1 = _balls(surface1, facets1)
    centre2, radius2 = _balls(surface2, np.arange(len(surface2.facets)))
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
    keep = _boxes_meet(surface1, surface2, facets1[i1], i2, frame1[i1], max_gap, max_overlap)
    return facets1[i1[keep]], i2[keep]


def _balls(surface: Surface, facets: Ints) -> tuple[Floats, Floats]:
    """Centre (m, d) and radius (m,) of a ball around each facet."""
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
    """Whether facet 2 meets the layer over facet 1 that the normals sweep, both as boxes in the frame of facet 1."""
    nodes1 = surface1.facets[i1]
    x1, n1 = surface1.points[nodes1], surface1.normals[nodes1]
    turn = np.swapaxes(frame, 1, 2)
    low1, high1 = _box(np.concatenate([x1 - max_overlap * n1, x1 + max_gap * n1], axis=1) @ turn)
    low2, high2 = _box(surface2.points[surface2.facets[i2]] @ turn)
    return np.all((low1 <= high2) & (low2 <= high1), axis=1)


def _box(x: Floats) -> tuple[Floats, Floats]:
    """Bounds (p, d) of the points (p, k, d), a little wider as curved facets reach beyond their nodes."""
    low, high = x[:, 0], x[:, 0]
    for k in range(1, x.shape[1]):
        low, high = np.minimum(low, x[:, k]), np.maximum(high, x[:, k])
    margin = 0.06 * (high - low) + 0.01 * (high - low).max(axis=1, keepdims=True)
    return low - margin, high + margin


# Steps 2 and 3: segments ----------------------------------------------------------------------------------------------


def _segments_2d(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints) -> Segments:
    """Intervals common to facet 2's image and the sub-facets of facet 1."""
    ends = np.broadcast_to(np.array([[1.0], [0.0]]), (len(i1), 2, 1))  # facet 2 runs the other way
    image, _, found = project(surface1, i1, surface2.positions(i2, ends))
    image = image[..., 0]
    cells = reference_cell(surface1.shape, surface1.order).subcells[..., 0]
    low = np.maximum(image[:, None, 0], cells[:, 0])
    high = np.minimum(image[:, None, 1], cells[:, 1])
    pair, _ = np.nonzero(high - low > EMPTY)
    both = np.stack([low, high], axis=-1)[high - low > EMPTY]
    first, last = image[pair, :1], image[pair, 1:]
    return Segments(i1[pair], i2[pair], both[..., None], ((last - both) / (last - first))[..., None],
                    found.all(axis=1)[pair])


def _segments_3d(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints, max_gap: float,
                 max_overlap: float) -> Segments:
    """Triangles that fill the image of facet 2 inside each sub-facet of facet 1."""
    outline = _outline(surface2, _pieces(surface1, surface2, i1, i2))
    around = np.broadcast_to(outline, (len(i1), *outline.shape))
    image, gap, found = project(surface1, i1, surface2.positions(i2, around))
    margin = 0.25 * _balls(surface2, i2)[1]  # facet 2 may bulge towards facet 1 between its nodes
    inside = (gap.min(axis=1) - margin <= max_gap) & (gap.max(axis=1) + margin >= -max_overlap)
    cells = reference_cell(surface1.shape, surface1.order).subcells
    low, high = image.min(axis=1)[:, None], image.max(axis=1)[:, None]
    meets = np.all((low < cells.max(axis=1)) & (cells.min(axis=1) < high), axis=2) & inside[:, None]
    pair, which = np.nonzero(meets)
    polygons = np.concatenate([image[pair], around[pair]], axis=2)
    polygons, count = clip(polygons, np.full(len(pair), len(outline)), cells[which])
    owner, triangles = fan(polygons, count)
    pair = pair[owner]
    return Segments(i1[pair], i2[pair], triangles[..., :2], triangles[..., 2:], found.all(axis=1)[pair])


def _pieces(surface1: Surface, surface2: Surface, i1: Ints, i2: Ints) -> int:
    """Chords an edge of facet 2 is replaced by: two if either side is curved, more if facet 1 is much smaller."""
    order = max(surface1.order, surface2.order)
    if len(i1) == 0:
        return order
    ratio = float((_balls(surface2, i2)[1] / _balls(surface1, i1)[1]).max())
    return order * min(max(1, int(np.ceil(0.5 * ratio))), 8)


def _outline(surface: Surface, pieces: int) -> Floats:
    """Points around the reference cell, clockwise (counter-clockwise as seen from the facing side): (v, 2)."""
    corners = reference_cell(surface.shape, surface.order).corners[::-1]
    sides = (np.roll(corners, -1, axis=0) - corners)[:, None]
    return (corners[:, None] + np.arange(pieces)[:, None] / pieces * sides).reshape(-1, 2)


# Step 4: quadrature points --------------------------------------------------------------------------------------------


def _points(surface1: Surface, surface2: Surface, segments: Segments, max_gap: float, max_overlap: float,
            degree: int) -> Pairing:
    rule, rule_weight = _rule(surface1.shape, degree)
    xi1, guess = rule @ segments.corners1, rule @ segments.corners2
    size = np.linalg.det(segments.corners1[:, 1:] - segments.corners1[:, :1])[:, None] * rule_weight
    start, normal, measure = _points_normals(surface1, segments.facet1, xi1)
    xi2, gap, found = locate(surface2, segments.facet2, start, normal, guess)
    found &= segments.trusted[:, None]
    keep = found & (gap >= -max_overlap) & (gap <= max_gap)
    row = np.nonzero(keep)[0]
    _refuse_double(surface1, segments.facet1[row], size[keep])
    lost = _refuse_lost(surface1, segments, size, found)
    return Pairing(segments.facet1[row], xi1[keep], segments.facet2[row], xi2[keep], (size * measure)[keep], gap[keep],
                   lost)


def _rule(shape: str, degree: int) -> tuple[Floats, Floats]:
    """Barycentric points (p, dt+1) and weights (p,) of the rule on a segment."""
    x, weight = quadrature("interval", max(degree, 5)) if shape == "interval" else quadrature("triangle", degree)
    return np.concatenate([1.0 - x.sum(axis=1, keepdims=True), x], axis=1), weight


def _points_normals(surface: Surface, facets: Ints, xi: Floats) -> tuple[Floats, Floats, Floats]:
    """Points and normalised interpolated normals (t, p, d), surface measure per reference measure (t, p)."""
    d = surface.points.shape[1]
    value, slopes = surface.evaluate(np.concatenate([surface.points, surface.normals], axis=1), facets, xi)
    normal, area = value[..., d:], area_vector([s[..., :d] for s in slopes])
    return value[..., :d], normal / np.sqrt(dot(normal, normal))[..., None], np.sqrt(dot(area, area))


def _coverage(surface: Surface, facets: Ints, size: Floats) -> Floats:
    """Share (m,) of each facet that the points with reference weights `size` cover."""
    measure = reference_cell(surface.shape, surface.order).measure
    return np.bincount(facets, size, minlength=len(surface.facets)) / measure


def _refuse_double(surface: Surface, facets: Ints, size: Floats) -> None:
    """No facet of surface 1 may be covered more than once."""
    covered = _coverage(surface, facets, size)
    if np.any(covered > 1.0 + DOUBLE):
        worst = int(np.argmax(covered))
        raise SearchError(f"contact: wanted one partner for each place of the first surface, found "
                          f"{int(np.sum(covered > 1.0 + DOUBLE))} facets that have two partners (facet {worst} is "
                          f"covered {covered[worst]:.6f} times): the second surface lies in reach twice; make the "
                          "contact's reach smaller, or split the second surface")


def _refuse_lost(surface: Surface, segments: Segments, size: Floats, found: Bools) -> float:
    """The area that has a segment but no partner; SearchError if it is more than ALLOWED_LOSS of all that has one.

    What another segment covers is not lost: the far outline of a wrong candidate may stray over a covered facet.
    """
    row = np.nonzero(~found)[0]
    if len(row) == 0:
        return 0.0
    covered = _coverage(surface, segments.facet1[np.nonzero(found)[0]], size[found])
    missing = _coverage(surface, segments.facet1[row], np.abs(size[row, np.nonzero(~found)[1]]))
    missing = np.minimum(missing, np.maximum(0.0, 1.0 - covered))
    lost, total = float(missing @ surface.areas()), float((missing + covered) @ surface.areas())
    if lost > ALLOWED_LOSS * total:
        worst = row[np.argmax(missing[segments.facet1[row]])]
        raise SearchError(f"contact: wanted partners for all but {ALLOWED_LOSS} of the first surface in reach, no "
                          f"partner found for {lost:.3e} of {total:.3e} mm (2D) or mm² (3D), worst for facet "
                          f"{segments.facet1[worst]} against facet {segments.facet2[worst]} of the second surface: too "
                          "curved for their facets, or too far apart; refine them, or make the contact's reach smaller")
    return lost
