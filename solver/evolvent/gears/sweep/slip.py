"""The slip between the flanks of a gear pair over the step from the previous position, and the work of friction in it.
"""

from __future__ import annotations

import math

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.gears.contact.contact_geometry import ContactGeometry, relative_velocity
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.kinematics import nominal_slip
from evolvent.gears.sweep.friction_history import FrictionHistory, PreviousJump, previous_friction
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

NEAR_PITCH = 0.3  # [module of ξ] within which the direction of slip is not taken as known


def slip_increment(geometry: ContactGeometry, before: PreviousJump, span: float) -> Floats:
    """Slip (q, d−1) [mm] at the points since the previous position, Δφ = span [rad] before, without the part of the
    present elastic displacements: nominal slip, change of the free rotations, and minus the elastic jump of then. The
    nominal slip jumps at the pitch point, so that it is not interpolated."""
    pair, shape = geometry.stand.pair, geometry.operator.shape
    rate, along = shape @ relative_velocity(geometry)[:, 1:], shape @ slip_growth_direction(geometry)
    ξ = shape @ geometry.roll_distance
    slip = nominal_slip(rate, ξ, ξ - pair.pinion.base_radius * span, along, pair.ratio, span)
    return slip + shape @ _beyond_nominal(geometry, before)


def work_beyond_nominal(
    contact: GearContact, found: Equilibrium, before: PreviousJump, history: FrictionHistory
) -> float:
    """Work that friction takes over the step since the previous position beyond that in the nominal sliding, where the
    free rotations, modes and elastic displacements change the slip [N·mm; per mm of width in 2D].

    By the trapezoidal rule: the mean of the tangential forces of both positions, at the nodes of the present contact,
    times this slip. found: the equilibrium, in which the pinion's trace is e_1 + F. before, history: the friction
    history, interpolated to the contact and as it was.
    """
    geometry, operator = contact.geometry, contact.operator
    flux = np.einsum("jia,ja->ji", operator.frames, operator.projected(operator.flux(found.traction)))
    slip = (found.jump + flux)[:, 1:] + _beyond_nominal(geometry, before)
    return 0.5 * float(np.sum((found.force[:, 1:] + previous_friction(geometry, history)) * slip))


def _beyond_nominal(geometry: ContactGeometry, before: PreviousJump) -> Floats:
    """Change (n, d−1) of the free rotations up to the search, and minus the previous elastic jump [mm]."""
    turned = [geometry.stand.beyond_nominal[gear] - before.stand.beyond_nominal[gear] for gear in Member]
    return sum(spin[:, 1:] * angle for spin, angle in zip(geometry.spins, turned)) - before.jump[:, 1:]


def slip_direction(geometry: ContactGeometry, span: float) -> Floats:
    """Unit tangent (q, d−1) of the nominal slip where the slice is far enough from the pitch point to know it, else
    zero. span: Δφ of the step [rad], negative where the wheel drives."""
    module = geometry.stand.pair.pinion.normal_module
    far = np.abs(geometry.operator.shape @ geometry.roll_distance)[:, None] > NEAR_PITCH * module
    return np.where(far, nominal_direction(geometry, span), 0.0)


def nominal_direction(geometry: ContactGeometry, span: float) -> Floats:
    """Unit tangent (q, d−1) of the nominal slip in a step Δφ = span [rad], zero at the pitch point."""
    v = math.copysign(1.0, span) * (geometry.operator.shape @ relative_velocity(geometry)[:, 1:])
    size = np.linalg.norm(v, axis=1, keepdims=True)
    return np.where(size > 0.0, v / np.where(size > 0.0, size, 1.0), 0.0)


def slip_growth_direction(geometry: ContactGeometry) -> Floats:
    """Unit tangent (n, d−1) in which the nominal slip grows with ξ: contact travels along the transverse normal n_t,
    and the pinion turns over the wheel about the pitch point, so this is e_z × n_t, at the pitch point too."""
    n = geometry.operator.frames[:, 0]
    along = np.zeros_like(n)
    along[:, 0], along[:, 1] = -n[:, 1], n[:, 0]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return np.einsum("jia,ja->ji", geometry.operator.frames, along)[:, 1:]
