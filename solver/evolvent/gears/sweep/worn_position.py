"""A position reused after its flanks have worn on: the search and the compliance stay, the gap is new."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium, frictionless, normal_part
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.contact.overlap_check import NEARLY, overlap_outside
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.position_search import SharedPosition, free_rotation, free_shift
from evolvent_meshes.arrays import Bools

STALE = NEARLY
"""Largest displacement of the flanks [modules] since the search of a position that is reused: He's pair worn by 6 µm in
20 blocks has then the depths of one that is always searched within 9e-4 (7e-4 at 2e-3) of its volume, and transmission
errors within 3 nm of 5 µm; 24 searches instead of 400."""


def worn_on(model: GearModel, shared: SharedPosition, pressed: Bools | None = None) -> SharedPosition | None:
    """A known position, solved again with the present wear of the model's flanks and under its present torque.

    pressed: (q,) bool, points to start from, by default those that were pressed before.

    None where the gears have moved so far, or the contact so near to the window's rim, that the position has to be
    searched again, or where no solution is found.
    """
    contact = shared.contact.with_wear(model.bodies)
    torque = model.load.at(contact.stand.angle)
    system = replace(shared.system, operator=contact.operator, load=np.array([torque]))
    smooth = _first_solution(normal_part(system), [pressed, shared.smooth.traction[:, 0] > 0.0])
    if smooth is None:
        return None
    found = SharedPosition(contact, system, smooth, shared.unsearched)
    return found if search_holds(model, found) else None


def search_holds(model: GearModel, found: SharedPosition) -> bool:
    """Whether a position solved on an earlier search needs no other one: the gears have moved little since, the contact
    keeps off the window's rim, and no flanks overlap outside it."""
    contact, smooth = found.contact, found.smooth
    near = abs(free_shift(model, smooth)) <= STALE * model.pair.pinion.normal_module
    if not near or contact.geometry.reaches_rim(smooth.traction[:, 0] > 0.0):
        return False
    return overlap_outside(contact, found.unsearched, smooth.force, free_rotation(model, smooth)) == 0.0


def _first_solution(system: CondensedSystem, starts: Sequence[Bools | None]) -> Equilibrium | None:
    """Equilibrium from the first of the starts, (q,) bool or None, that leads to one; None where none does."""
    for start in (start for start in starts if start is not None):
        try:
            return frictionless(system, start if start.any() else None)
        except NotConverged:
            continue
    return None
