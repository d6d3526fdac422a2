"""The contact of a gear pair at one position: paired points of the flanks, and the gap with their wear.

Only the nodes of a window about each contact line take part. A solution that touches the window's rim is refused by
`ContactGeometry.reaches_rim`, and the caller widens the window; contact outside of it is found by `overlap_check`. The
whole flanks can be searched instead, to show that it changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.contact_operator import ContactOperator
from evolvent.fem.parallel.cores import Threads
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.tooth_contact import Displaced, tooth_contact
from evolvent.gears.kinematics import PairRotation
from evolvent_meshes.gears.member import Member

TOLERANCE = 1e-8
"""Residual force of a position, over its load. Transmission errors of Yang's pair at standard are then within 1e-9 of
those at 1e-12, losses within 5e-9."""
DEEPEST = 0.5
"""Overlap of undeflected flanks [normal modules] from which on teeth deflect too much for small strain. The search
looks deeper (`tooth_contact.PENETRATION`), so that no point is missing."""


@dataclass(frozen=True)
class GearContact:
    """The contact of worn flanks.

    geometry: where the flanks face each other, without wear.
    bodies: pinion, which carries the pressure, and wheel as they are worn; empty while it is sent between ranks.
    """

    geometry: ContactGeometry
    bodies: tuple[GearBody, ...]

    @property
    def stand(self) -> PairRotation:
        """Angular position of the gears in the search."""
        return self.geometry.stand

    def with_wear(self, bodies: tuple[GearBody, GearBody]) -> GearContact:
        """Contact of the same gears at the same position with other wear: the geometry stays."""
        return replace(self, bodies=bodies)

    def without_bodies(self) -> GearContact:
        """Contact without the gears, which every rank has, to be sent between ranks."""
        return GearContact(replace(self.geometry, bodies=()), ())

    def with_bodies(self, bodies: tuple[GearBody, GearBody]) -> GearContact:
        """Contact with the gears again that `without_bodies` left out."""
        return GearContact(replace(self.geometry, bodies=_without_wear(bodies)), bodies)

    @cached_property
    def operator(self) -> ContactOperator:
        """Contact of all tooth pairs, the gap opened by the wear of both flanks."""
        if all(body.worn is None for body in self.bodies):
            return self.geometry.operator
        hats = self.geometry.flank_hats
        depth = np.sum([ψ @ body.worn for ψ, body in zip(hats, self.bodies) if body.worn is not None], axis=0)
        return self.geometry.operator.worn(depth, np.zeros_like(depth))

    def system(
        self, loaded: Member, torque: float, normal_only: bool = False, threads: Threads = nullcontext
    ) -> CondensedSystem:
        """Condensed system with one free rotation: of the `loaded` gear, under `torque` [N·mm; per mm of width in 2D].

        normal_only: without friction only the normal components are condensed, a ninth of the work. threads: context in
        which each gear's compliance is assembled.
        """
        compliance = self.geometry.compliance(1 if normal_only else self.geometry.d, threads)
        return self.system_with(compliance, loaded, torque)

    def system_with(self, compliance: JumpCompliance, loaded: Member, torque: float) -> CondensedSystem:
        """Condensed system with a known compliance and one free rotation: of the `loaded` gear, under `torque` [N·mm;
        per mm of width in 2D]."""
        k = compliance.k
        n = self.operator.n * k
        motion = self.geometry.spins[loaded][:, :k].reshape(n, 1)
        lever = np.array([self.bodies[loaded].gear.base_radius])
        load = np.array([torque])
        return CondensedSystem(
            self.operator, compliance, motion, np.zeros(n), load, np.zeros((1, 1)), lever, tolerance=TOLERANCE
        )

    @property
    def overlap(self) -> float:
        """Depth to which undeflected flanks overlap [normal modules]."""
        return -float(self.operator.gap.min()) / self.stand.pair.pinion.normal_module


def facing_flanks(
    bodies: tuple[GearBody, GearBody], stand: PairRotation, teeth: list[int], half_width: float, *, apart: str,
    remedy: str,
) -> GearContact:
    """The contact at this stand; bodies to half_width as in `gear_contact`. Flanks that are apart, or overlap too deep
    for the search and for small strain, are refused.

    apart: why flanks may be apart, and what to do then.
    remedy: what to do where they overlap too deep.

    Raises NotConverged, SearchError.
    """
    at = f"pinion at {np.degrees(stand.angle):.3f}°: wanted"
    too_deep = f"{at} teeth that deflect by less than half a module, found more, too much for small strain: {remedy}"
    conjugate = stand.transmission_error * np.cos(stand.pair.pinion.base_helix_angle)  # overlap without modifications
    if conjugate > DEEPEST * stand.pair.pinion.normal_module:
        raise NotConverged(too_deep)
    contact = gear_contact(bodies, stand, teeth, half_width)
    if not contact.geometry.teeth:
        raise NotConverged(f"{at} flanks within reach of each other, found none; {apart}")
    if contact.overlap > DEEPEST:
        raise NotConverged(too_deep)
    return contact


def gear_contact(
    bodies: tuple[GearBody, GearBody], stand: PairRotation, teeth: list[int], half_width: float,
    displaced: Mapping[int, Displaced] = MappingProxyType({}),
) -> GearContact:
    """Searches all tooth pairs that may touch at this stand.

    half_width: of the window [mm of profile arc], infinite where the whole flanks are searched.
    displaced: tooth pair -> displacements of its flanks, where it is searched as it has deflected.

    Raises SearchError.
    """
    contacts = [tooth_contact(bodies, stand, tooth, half_width, displaced.get(tooth)) for tooth in teeth]
    facing = tuple(contact for contact in contacts if contact is not None)
    return GearContact(ContactGeometry(_without_wear(bodies), stand, facing, half_width), bodies)


def _without_wear(bodies: tuple[GearBody, GearBody]) -> tuple[GearBody, ...]:
    return tuple(replace(body, worn=None) for body in bodies)
