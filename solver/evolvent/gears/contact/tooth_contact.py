"""One tooth pair at a position: where its flanks face each other within the window, undeflected or deflected."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.contact_operator import ContactOperator, contact_operator
from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.search.pairing import Pairing, SearchError, pair_surfaces
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.contact_lattice import ContactLattice
from evolvent.gears.contact.contact_line import ContactLine
from evolvent.gears.contact.lattice_pairing import jump_space, pair_at_lattice, with_wheel_edges
from evolvent.gears.contact.pressure_normals import pressure_normals
from evolvent.gears.contact.search_window import arc_distance, facets_in_window, placed_flanks
from evolvent.gears.kinematics import PairRotation
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member

GAP = 0.2  # largest distance [module] between flanks that the search pairs
PENETRATION = 0.55
"""Largest overlap [modules] of undeflected flanks that are paired: more than `pair_contact.DEEPEST`, by which teeth may
deflect."""
Displaced = tuple[Floats, Floats]
"""Displacements (n, d) [mm] of the flank nodes of pinion and wheel, in the common frame."""


@dataclass(frozen=True)
class ToothContact:
    """One tooth pair at a position.

    tooth: its number.
    operator: contact without wear: in the space of the pinion's flank, or on a contact lattice.
    pairing: where its points lie on both flanks.
    at_tip_edge: points (q,) bool whose jump depends on the last row before a tip edge of either gear.
    distance: (q,) distance of the points from the contact line [mm of profile arc].
    z: (n,) heights of the jump's nodes [mm].
    arc: (n,) profile arc of these on the pinion's flank, from the base circle on [mm].
    displaced: displacements with which the flanks were searched, None where they are undeflected.
    wheel_edges: where the edges of the wheel's flank face the pinion's, see `ContactLine`; None without a lattice.
    """

    tooth: int
    operator: ContactOperator
    pairing: Pairing
    at_tip_edge: Bools
    distance: Floats
    z: Floats
    arc: Floats
    displaced: Displaced | None = None
    wheel_edges: tuple[Floats, Floats] | None = None

    def coupled_nodes(self, gear: Member) -> Ints:
        """Flank nodes of a gear that the jump depends on, sorted."""
        jump = self._jumps[gear]
        return jump.columns if isinstance(jump, MortarProjection) else self.operator.nodes

    @cached_property
    def projections(self) -> tuple[MortarProjection | None, MortarProjection | None]:
        """Mortar projection Π (n, m) from the coupled nodes of pinion and wheel; None where it is the identity."""
        first, second = (j.of_columns() if isinstance(j, MortarProjection) else None for j in self._jumps)
        return first, second

    def projected(self, gear: Member, values: Floats) -> Floats:
        """Values (n, c) at the jump's nodes from those (m, c) at a gear's coupled nodes."""
        projection = self.projections[gear]
        return values if projection is None else projection @ values

    @property
    def _jumps(self) -> tuple[sp.csr_matrix | MortarProjection, MortarProjection]:
        return self.operator.jump1, self.operator.jump2

    def displaced_from(self, gear: Member, points: Floats) -> Floats:
        """Points (n, d) of a gear's flank that belong to the jump's nodes, displaced as they were in the search."""
        if self.displaced is None:
            return points
        return np.asarray(points + self._jumps[gear] @ self.displaced[gear])


def tooth_contact(
    bodies: tuple[GearBody, GearBody], stand: PairRotation, tooth: int, half_width: float, displaced: Displaced | None
) -> ToothContact | None:
    """Searches a tooth pair at this stand; None where its flanks are out of reach.

    half_width: of the window [mm of profile arc].
    displaced: displacements of the flanks before the search.

    Raises SearchError.
    """
    flanks = placed_flanks(bodies, stand, tooth)
    if displaced is not None:
        first, second = flanks
        flanks = _moved(first, displaced[0]), _moved(second, displaced[1])
    found = (_on_lattice if bodies[Member.PINION].levels else _on_flank)(bodies, flanks, stand, tooth, half_width)
    if found is None:
        return None
    operator, ξ = found.operator, stand.roll_distance(tooth, found.z)
    opposite = operator.jump2 @ flanks[Member.WHEEL].normals
    operator = operator.pressing_along(pressure_normals(operator.frames[:, 0], opposite, stand.pair, ξ))
    if displaced is not None:
        operator = operator.before(_jump(found.pairing, *flanks, displaced))
    return replace(found, operator=operator, displaced=displaced)


def _on_flank(
    bodies: tuple[GearBody, GearBody], flanks: tuple[Surface, Surface], stand: PairRotation, tooth: int,
    half_width: float,
) -> ToothContact | None:
    """Contact with a jump in the space of the pinion's flank."""
    pinion = bodies[Member.PINION]
    assert pinion.stabiliser is not None
    facets = np.flatnonzero(facets_in_window(pinion, stand, tooth, half_width))
    if len(facets) == 0:
        return None
    first, second = flanks
    module = pinion.gear.normal_module
    pairing = pair_surfaces(first, second, GAP * module, PENETRATION * module, facets)
    if len(pairing.weight) == 0:
        return None
    operator = contact_operator(pairing, first, second, pinion.stabiliser, tangent_frames(first.normals))
    arc = pinion.roll_length[operator.nodes]**2 / (2.0 * pinion.gear.base_radius)
    distance = operator.hat @ arc_distance(pinion, stand, tooth, operator.nodes)
    edge = _reading_tips(bodies, operator)
    return ToothContact(tooth, operator, pairing, edge, distance, pinion.z[operator.nodes], arc)


def _on_lattice(
    bodies: tuple[GearBody, GearBody], flanks: tuple[Surface, Surface], stand: PairRotation, tooth: int,
    half_width: float,
) -> ToothContact | None:
    """Contact with a jump on cells that follow the contact line."""
    pinion = bodies[Member.PINION]
    assert pinion.stabiliser is not None
    line = ContactLine((bodies[0].cells, bodies[1].cells), stand, tooth)
    line = with_wheel_edges(line, flanks, whole=bool(np.isinf(half_width)))
    lattice = ContactLattice.of(line, half_width)
    if lattice is None:
        return None
    module = pinion.gear.normal_module
    pairing, kept = pair_at_lattice(lattice, flanks, GAP * module, PENETRATION * module)
    if len(pairing.weight) == 0:
        return None
    operator = contact_operator(
        pairing, *flanks, pinion.stabiliser, tangent_frames(flanks[0].normals),
        jumps=jump_space(lattice, flanks[0], kept),
    )
    cell, last = lattice.cell[kept], _in_last_rows(bodies, pairing)
    distance = np.abs(lattice.point_across[kept])
    return ToothContact(
        tooth, operator, pairing, np.isin(cell, cell[last]), distance, lattice.z, lattice.arc,
        wheel_edges=line.wheel_edges,
    )


def _reading_tips(bodies: tuple[GearBody, GearBody], operator: ContactOperator) -> Bools:
    """Points (q,) bool with more than a share of a jump in the space of the pinion's flank from nodes on tip edges."""
    pinion, wheel = (body.tip_zone for body in bodies)
    opposite = operator.jump2.columns
    tip = opposite[wheel[opposite]]
    first = operator.shape @ pinion[operator.nodes].astype(float)
    second = np.abs(operator.shape) @ np.abs(operator.jump2.at(tip)).sum(axis=1)
    return np.asarray((np.abs(first) > 1e-9) | (second > 0.05))


def _in_last_rows(bodies: tuple[GearBody, GearBody], pairing: Pairing) -> Bools:
    """Points (q,) bool in the last row of facets before a tip edge of either gear."""
    first, second = (
        body.tip_zone[body.flank.facets[facets]].any(axis=1)
        for body, facets in zip(bodies, (pairing.facet1, pairing.facet2))
    )
    return np.asarray(first | second)


def _moved(flank: Surface, u: Floats) -> Surface:
    try:
        return flank.displaced(u)
    except ValueError as folded:
        raise SearchError(str(folded)) from folded


def _jump(pairing: Pairing, first: Surface, second: Surface, displaced: Displaced) -> Floats:
    """Jump (q, d) [mm] of the displacements at each pair of points. Not of their projection: what that smooths of them
    would come back as roughness of the gap."""
    pinion, wheel = displaced
    u1 = first.evaluate(pinion, pairing.facet1, pairing.xi1[:, None])[0]
    u2 = second.evaluate(wheel, pairing.facet2, pairing.xi2[:, None])[0]
    return np.asarray((u1 - u2)[:, 0])
