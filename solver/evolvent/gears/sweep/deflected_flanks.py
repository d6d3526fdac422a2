"""A position on its flanks as they have deflected: searched again, along normals and with levers that deflection has
tilted and moved.

Small strain takes both before deflection, and one search a position is enough. Where teeth give way by hundredths of a
module, or friction takes nearly all of the input, forces along such normals take or give a hundredth of the power that
goes through the mesh; along those of the deflected flanks energy is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, frictionless, normal_part
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.overlap_check import overlap_outside, unsearched_overlaps
from evolvent.gears.contact.pair_contact import GearContact, gear_contact
from evolvent.gears.contact.tangent_stiffness import tangent_stiffness
from evolvent.gears.contact.tooth_contact import Displaced
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.friction_history import FrictionHistory, previous_jumps
from evolvent.gears.sweep.frictional_position import frictional_equilibrium
from evolvent.gears.sweep.position_search import free_rotation, free_shift
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

CONVERGED = 5e-4
"""Modules by which the free rotation moves the flanks after the last search: the next one would move them by a third of
it or less."""
ROUNDS = 12


@dataclass(frozen=True)
class DeflectedEquilibrium:
    """Equilibrium of flanks that were searched as it deflects them.

    contact: of the deflected flanks.
    equilibrium: with the iterations of all searches.
    stiffness: of the frictionless mesh along these flanks' normals, as in PositionResult.
    """

    contact: GearContact
    equilibrium: Equilibrium
    stiffness: float


def deflected_equilibrium(
    model: GearModel, contact: GearContact, equilibrium: Equilibrium, friction: float,
    history: FrictionHistory | None, span: float,
) -> DeflectedEquilibrium:
    """Searches and solves in turn until the search moves the flanks no more.

    contact, equilibrium: of undeflected flanks.
    history: of friction, None without it.
    span: Δφ since then [rad].

    Raises NotConverged, SearchError.
    """
    for _ in range(ROUNDS):
        patch, spent = ContactPatch.of(contact.geometry, equilibrium.traction[:, 0]), equilibrium.iterations
        contact = deflected_contact(model, contact, equilibrium)
        geometry = contact.geometry
        equilibrium, stiffness = _equilibrium(model, contact, patch, friction, history, span)
        equilibrium = replace(equilibrium, iterations=spent + equilibrium.iterations)
        if geometry.reaches_rim(equilibrium.traction[:, 0] > 0.0):
            contact = _with_window(contact, 1.5 * geometry.half_width)
        elif abs(free_shift(model, equilibrium)) <= CONVERGED * model.pair.pinion.normal_module:
            places = unsearched_overlaps(geometry, model.teeth)
            if overlap_outside(contact, places, equilibrium.force, free_rotation(model, equilibrium)) == 0.0:
                return DeflectedEquilibrium(contact, equilibrium, stiffness)
            contact = _with_window(contact, np.inf)
    raise NotConverged(
        f"pinion at {np.degrees(contact.stand.angle):.3f}°, μ = {friction}: wanted deflected flanks that move by less "
        f"than {1e3 * CONVERGED * model.pair.pinion.normal_module:.2f} µm within their window, found them moved by "
        f"{1e3 * abs(free_shift(model, equilibrium)):.2f} µm after {ROUNDS} searches; lower the torque"
    )


def deflected_contact(model: GearModel, contact: GearContact, equilibrium: Equilibrium) -> GearContact:
    """The contact between the flanks as an equilibrium has deflected and turned them. Raises NotConverged."""
    teeth = tuple(t.tooth for t in contact.geometry.teeth)
    if np.isinf(contact.geometry.half_width):  # tooth pairs may touch that the window had no points of
        teeth = tuple(model.teeth)
    displaced = _displaced_flanks(contact.geometry, equilibrium, teeth)
    stand = contact.stand.turned(model.load.on, float(equilibrium.motion[0]))
    where = f"pinion at {np.degrees(stand.angle):.3f}°: wanted deflected flanks that face each other, found"
    try:
        deflected = gear_contact(model.bodies, stand, list(displaced), contact.geometry.half_width, displaced)
    except SearchError as error:
        raise NotConverged(f"{where} {error}; or lower the torque") from error
    if not deflected.geometry.teeth:
        raise NotConverged(f"{where} none within reach; lower the torque")
    return deflected


def _with_window(contact: GearContact, half_width: float) -> GearContact:
    return replace(contact, geometry=replace(contact.geometry, half_width=half_width))


def _displaced_flanks(
    geometry: ContactGeometry, equilibrium: Equilibrium, teeth: Sequence[int]
) -> dict[int, Displaced]:
    """Tooth pair -> displacements of its whole flanks, the pinion's with the contact's flux (the extended trace of
    contact_operator.py)."""
    loads = [(geometry.rows(gear)[0], geometry.flank_forces(gear, equilibrium.force)) for gear in Member]

    def displacements(gear: Member, tooth: int) -> Floats:
        body, (rows, forces) = geometry.bodies[gear], loads[gear]
        u = body.chain.apply(rows, forces, body.rows(tooth, np.arange(len(body.flank.points))))
        return np.asarray(u @ geometry.stand.rotation(gear, geometry.d).T)

    pinion, wheel = Member.PINION, Member.WHEEL
    return {tooth: (displacements(pinion, tooth), displacements(wheel, tooth)) for tooth in teeth}


def _equilibrium(
    model: GearModel, contact: GearContact, patch: ContactPatch, friction: float, history: FrictionHistory | None,
    span: float,
) -> tuple[Equilibrium, float]:
    """Equilibrium of these flanks, started from a contact patch, and the stiffness without friction. Raises
    NotConverged."""
    geometry = contact.geometry
    torque = model.load.at(contact.stand.angle)
    system = contact.system(model.load.on, torque, normal_only=history is None)
    normal = normal_part(system)
    smooth = frictionless(normal, patch.at(geometry))
    stiffness = tangent_stiffness(normal, smooth)
    if history is None:
        return smooth, stiffness
    (before,) = previous_jumps(geometry, [history])
    rough = frictional_equilibrium(geometry, system, friction, smooth, before, span)
    return replace(rough, iterations=smooth.iterations + rough.iterations), stiffness
