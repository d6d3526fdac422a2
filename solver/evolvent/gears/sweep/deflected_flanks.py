"""A position on its flanks as they have deflected: searched again, along normals and with levers that deflection has
tilted and moved.

Small strain takes both before deflection, and one search a position is enough. Where teeth give way by hundredths of a
module, or friction takes nearly all of the input, forces along such normals take or give a hundredth of the power that
goes through the mesh; along those of the deflected flanks energy is kept.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, frictionless, normal_part
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tangent_stiffness import tangent_stiffness
from evolvent.contact.search.pairing import SearchError
from evolvent.gears.contact.overlap_check import overlap_outside, unwatched
from evolvent.gears.contact.pair_contact import GearContact, gear_contact
from evolvent.gears.contact.tooth_contact import Displaced
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.friction_history import Footprint, Memory, recalled
from evolvent.gears.sweep.position import free_rotation, free_shift, rubbing
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

SETTLED = 5e-4
"""Modules by which the free rotation moves the flanks after the last search: the next one would move them by a third of
it or less."""
ROUNDS = 12


@dataclass(frozen=True)
class Settled:
    """The contact of flanks that deflect as its equilibrium says, and that equilibrium, whose iterations are those of
    all searches; stiffness: of the frictionless mesh as in PositionResult, along these flanks' normals."""

    contact: GearContact
    found: Equilibrium
    stiffness: float


def settled(
    model: GearModel, contact: GearContact, found: Equilibrium, friction: float, before: Memory | None, span: float
) -> Settled:
    """From the equilibrium of undeflected flanks. before: what friction remembers, None without; span: Δφ [rad] since
    then.

    Raises NotConverged.
    """
    for _ in range(ROUNDS):
        pressed, spent = Footprint.of(contact, found.traction[:, 0]), found.iterations
        contact = deflected_contact(model, contact, found)
        found, stiffness = _equilibrium(model, contact, pressed, friction, before, span)
        found = replace(found, iterations=spent + found.iterations)
        if contact.reaches_rim(found.traction[:, 0] > 0.0):
            contact = replace(contact, half_width=1.5 * contact.half_width)
        elif abs(free_shift(model, found)) <= SETTLED * model.pair.pinion.normal_module:
            places = unwatched(contact, model.teeth)
            if overlap_outside(contact, places, found.force, free_rotation(model, found)) == 0.0:
                return Settled(contact, found, stiffness)
            contact = replace(contact, half_width=np.inf)
    raise NotConverged(
        f"pinion at {np.degrees(contact.stand.angle):.3f}°, μ = {friction}: wanted deflected flanks that move by less "
        f"than {1e3 * SETTLED * model.pair.pinion.normal_module:.2f} µm within their window, found them moved by "
        f"{1e3 * abs(free_shift(model, found)):.2f} µm after {ROUNDS} searches; lower the torque"
    )


def deflected_contact(model: GearModel, contact: GearContact, found: Equilibrium) -> GearContact:
    """The contact between the flanks as an equilibrium has deflected and turned them. Raises NotConverged."""
    pushed = contact.pushed(Member.PINION, found.force), contact.pushed(Member.WHEEL, found.force)
    displaced = {t.tooth: _displaced(contact, pushed, t.tooth) for t in contact.teeth}
    stand = contact.stand.turned(model.load.on, float(found.motion[0]))
    where = f"pinion at {np.degrees(stand.angle):.3f}°: wanted deflected flanks that face each other, found"
    try:
        again = gear_contact(model.bodies, stand, list(displaced), contact.half_width, displaced)
    except SearchError as error:
        raise NotConverged(f"{where} {error}; or lower the torque") from error
    if not again.teeth:
        raise NotConverged(f"{where} none within reach; lower the torque")
    return again


def _displaced(contact: GearContact, pushed: tuple[Floats, Floats], tooth: int) -> Displaced:
    """The whole flanks of a tooth pair, the pinion's as contact sees it (the extended trace of contact_operator.py)."""
    found = []
    for gear, body in zip(Member, contact.bodies):
        every = body.rows(tooth, np.arange(len(body.flank.points)))
        u = body.chain.apply(contact.rows(gear)[0], pushed[gear], every)
        found.append(u @ contact.stand.rotation(gear, contact.d).T)
    return found[0], found[1]


def _equilibrium(
    model: GearModel, contact: GearContact, pressed: Footprint, friction: float, before: Memory | None, span: float
) -> tuple[Equilibrium, float]:
    """And the stiffness of the frictionless state."""
    system = contact.system(model.load.on, model.load.torque, normal_only=before is None)
    normal = normal_part(system)
    smooth = frictionless(normal, pressed.at(contact))
    stiffness = tangent_stiffness(normal, smooth)
    if before is None:
        return smooth, stiffness
    found = rubbing(model, contact, system, friction, smooth, recalled(contact, [before])[0], span)
    return replace(found, iterations=smooth.iterations + found.iterations), stiffness
