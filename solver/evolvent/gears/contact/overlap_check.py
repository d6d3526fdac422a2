"""Whether flanks touch where the window does not look: deep deflection can bring a tip's edge into contact far from
every contact line, and a solution without it is balanced all the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.search.pairing import Pairing, pair_surfaces
from evolvent.fem.lagrange import tabulate
from evolvent.fem.surface import Surface
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.contact.search_window import facets_in_window, placed_flanks
from evolvent.gears.contact.tooth_contact import PENETRATION
from evolvent.gears.kinematics import spin
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member

NEARLY = 5e-3  # modules: flanks so far apart may overlap once the gears have turned on, see gear_position.STALE

@dataclass(frozen=True)
class Unwatched:
    """Where the undeformed flanks of a tooth pair overlap, or nearly do, outside the window: the pinion's flank in
    place, and the pairs of points."""

    tooth: int
    first: Surface
    second: Surface
    pairs: Pairing


def unwatched(contact: GearContact, teeth: tuple[int, ...]) -> tuple[Unwatched, ...]:
    """Of all tooth pairs, for flanks as made.

    Only what overlaps undeformed is looked at, and what a rotation of up to NEARLY can bring to overlap: loaded teeth
    give way, so that flanks apart from the contact move away from each other. And only slices whose contact line is
    off the path of contact: on it conjugate flanks are closest in the window. Raises SearchError.
    """
    found, module = [], contact.bodies[0].gear.normal_module
    for tooth in teeth:
        facets = _unsearched(contact, tooth)
        if len(facets):
            first, second = placed_flanks(contact.bodies, contact.stand, tooth)
            pairs = pair_surfaces(first, second, NEARLY * module, PENETRATION * module, facets)
            found += [Unwatched(tooth, first, second, pairs)] if len(pairs.gap) else []
    return tuple(found)


def overlap_outside(
    contact: GearContact, places: tuple[Unwatched, ...], force: Floats, rotation: tuple[float, float]
) -> float:
    """How deep [mm] the deflected flanks overlap at these places; 0 where they do not. force: contact forces (n, k) of
    the solution; rotation: of pinion and wheel [rad] since the search."""
    if not places:
        return 0.0
    forces = contact.pushed(Member.PINION, force), contact.pushed(Member.WHEEL, force)
    return max(_overlap(contact, own, forces, rotation) for own in places)


def _overlap(
    contact: GearContact, own: Unwatched, forces: tuple[Floats, Floats], rotation: tuple[float, float]
) -> float:
    found = own.pairs
    sides = (own.first, found.facet1, found.xi1), (own.second, found.facet2, found.xi2)
    u1, u2 = (
        _moved(contact, forces[gear], gear, own.tooth, *side) + _turned(contact, rotation[gear], gear, *side)
        for gear, side in zip(Member, sides)
    )
    gap = found.gap + sum(body.lost(*side[1:]) for body, side in zip(contact.bodies, sides))
    return float(np.max(np.einsum("qa,qa->q", _normals(own.first, found), u1 - u2) - gap, initial=0.0))


def _turned(contact: GearContact, angle: float, gear: Member, surface: Surface, facets: Ints, xi: Floats) -> Floats:
    """Displacements (q, d) at points of a gear's flank that turns by a small angle [rad]."""
    x = surface.evaluate(surface.points, facets, xi[:, None])[0][:, 0]
    return angle * spin(x, contact.stand.centre(gear, contact.d), contact.stand.axis(gear))


def _unsearched(contact: GearContact, tooth: int) -> Ints:
    """The pinion's facets in slices off the path of contact that the window leaves out."""
    pinion, stand = contact.bodies[0], contact.stand
    start, end = stand.pair.path_of_contact
    ξ = stand.roll_distance(tooth, pinion.z)
    off = ((ξ < start) | (ξ > end))[pinion.flank.facets].any(axis=1)
    return np.flatnonzero(off & ~facets_in_window(pinion, stand, tooth, contact.half_width))


def _moved(
    contact: GearContact, forces: Floats, gear: Member, tooth: int, surface: Surface, facets: Ints, xi: Floats
) -> Floats:  # fmt: skip
    """Displacements (q, d) at points of a gear's flank in the common frame [mm]; forces (m, d) on the contact's rows of
    it."""
    nodes, place = np.unique(surface.facets[facets], return_inverse=True)
    body = contact.bodies[gear]
    u = body.chain.apply(contact.rows(gear)[0], forces, body.rows(tooth, nodes))
    u = u @ contact.stand.rotation(gear, contact.d).T
    N = tabulate(surface.shape, surface.order, xi)[0]
    return np.einsum("qk,qka->qa", N, u[place.reshape(N.shape)])


def _normals(surface: Surface, found: Pairing) -> Floats:
    """(q, d) unit normals along which the gaps were measured."""
    n = surface.evaluate(surface.normals, found.facet1, found.xi1[:, None])[0][:, 0]
    return np.asarray(n / np.linalg.norm(n, axis=1, keepdims=True))
