"""The two surfaces of a contact at a step, paired: searched as the bodies are placed, or on displaced surfaces.

Jumps are those of displacements, so that gaps are always measured between the points as placed. A search on displaced
surfaces changes only which points face each other, and along which normals: with u the displacement of the search and
x2 = x1 + g n there, the gap as placed is n·(X2 − X1) = g − n·(u2 − u1). Areas stay those of the undeformed surface, as
for all stresses in small strain.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.nitsche.contact_operator import ContactOperator, contact_operator
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent.contact.problem.definition import Contact
from evolvent.contact.search.pairing import Pairing, SearchError, pair_surfaces
from evolvent.fem.body import Body
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.reference_facets import area_vector
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats

REACH = 0.1
"""Default reach, as a fraction of the first surface's extent."""
SurfacePair = tuple[Surface, Surface]
"""Both surfaces of a contact, the one that carries the pressure first."""
SurfacePositions = tuple[Floats, Floats]
"""Positions [mm] of the nodes of a `SurfacePair` in the common frame, (n1, d) and (n2, d)."""


@dataclass(frozen=True)
class SurfaceSupports:
    """The supports of a body on one contact surface: planes of symmetry, where they cross the contact.

    held: (n, d) bool, whether the node is held along each axis of the body's frame.
    rotation: (d, d), from the body's frame to the common one.
    """

    held: Bools
    rotation: Floats

    @staticmethod
    def of(body: Body, surface: Surface, rotation: Floats) -> SurfaceSupports:
        """Supports of a body on one of its surfaces. rotation: (d, d), from the body's frame to the common one."""
        d = body.mesh.dimension
        held = np.zeros((len(body.mesh.points), d), dtype=bool)
        for support in body.supports:
            for letter in support.directions[:d] if support.directions == "xyz" else support.directions:
                held[np.unique(body.mesh.facets[support.group]), "xyz".index(letter)] = True
        return SurfaceSupports(held[surface.nodes], rotation)


@dataclass(frozen=True)
class PairedSurfaces:
    """Both surfaces of a contact at a step, with the pairs of points that face each other.

    placed: the surfaces as the bodies are placed.
    searched: the surfaces on which the pairs were searched.
    pairing: the q pairs of points.
    operator: the contact operator on these pairs.
    supports: supports of the bodies on each surface.
    """

    placed: SurfacePair
    searched: SurfacePair
    pairing: Pairing
    operator: ContactOperator
    supports: tuple[SurfaceSupports, SurfaceSupports]


def reach_of(contact: Contact, first: Surface) -> float:
    """The reach [mm] of a contact, given or default; first: the contact's first surface."""
    return REACH * extent(first) if contact.reach is None else contact.reach


def extent(surface: Surface) -> float:
    """Largest edge [mm] of the bounding box of a surface."""
    return float(np.ptp(surface.points, axis=0).max())


def pair_contact(
    contact: Contact,
    reach: float,
    placed: SurfacePair,
    stabiliser: Floats,
    frames: Floats,
    supports: tuple[SurfaceSupports, SurfaceSupports],
    positions: SurfacePositions | None,
) -> PairedSurfaces:
    """Pairs the surfaces of a contact within gaps and overlaps of `reach` [mm].

    stabiliser: (n1, 2) γ and γ_t [MPa/mm] of the surface that carries the pressure.
    frames: (n1, d, d) its nodal frames, as placed.
    positions: where its nodes and those of the other surface lie for the search; None: as placed.
    Raises SearchError, also where the surfaces are out of reach or have folded.
    """
    if positions is None:
        pairing = _search(contact, placed, reach)
        operator = contact_operator(pairing, *placed, stabiliser, frames)
        return PairedSurfaces(placed, placed, pairing, operator, supports)
    searched = displaced(placed, positions)
    pairing = _search(contact, searched, reach)
    operator = contact_operator(pairing, *searched, stabiliser, tangent_frames(searched[0].normals))
    normals = operator.shape @ operator.frames[:, 0]
    facets, xi = pairing.facet1, pairing.xi1[:, None]
    as_placed = replace(
        operator,
        mass=SurfaceMass.of(placed[0], np.unique(facets), operator.nodes),
        points=placed[0].positions(facets, xi)[:, 0],
        weights=pairing.weight * _area_ratio(searched[0], placed[0], pairing),
        gap=np.einsum("qa,qa->q", normals, distance_vectors(placed, pairing)),
    )
    return PairedSurfaces(placed, searched, pairing, as_placed, supports)


def displaced(placed: SurfacePair, positions: SurfacePositions) -> SurfacePair:
    """The surfaces with their nodes at other positions. Raises SearchError where a facet has folded."""
    try:
        first, second = (surface.displaced(x - surface.points) for surface, x in zip(placed, positions))
    except ValueError as folded:
        raise SearchError(
            f"contact on displaced surfaces: wanted facets that do not fold, found {folded}; load in smaller steps, or "
            "lower the load"
        ) from folded
    return first, second


def pair_overlaps(surfaces: SurfacePair, reach: float) -> Pairing:
    """Pairs of points where two surfaces overlap, also deeper than `reach` [mm]. Raises SearchError."""
    try:
        return pair_surfaces(*surfaces, 0.0, max(reach, REACH * extent(surfaces[0])))
    except SearchError:  # so deep a search may find the far side of a thin body
        return pair_surfaces(*surfaces, 0.0, reach)


def distance_vectors(surfaces: SurfacePair, pairing: Pairing) -> Floats:
    """Vectors (q, d) [mm] from the points on surface 1 to their partners."""
    first, second = surfaces
    partners = second.positions(pairing.facet2, pairing.xi2[:, None])
    return np.asarray((partners - first.positions(pairing.facet1, pairing.xi1[:, None]))[:, 0])


def _search(contact: Contact, surfaces: SurfacePair, reach: float) -> Pairing:
    pairing = pair_surfaces(*surfaces, reach, reach)
    if not len(pairing.facet1):
        raise SearchError(
            f"contact between {contact.first[1]!r} of body {contact.first[0]} and {contact.second[1]!r} of body "
            f"{contact.second[0]}: wanted surfaces within {reach:.3g} mm of each other, found none; place the "
            "bodies closer together, or, if they overlap by more than that, apart, or give the contact a larger reach"
        )
    return pairing


def _area_ratio(searched: Surface, placed: Surface, pairing: Pairing) -> Floats:
    """Surface measure as placed over that where the pairs were searched, (q,)."""
    areas = [
        np.linalg.norm(area_vector(surface.evaluate(surface.points, pairing.facet1, pairing.xi1[:, None])[1]), axis=-1)
        for surface in (placed, searched)
    ]
    return np.asarray(areas[0] / areas[1])[:, 0]
