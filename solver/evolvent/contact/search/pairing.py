"""Pairing of two surfaces: quadrature points of a contact integral over surface 1, with their partners on surface 2.

The integral is over segments, the pieces into which the facets of surface 2, projected along the normals of surface 1,
divide the sub-facets of surface 1. On each segment all hat and shape functions of both sides are smooth, so that
non-matching meshes pass the patch test (Puso & Laursen 2004, doi 10.1016/j.cma.2003.10.010, here with curved facets).

Steps, each over all facet pairs at once:
1. candidates: facet pairs within reach whose normals oppose (k-d tree, then boxes in the frame of facet 1);
2. the outline of facet 2 is projected into the reference plane of facet 1 along the interpolated nodal normal;
3. it is clipped against each sub-facet of facet 1 and cut into triangles (in 2D: an interval);
4. from each quadrature point the partner on facet 2 is located along the normal.

No area is covered twice or missed: in step 2 a point has one image in facet 1, for every facet 2 that it belongs to,
and the sides of the outline are straight in that plane for both facets 2 that share them. An edge of facet 2 that is
curved in the plane is therefore replaced by chords. Points between chord and edge lie slightly outside their facet 2,
on the continuation of its polynomial (x2 = x1 + gap n1 holds exactly).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from evolvent.contact.search.facet_candidates import facet_candidates
from evolvent.contact.search.projection import dot, locate
from evolvent.contact.search.segments import Segments, segments_2d, segments_3d
from evolvent.fem.lagrange import quadrature
from evolvent.fem.reference_facets import area_vector, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.errors import InputError, ResultError

ALLOWED_LOSS = 1e-3  # fraction of the covered area that may be without partners
DOUBLE = 1e-6  # fraction of a facet that may be covered twice, by rounding


class SearchError(ResultError):
    """The partner of more than a thousandth of the covered area was not found, or an area has two partners."""


@dataclass(frozen=True)
class Pairing:
    """Quadrature points of a contact integral over surface 1 facing surface 2, sorted by facet of surface 1.

    facet1: (q,) facets of surface 1.
    xi1: (q, d−1) reference points on them.
    facet2: (q,) facets of surface 2.
    xi2: (q, d−1) reference points of the partners, which may lie slightly outside these facets.
    weight: (q,) quadrature weights, including the measure of surface 1 [mm²; mm in 2D]. A few may be slightly negative,
        where the outline of a facet 2 with curved edges is not convex.
    gap: (q,) signed distances along the normalised interpolated nodal normal n1, x2(xi2) = x1(xi1) + gap n1 [mm].
    lost: area without points because no partner was found, at most ALLOWED_LOSS of the covered area [mm²; mm in 2D].
    """

    facet1: Ints
    xi1: Floats
    facet2: Ints
    xi2: Floats
    weight: Floats
    gap: Floats
    lost: float

    def of(self, chosen: Bools) -> Pairing:
        """Some of the pairs (q,) bool."""
        return Pairing(
            self.facet1[chosen], self.xi1[chosen], self.facet2[chosen], self.xi2[chosen], self.weight[chosen],
            self.gap[chosen], self.lost,
        )


def pair_surfaces(surface1: Surface, surface2: Surface, max_gap: float, max_overlap: float,
                  facets1: ArrayLike | None = None, degree: int = 4) -> Pairing:
    """Pairs the points of surface 1 with those of surface 2 at the current positions of their nodes.

    max_gap, max_overlap: gaps in [-max_overlap, max_gap] are kept, both >= 0 [mm].
    facets1: indices of the facets of surface 1 to pair; by default all.
    degree: polynomial degree of the rule on each segment (3D: 4 has 6 points a triangle; 2D: at least 5, 3 points).

    Parts of surface 1 without a partner have no points. Raises SearchError; InputError if the surfaces or the limits do
    not fit.
    """
    _check(surface1, surface2, max_gap, max_overlap)
    chosen = np.arange(len(surface1.facets)) if facets1 is None else np.unique(np.asarray(facets1, dtype=np.int64))
    pairs = facet_candidates(surface1, surface2, chosen, max_gap, max_overlap)
    if len(pairs[0]) == 0:
        return _no_points(surface1.points.shape[1])
    if surface1.shape == "interval":
        segments = segments_2d(surface1, surface2, *pairs)
    else:
        segments = segments_3d(surface1, surface2, *pairs, max_gap, max_overlap)
    return _points(surface1, surface2, segments, max_gap, max_overlap, degree)


def _check(surface1: Surface, surface2: Surface, max_gap: float, max_overlap: float) -> None:
    if surface1.points.shape[1] != surface2.points.shape[1]:
        raise InputError(f"contact: wanted both surfaces in 2D or both in 3D, found {surface1.points.shape[1]}D facing "
                         f"{surface2.points.shape[1]}D; mesh both alike")
    if not (max_gap >= 0.0 and max_overlap >= 0.0):
        raise InputError(f"contact: wanted a reach >= 0 mm, found {max_gap} for gaps and {max_overlap} for overlaps; "
                         "give it in mm")


def _no_points(d: int) -> Pairing:
    """Empty pairing of surfaces that are out of reach."""
    facets, xi, values = np.empty(0, dtype=np.int64), np.empty((0, d - 1)), np.empty(0)
    return Pairing(facets, xi, facets, xi, values, values, 0.0)


def _points(surface1: Surface, surface2: Surface, segments: Segments, max_gap: float, max_overlap: float,
            degree: int) -> Pairing:
    """Quadrature points on the segments, with their partners (step 4)."""
    rule, rule_weight = _rule(surface1.shape, degree)
    xi1, guess = rule @ segments.corners1, rule @ segments.corners2
    size = np.linalg.det(segments.corners1[:, 1:] - segments.corners1[:, :1])[:, None] * rule_weight
    start, normal, measure = _points_normals(surface1, segments.facet1, xi1)
    xi2, gap, located = locate(surface2, segments.facet2, start, normal, guess)
    located &= segments.trusted[:, None]
    keep = located & (gap >= -max_overlap) & (gap <= max_gap)
    row = np.nonzero(keep)[0]
    _refuse_double(surface1, segments.facet1[row], size[keep])
    lost = _refuse_lost(surface1, segments, size, located)
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
    """Fraction (m,) of each facet that points on `facets` (p,) with reference weights `size` (p,) cover."""
    measure = reference_cell(surface.shape, surface.order).measure
    return np.bincount(facets, size, minlength=len(surface.facets)) / measure


def _refuse_double(surface: Surface, facets: Ints, size: Floats) -> None:
    """Raises SearchError where a facet of surface 1 is covered more than once."""
    covered = _coverage(surface, facets, size)
    if np.any(covered > 1.0 + DOUBLE):
        worst = int(np.argmax(covered))
        raise SearchError(f"contact: wanted one partner for each point of the first surface, found "
                          f"{int(np.sum(covered > 1.0 + DOUBLE))} facets that have two partners (facet {worst} is "
                          f"covered {covered[worst]:.6f} times): the second surface lies in reach twice; make the "
                          "contact's reach smaller, or split the second surface")


def _refuse_lost(surface: Surface, segments: Segments, size: Floats, located: Bools) -> float:
    """The area that has a segment but no partner. Raises SearchError if it is more than ALLOWED_LOSS of all that has.

    Area that another segment covers is not lost: the far outline of a wrong candidate may lie over a covered facet.
    """
    row = np.nonzero(~located)[0]
    if len(row) == 0:
        return 0.0
    covered = _coverage(surface, segments.facet1[np.nonzero(located)[0]], size[located])
    missing = _coverage(surface, segments.facet1[row], np.abs(size[row, np.nonzero(~located)[1]]))
    missing = np.minimum(missing, np.maximum(0.0, 1.0 - covered))
    lost, total = float(missing @ surface.areas()), float((missing + covered) @ surface.areas())
    if lost > ALLOWED_LOSS * total:
        worst = row[np.argmax(missing[segments.facet1[row]])]
        raise SearchError(f"contact: wanted partners for all but {ALLOWED_LOSS} of the first surface in reach, no "
                          f"partner found for {lost:.3e} of {total:.3e} mm (2D) or mm² (3D), worst for facet "
                          f"{segments.facet1[worst]} against facet {segments.facet2[worst]} of the second surface: too "
                          "curved for their facets, or too far apart; refine them, or make the contact's reach smaller")
    return lost
