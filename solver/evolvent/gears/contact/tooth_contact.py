"""One tooth pair at a position: where its flanks face each other within the window, undeflected or deflected."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.nitsche.contact_operator import ContactOperator, contact_operator
from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.search.pairing import Pairing, SearchError, pair_surfaces
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.pressure_normals import pressure_normals
from evolvent.gears.contact.search_window import facets_in_window, placed_flanks
from evolvent.gears.kinematics import PairRotation
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member

GAP = 0.2  # largest distance [module] between flanks that the search pairs
PENETRATION = 0.5  # largest overlap [module] of undeformed flanks that it pairs: far beyond any small strain
Displaced = tuple[Floats, Floats]
"""Displacements (n, d) [mm] of the flank nodes of pinion and wheel, in the common frame."""


@dataclass(frozen=True)
class ToothContact:
    """One tooth pair at a position.

    tooth: its number.
    operator: contact on the flank nodes of the pinion, without wear.
    pairing: where its points lie on both flanks.
    displaced: displacements with which the flanks were searched, None where they are undeflected.
    """

    tooth: int
    operator: ContactOperator
    pairing: Pairing
    displaced: Displaced | None = None

    def coupled_nodes(self, gear: Member) -> Ints:
        """Flank nodes of a gear that the jump depends on, sorted."""
        return self.operator.nodes if gear == Member.PINION else self.operator.jump2.columns

    @cached_property
    def projection(self) -> MortarProjection:
        """Mortar projection Π from the wheel's coupled nodes, (n, m)."""
        return self.operator.jump2.of_columns()

    def displaced_from(self, gear: Member, points: Floats) -> Floats:
        """Points (n, d) of a gear's flank that belong to the jump's nodes, displaced as they were in the search."""
        if self.displaced is None:
            return points
        weights = (self.operator.jump1, self.operator.jump2)[gear]
        return np.asarray(points + weights @ self.displaced[gear])


def tooth_contact(
    bodies: tuple[GearBody, GearBody], stand: PairRotation, tooth: int, half_width: float, displaced: Displaced | None
) -> ToothContact | None:
    """Searches a tooth pair at this stand; None where its flanks are out of reach.

    half_width: of the window [mm of profile arc].
    displaced: displacements of the flanks before the search.

    Raises SearchError.
    """
    pinion = bodies[Member.PINION]
    assert pinion.traction is not None
    facets = np.flatnonzero(facets_in_window(pinion, stand, tooth, half_width))
    if len(facets) == 0:
        return None
    first, second = placed_flanks(bodies, stand, tooth)
    if displaced is not None:
        first, second = (_moved(flank, u) for flank, u in zip((first, second), displaced))
    module = pinion.gear.normal_module
    pairing = pair_surfaces(first, second, GAP * module, PENETRATION * module, facets)
    if len(pairing.weight) == 0:
        return None
    operator = contact_operator(pairing, first, second, pinion.traction.stabiliser, tangent_frames(first.normals))
    operator = operator.pressing_along(pressure_normals(operator, pinion, second, stand, tooth))
    if displaced is not None:
        operator = operator.before(_jump(pairing, first, second, displaced))
    return ToothContact(tooth, operator, pairing, displaced)


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
