"""Where the two surfaces of a contact meet at a step: searched as the bodies are placed, or as they have moved since.

Jumps count displacements, so gaps are always those between the points as placed. What a search on displaced surfaces
changes is which points face each other, and along which normals: with u the displacement of the search, the gap
n·(X2 − X1) of points with x2 = x1 + g n is g − n·(u2 − u1). Areas stay those of the undeformed surface, as for all
stresses in small strain.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.nitsche.contact_operator import ContactOperator, contact_operator, mass_matrix
from evolvent.contact.problem.definition import Contact
from evolvent.contact.search.pairing import Pairing, SearchError, pair_surfaces
from evolvent.fem.body import Body
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.reference_facets import area_vector
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats

REACH = 0.1  # of a surface's extent: the gap up to which contact is looked for where none is given
Pair = tuple[Surface, Surface]
Places = tuple[Floats, Floats]
"""Positions [mm] of the nodes of both surfaces of a contact in the common frame, (n1, d) and (n2, d)."""


@dataclass(frozen=True)
class Supports:
    """Where a body's supports hold a contact surface: planes of symmetry, as far as they cross a contact.

    held: (n, d) of the nodes, in the directions of the body's frame.
    rotation: (d, d) that turns the body's frame into the common one.
    """

    held: Bools
    rotation: Floats

    @staticmethod
    def of(body: Body, surface: Surface, rotation: Floats) -> Supports:
        """Of a surface of the body."""
        d = body.mesh.dimension
        held = np.zeros((len(body.mesh.points), d), dtype=bool)
        for support in body.supports:
            for letter in support.directions[:d] if support.directions == "xyz" else support.directions:
                held[np.unique(body.mesh.facets[support.group]), "xyz".index(letter)] = True
        return Supports(held[surface.nodes], rotation)


@dataclass(frozen=True)
class Meeting:
    """The pairs of one contact.

    placed: both surfaces as the bodies are placed, the one that carries the pressure first.
    searched: the same where the pairs were searched.
    pairing: the pairs found there.
    operator: the contact on them.
    supports: what holds each surface.
    """

    placed: Pair
    searched: Pair
    pairing: Pairing
    operator: ContactOperator
    supports: tuple[Supports, Supports]


def reach_of(contact: Contact, first: Surface) -> float:
    """The gap [mm] up to which a contact whose first surface is given is looked for."""
    return REACH * extent(first) if contact.reach is None else contact.reach


def extent(surface: Surface) -> float:
    """Largest edge [mm] of the box around a surface."""
    return float(np.ptp(surface.points, axis=0).max())


def met(
    contact: Contact,
    reach: float,
    placed: Pair,
    stabiliser: Floats,
    frames: Floats,
    supports: tuple[Supports, Supports],
    where: Places | None,
) -> Meeting:
    """The pairs of a contact within a gap of `reach` [mm], searched as placed or, with `where`, on surfaces whose nodes
    lie there.

    stabiliser: (n1, 2) and frames: (n1, d, d) of the surface that carries the pressure, as placed.
    Raises SearchError, also where the surfaces are out of reach or have folded.
    """
    if where is None:
        found = _found(contact, placed, reach, reach)
        return Meeting(placed, placed, found, contact_operator(found, *placed, stabiliser, frames), supports)
    searched = displaced(placed, where)
    found = _found(contact, searched, reach, reach)
    operator = contact_operator(found, *searched, stabiliser, tangent_frames(searched[0].normals))
    normals = operator.shape @ operator.frames[:, 0]
    facets, xi = found.facet1, found.xi1[:, None]
    as_placed = replace(
        operator,
        mass=mass_matrix(placed[0], np.unique(facets), operator.nodes),
        points=placed[0].positions(facets, xi)[:, 0],
        weights=found.weight * _stretch(searched[0], placed[0], found),
        gap=np.einsum("qa,qa->q", normals, between(placed, found)),
    )
    return Meeting(placed, searched, found, as_placed, supports)


def displaced(placed: Pair, where: Places) -> Pair:
    """The surfaces with their nodes there. Raises SearchError where a facet has folded."""
    try:
        first, second = (surface.displaced(x - surface.points) for surface, x in zip(placed, where))
    except ValueError as folded:
        raise SearchError(
            f"contact on displaced surfaces: wanted facets that stay facets, found {folded}; load in smaller steps, or "
            "lower the load"
        ) from folded
    return first, second


def overlapping(pair: Pair, reach: float) -> Pairing:
    """Where two surfaces overlap, however deep: unlike a gap, that is never meant. Raises SearchError."""
    try:
        return pair_surfaces(*pair, 0.0, max(reach, REACH * extent(pair[0])))
    except SearchError:  # a thin body's far side
        return pair_surfaces(*pair, 0.0, reach)


def between(pair: Pair, found: Pairing) -> Floats:
    """Vectors (q, d) [mm] from each point of surface 1 to its partner."""
    first, second = pair
    ends = second.positions(found.facet2, found.xi2[:, None]) - first.positions(found.facet1, found.xi1[:, None])
    return np.asarray(ends[:, 0])


def _found(contact: Contact, pair: Pair, gap: float, overlap: float) -> Pairing:
    found = pair_surfaces(*pair, gap, overlap)
    if not len(found.facet1):
        raise SearchError(
            f"contact between {contact.first[1]!r} of body {contact.first[0]} and {contact.second[1]!r} of body "
            f"{contact.second[0]}: wanted surfaces within {gap:.3g} mm of each other, found none; place the "
            "bodies closer together, or give the contact a larger reach"
        )
    return found


def _stretch(searched: Surface, placed: Surface, found: Pairing) -> Floats:
    """(q,) area as placed over that where the pairs were searched."""
    areas = [
        np.linalg.norm(area_vector(surface.evaluate(surface.points, found.facet1, found.xi1[:, None])[1]), axis=-1)
        for surface in (placed, searched)
    ]
    return np.asarray(areas[0] / areas[1])[:, 0]
