"""A position reused at another misalignment: the search and the compliance stay, gap and levers are new."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent.contact.newton.equilibrium import frictionless, normal_part
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.overlap_check import unsearched_overlaps
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.contact.tooth_contact import ToothContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.position_search import SharedPosition
from evolvent.gears.sweep.worn_position import search_holds
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

REACH = 7.5e-3
"""Largest change of the gap [modules] with which a search is used again. Transmission errors of Yang's pair at quick,
20 to 68 µm, are then at most 15 nm off those of a search of their own, and the tangent stiffness 0.15 %; with 0.012
modules 32 nm and 0.16 %."""


def misaligned_on(model: GearModel, shared: SharedPosition) -> SharedPosition | None:
    """A known position without friction, solved again with the wheel misaligned as in the model's pair.

    shared: of the same gears at another misalignment, searched on undeflected flanks.

    None where the flanks have moved so far, or the contact so near to the window's rim, that the position has to be
    searched, or where no solution is found.
    """
    geometry = shared.contact.geometry
    stand = replace(geometry.stand, pair=model.pair)
    if geometry.is_deflected or _farthest(geometry, stand) > REACH * model.pair.pinion.normal_module:
        return None
    teeth = tuple(_misaligned(geometry, tooth, stand) for tooth in geometry.teeth)
    contact = GearContact(replace(geometry, stand=stand, teeth=teeth), model.bodies)
    system = contact.system_with(shared.system.compliance, model.load.on, model.load.at(stand.angle))
    try:
        smooth = frictionless(normal_part(system), shared.smooth.traction[:, 0] > 0.0)
    except NotConverged:
        return None
    found = SharedPosition(contact, system, smooth, unsearched_overlaps(contact.geometry, model.teeth))
    return found if search_holds(model, found) else None


def _misaligned(geometry: ContactGeometry, tooth: ToothContact, stand: PairRotation) -> ToothContact:
    """A tooth pair with the gap that the wheel's motion to another stand leaves."""
    return replace(tooth, operator=tooth.operator.before(_moved(geometry, tooth, stand)))


def _farthest(geometry: ContactGeometry, stand: PairRotation) -> float:
    """Largest distance [mm] by which the gap changes."""
    normals = [t.operator.shape @ t.operator.frames[:, 0] for t in geometry.teeth]
    moved = [_moved(geometry, t, stand) for t in geometry.teeth]
    return max(float(np.abs(np.einsum("qa,qa->q", n, u)).max()) for n, u in zip(normals, moved))


def _moved(geometry: ContactGeometry, tooth: ToothContact, stand: PairRotation) -> Floats:
    """Displacement (q, d) [mm] of the wheel at the points of a tooth pair, as it moves to another stand."""
    wheel, d = geometry.bodies[Member.WHEEL], geometry.d
    points, pairs = wheel.flank.points, tooth.pairing
    before, after = (
        points @ each.rotation(Member.WHEEL, d, tooth.tooth).T + each.centre(Member.WHEEL, d)
        for each in (geometry.stand, stand)
    )
    return np.asarray(wheel.flank.evaluate(after - before, pairs.facet2, pairs.xi2[:, None])[0][:, 0])
