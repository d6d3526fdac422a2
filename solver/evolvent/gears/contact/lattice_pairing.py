"""Pairing of the flanks of a tooth pair at the points of its contact lattice."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.nitsche.jump_space import JumpSpace
from evolvent.contact.search.pairing import ALLOWED_LOSS, Pairing, SearchError
from evolvent.contact.search.projection import dot, locate
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.reference_facets import area_vector
from evolvent.fem.surface import Surface
from evolvent.gears.contact.contact_lattice import ContactLattice
from evolvent.gears.contact.contact_line import ContactLine
from evolvent.gears.contact.search_window import near_path
from evolvent.gears.two_level.flank_cells import FlankCells, FlankPlaces
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member

CONTINUED = 0.1
"""How far beyond its last cells, over these, the wheel's flank is continued: modifications and misalignment move the
image of its tip."""
INWARDS = 0.1
"""How far inside the edges of the wheel's flank partners are looked for at first, in modules."""


@dataclass(frozen=True)
class FacedPoints:
    """Points of the pinion's flank with their partners on the wheel's, along the pinion's normals.

    pairing: all q points; their weights are the area of the pinion's flank per profile arc and height.
    found: (q,) bool whether there is a partner.
    inner: (q,) bool whether the place that faces a point on conjugate flanks is not at the edge of the wheel's.
    inside: (q,) bool whether the place that a point was followed to is not beyond the wheel's flank, continued.
    partner: places of the partners.
    """

    pairing: Pairing
    found: Bools
    inner: Bools
    inside: Bools
    partner: FlankPlaces


def faced_points(line: ContactLine, arc: Floats, z: Floats, surfaces: tuple[Surface, Surface]) -> FacedPoints:
    """Points at profile arcs (q,) on the pinion's flank and heights (q,) [mm], with their partners.

    surfaces: flanks of pinion and wheel in place, or as they were displaced.
    """
    first, second = surfaces
    pinion, wheel = line.flanks
    places = pinion.place(arc, z)
    facet1, xi1 = pinion.reference(places)
    value, slopes = first.evaluate(np.hstack([first.points, first.normals]), facet1, xi1[:, None])
    area = area_vector([slope[:, 0, :3] for slope in slopes])
    measure = np.sqrt(dot(area, area)) / np.prod(pinion.slopes(places), axis=1)
    opposite = wheel.place(line.opposite(z, arc), z)
    facet2, xi2, gap, found, partner = _partners(second, wheel, opposite, value[:, 0, :3], _units(value[:, 0, 3:]))
    pairing, inside = Pairing(facet1, xi1, facet2, xi2, measure, gap, 0.0), ~wheel.is_beyond(partner, CONTINUED)
    return FacedPoints(pairing, found, wheel.is_inner(opposite), inside, partner)


def with_wheel_edges(line: ContactLine, surfaces: tuple[Surface, Surface], whole: bool = False) -> ContactLine:
    """The line with the places on the pinion's flank that really face the edges of the wheel's: rotation beyond the
    nominal one, deflection, modifications and misalignment move them by hundredths of a millimetre. Far from the path
    of contact they are taken to be moved as at its end.

    surfaces: flanks of pinion and wheel in place, or as they were displaced.
    whole: look for them all over the face, however far the line has left the path of contact.
    """
    z, own = line.flanks[Member.PINION].height, line.flanks[Member.PINION].arc
    z = z[near_path(line.stand, line.tooth, z) | whole]
    if len(z) == 0:
        return line
    edges, away = np.array(line.edges_of_wheel(z)), np.zeros((2, len(z)))  # of the wheel's root and tip
    inwards = INWARDS * line.stand.pair.pinion.normal_module * np.array([[-1.0], [1.0]])
    for start in (edges + inwards, edges):  # first where partners surely lie on the flank, then at the edges found
        arc = np.clip(start + away, own[0], own[-1]).ravel()
        found, beyond = _beyond_opposite(line, arc, np.tile(z, 2), surfaces)
        away = np.where(found, beyond, away.ravel()).reshape(away.shape)
    return replace(line, wheel_edges=(z, away))


def _beyond_opposite(
    line: ContactLine, arc: Floats, z: Floats, surfaces: tuple[Surface, Surface]
) -> tuple[Bools, Floats]:
    """Whether places on the pinion's flank have partners (q,), and how far these are from the places that face them on
    conjugate flanks (q,) [mm of profile arc]."""
    faced, wheel = faced_points(line, arc, z, surfaces), line.flanks[Member.WHEEL]
    return faced.found, wheel.arc_of(faced.partner) - line.opposite(z, arc)


def pair_at_lattice(
    lattice: ContactLattice, surfaces: tuple[Surface, Surface], max_gap: float, max_overlap: float
) -> tuple[Pairing, Bools]:
    """Pairs the points of a lattice on the pinion's flank with those on the wheel's along the pinion's normals.

    surfaces: flanks in place, or as they were displaced.
    max_gap, max_overlap: gaps in [−max_overlap, max_gap] are kept [mm].

    Returns the pairs and which points (q,) bool of the lattice have one. Raises SearchError.
    """
    faced = faced_points(lattice.line, lattice.point_arc, lattice.point_z, surfaces)
    weight, gap = lattice.weights * faced.pairing.weight, faced.pairing.gap
    missing = np.flatnonzero(~faced.found & faced.inner & faced.inside)
    away = lattice.line.distance(lattice.point_arc[missing], lattice.point_z[missing], surfaces)
    lost = float(np.sum(weight[missing[away < max_gap]]))
    reached = lost + float(np.sum(weight[faced.found & faced.inner & faced.inside & (gap < max_gap)]))
    if lost > ALLOWED_LOSS * reached:
        raise SearchError(
            f"contact: wanted partners on the wheel's flank for all but {ALLOWED_LOSS} of the pinion's in reach, none "
            f"found for {lost:.3e} of {reached:.3e} mm²; refine the mesh"
        )
    kept = faced.found & faced.inside & (gap >= -max_overlap) & (gap <= max_gap)
    return replace(faced.pairing, weight=weight, lost=lost).of(kept), kept


def jump_space(lattice: ContactLattice, flank: Surface, kept: Bools) -> JumpSpace:
    """The space of the jump on a lattice; its nodes beyond the flank have the place and the normal nearest to them.

    flank: of the pinion, in place. kept: (q,) points of the lattice with a pair.
    """
    cells = lattice.line.flanks[Member.PINION]
    facets, xi = cells.reference(cells.place(lattice.arc, lattice.z))
    places = flank.evaluate(np.hstack([flank.points, flank.normals]), facets, xi[:, None])[0][:, 0]
    frames = tangent_frames(_units(places[:, 3:]))
    return JumpSpace(frames, places[:, :3], lattice.shape[kept], lattice.mass)


def _units(vectors: Floats) -> Floats:
    """Vectors (n, d) of length 1."""
    return np.asarray(vectors / np.sqrt(dot(vectors, vectors))[:, None])


def _partners(
    surface: Surface, cells: FlankCells, places: FlankPlaces, start: Floats, normal: Floats
) -> tuple[Ints, Floats, Floats, Bools, FlankPlaces]:
    """Facets (q,) and reference coordinates (q, 2) of the points of a flank on rays, their distances (q,) along these,
    which were found, (q,) bool, and where they lie on the flank. places: from which they are looked for, from cell to
    cell."""
    facets, xi = cells.reference(places)
    gap, found = np.zeros(len(facets)), np.zeros(len(facets), dtype=bool)
    away = np.arange(len(facets))
    for _ in range(sum(cells.facets.shape)):  # deflection moves partners by many cells
        at, distance, converged = locate(surface, facets[away], start[away, None], normal[away, None], xi[away, None])
        xi[away], gap[away], found[away] = at[:, 0], distance[:, 0], converged[:, 0]
        here = places.of(away)
        moved = cells.moved(here, xi[away])
        left = (moved.row != here.row) | (moved.layer != here.layer)
        if not left.any():
            break
        places = places.replaced(away[left], moved.of(left))
        away = away[left]
        facets[away], xi[away] = cells.reference(places.of(away))
    else:
        found[away] = False
    return facets, xi, gap, found, cells.moved(places, xi)
