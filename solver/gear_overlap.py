"""Whether flanks touch where the window does not look: deep deflection can bring a tip's edge into contact far from
every contact line, and a solution without it is balanced all the same."""

from __future__ import annotations

import numpy as np

from meshes.data import Floats, Ints
from solver.gear_contact import PENETRATION, GearContact
from solver.gear_window import facets_in_window, placed_flanks
from solver.lagrange import tabulate
from solver.search import Pairing, pair_surfaces
from solver.surface import Surface


def overlap_outside(contact: GearContact, force: Floats, teeth: tuple[int, ...]) -> float:
    """How deep [mm] the deflected flanks of the tooth pairs overlap where their window does not look; 0 where they do
    not. force: contact forces (n, k) of the solution.

    Only what overlaps undeformed is looked at: loaded teeth give way, so that flanks apart from the contact move away
    from each other. And only slices whose contact line is off the path of contact: on it conjugate flanks are closest
    in the window. Raises SearchError.
    """
    forces = contact.pushed(0, force), contact.pushed(1, force)
    return max((_overlap(contact, forces, tooth) for tooth in teeth), default=0.0)


def _overlap(contact: GearContact, forces: tuple[Floats, Floats], tooth: int) -> float:
    facets = _unsearched(contact, tooth)
    if len(facets) == 0:
        return 0.0
    first, second = placed_flanks(contact.bodies, contact.stand, tooth)
    found = pair_surfaces(first, second, 0.0, PENETRATION * contact.bodies[0].gear.normal_module, facets)
    if len(found.gap) == 0:
        return 0.0
    sides = (first, found.facet1, found.xi1), (second, found.facet2, found.xi2)
    u1, u2 = (_moved(contact, forces[gear], gear, tooth, *side) for gear, side in enumerate(sides))
    gap = found.gap + sum(body.lost(*side[1:]) for body, side in zip(contact.bodies, sides))
    return float(np.max(np.einsum("qa,qa->q", _normals(first, found), u1 - u2) - gap, initial=0.0))


def _unsearched(contact: GearContact, tooth: int) -> Ints:
    """The pinion's facets in slices off the path of contact that the window leaves out."""
    pinion, stand = contact.bodies[0], contact.stand
    start, end = stand.pair.path_of_contact
    ξ = stand.roll_distance(tooth, pinion.z)
    off = ((ξ < start) | (ξ > end))[pinion.flank.facets].any(axis=1)
    return np.flatnonzero(off & ~facets_in_window(pinion, stand, tooth, contact.half_width))


def _moved(
    contact: GearContact, forces: Floats, gear: int, tooth: int, surface: Surface, facets: Ints, xi: Floats
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
