"""What friction remembers between two positions of a gear pair: where the gears stood and how their flanks lay."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.data import Floats
from solver.equilibrium import Equilibrium
from solver.gear_contact import GearContact
from solver.gear_model import GearModel
from solver.kinematics import Stand, nominal_slip

NEAR_PITCH = 0.3  # [module of ξ] within which the direction of slip is not taken for granted


@dataclass(frozen=True)
class Memory:
    """What friction remembers of a position: where the gears stood, and the displacements of their flanks.

    fields: per gear (teeth, n, d) in the gear's own frame [mm], for the tooth pairs `teeth`.
    """

    stand: Stand
    teeth: tuple[int, ...]
    fields: tuple[Floats, Floats]


def relative_velocity(contact: GearContact) -> Floats:
    """(n, d) velocity of pinion over wheel per radian of pinion rotation, local frames."""
    return contact.spins[0] - contact.spins[1] / contact.stand.pair.ratio


def known_heading(contact: GearContact, rate: Floats) -> Floats:
    """(q, d−1) direction of slip where the slice is far enough from the pitch point to know it, else zero."""
    shape = contact.operator.shape
    v = shape @ rate[:, 1:]
    size = np.linalg.norm(v, axis=1, keepdims=True)
    far = np.abs(shape @ contact.ξ)[:, None] > NEAR_PITCH * contact.stand.pair.pinion.normal_module
    return np.where(far & (size > 0.0), v / np.where(size > 0.0, size, 1.0), 0.0)


def slice_roll(contact: GearContact, stand: Stand) -> Floats:
    """Roll distance of each node's slice when the gears stood at `stand`."""
    return stand.pair.roll_distance(stand.angle, contact.tooth, contact.bodies[0].z[contact.node])


def slipped(
    model: GearModel, contact: GearContact, before: Memory, rate: Floats, ξ_before: Floats, span: float
) -> Floats:
    """(n, d−1) slip since `before` [mm] but for the present displacement: nominal slip, change of the free rotations,
    and the elastic part remembered at the material points that now face each other."""
    slip = nominal_slip(rate[:, 1:], contact.ξ, ξ_before, growing_slip(contact), model.pair.ratio, span)
    for gear in (0, 1):
        slip = slip + contact.spins[gear][:, 1:] * (contact.stand.extra[gear] - before.stand.extra[gear])
    return slip - remembered_jump(contact, before)[:, 1:]


def growing_slip(contact: GearContact) -> Floats:
    """(n, d−1) unit tangent along which slip grows with ξ: contact travels along the transverse normal n_t, and the
    pinion turns over the wheel about the pitch point, so this is e_z × n_t, at the pitch point too."""
    n = contact.operator.frames[:, 0]
    along = np.zeros_like(n)
    along[:, 0], along[:, 1] = -n[:, 1], n[:, 0]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return np.einsum("jia,ja->ji", contact.operator.frames, along)[:, 1:]


def remembered_jump(contact: GearContact, before: Memory) -> Floats:
    """(n, d) local: w of the memory, turned with the wheel to the present."""
    d = contact.d
    R1, R2 = (before.stand.rotation(gear, d) for gear in (0, 1))
    onward = contact.stand.rotation(1, d) @ R2.T
    parts = []
    for t in contact.teeth:
        place = before.teeth.index(t.tooth)
        w = t.operator.jump1 @ before.fields[0][place] @ R1.T - t.operator.jump2 @ before.fields[1][place] @ R2.T
        parts.append(w @ onward.T)
    return np.einsum("jia,ja->ji", contact.operator.frames, np.concatenate(parts))


def remembered(model: GearModel, contact: GearContact, found: Equilibrium) -> Memory:
    """The memory of a converged state: displacement of all flank nodes of all teeth."""
    d, k = contact.d, found.force.shape[1]
    ends = np.cumsum([len(t.operator.nodes) for t in contact.teeth])[:-1]
    forces = np.split(found.force, ends)
    fields = []
    for gear, body in enumerate(model.bodies):
        n = len(body.flank.points)
        everywhere = np.concatenate([body.rows(t, np.arange(n)) for t in model.teeth])
        pushed = [-E.forces(f) for E, f in zip(contact.jump_maps(gear, k), forces)]
        u = body.chain.apply(contact.rows(gear)[0], np.concatenate(pushed), everywhere)
        fields.append(u.reshape(len(model.teeth), n, d))
    place = np.searchsorted(model.teeth, contact.tooth)
    fields[0][place, contact.node] += contact.operator.flux(
        _with_all_components(found.traction, d)
    ) @ contact.stand.rotation(0, d)
    stand = contact.stand.turned(model.load.on, float(found.motion[0]))
    return Memory(stand, model.teeth, (fields[0], fields[1]))


def _with_all_components(values: Floats, d: int) -> Floats:
    return np.hstack([values, np.zeros((len(values), d - values.shape[1]))])
