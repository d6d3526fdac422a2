"""What friction remembers between two positions of a gear pair: where the gears stood and how their flanks lay."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import Stand, nominal_slip, turn
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member

SLICE_WEIGHT = 0.5  # of distances along ξ beside those across the contact line; 0.02 to 0.5 foretell equally well
NEAR_PITCH = 0.3  # [module of ξ] within which the direction of slip is not taken for granted
NO_LOAD = 1e-9  # of the largest force: what Newton's method may leave on a tooth that stands free


@dataclass(frozen=True)
class Memory:
    """What friction remembers of a position: where the gears stood, and what their flanks carried. The displacements
    follow from it at whatever nodes the next position asks for.

    rows: per gear (m, 2) of its chain. forces: per gear (m, d) on these rows in the gear's own frame [N]. flux: (m, d)
    F at the pinion's rows in its frame [mm].
    """

    stand: Stand
    rows: tuple[Ints, Ints]
    forces: tuple[Floats, Floats]
    flux: Floats

    def earlier(self, pitches: int) -> Memory:
        """The same so many base pitches earlier, where other teeth of both gears stand as these do. Of teeth without
        load nothing is kept: some stand where the contact does not look at that time."""
        pair, d, back = self.stand.pair, self.flux.shape[1], 2.0 * np.pi * pitches
        turns, step = (-back / pair.pinion.z, back / pair.wheel.z), np.array([pitches, 0])
        pinion, wheel = (_of_loaded_teeth(*own) for own in zip(self.rows, self.forces))
        return Memory(
            replace(self.stand, angle=self.stand.angle + turns[0]),
            (self.rows[0][pinion] + step, self.rows[1][wheel] - step),  # the wheel's teeth are counted the other way
            (self.forces[0][pinion] @ turn(turns[0], d), self.forces[1][wheel] @ turn(turns[1], d)),
            self.flux[pinion] @ turn(turns[0], d),
        )


def _of_loaded_teeth(rows: Ints, forces: Floats) -> np.ndarray:
    """(m,) bool: which rows belong to a tooth that carries load."""
    size = np.abs(forces).max(axis=1)
    return np.isin(rows[:, 0], rows[size > NO_LOAD * size.max(), 0])


@dataclass(frozen=True)
class Past:
    """What a memory tells the nodes of the present contact: where the gears stood, and w (n, d) there, local [mm]."""

    stand: Stand
    jump: Floats


@dataclass(frozen=True)
class Footprint:
    """Where the flanks were pressed at a position. All teeth are alike, so it foretells the next position's.

    places: (q, 2) roll distance ξ and signed distance from the contact line [mm] of its points. pressed: (q,) bool.
    """

    places: Floats
    pressed: np.ndarray

    @staticmethod
    def of(contact: GearContact, pressure: Floats) -> Footprint:
        """From the pressures (q,) at the contact's points."""
        return Footprint(_places(contact), pressure > 0.0)

    def at(self, contact: GearContact) -> np.ndarray:
        """(q,) bool: which points of another contact are nearest to a pressed one."""
        return np.asarray(self.pressed[cKDTree(self.places).query(_places(contact))[1]])


def _places(contact: GearContact) -> Floats:
    ξ = contact.operator.shape @ contact.ξ
    return np.column_stack([SLICE_WEIGHT * ξ, contact.across])


def known_heading(contact: GearContact, rate: Floats) -> Floats:
    """(q, d−1) direction of slip where the slice is far enough from the pitch point to know it, else zero."""
    shape = contact.operator.shape
    v = shape @ rate[:, 1:]
    size = np.linalg.norm(v, axis=1, keepdims=True)
    far = np.abs(shape @ contact.ξ)[:, None] > NEAR_PITCH * contact.stand.pair.pinion.normal_module
    return np.where(far & (size > 0.0), v / np.where(size > 0.0, size, 1.0), 0.0)


def slipped(
    model: GearModel, contact: GearContact, before: Past, rate: Floats, ξ_before: Floats, span: float
) -> Floats:
    """(n, d−1) slip since the past [mm] but for the present displacement: nominal slip, change of the free rotations,
    and the elastic part remembered at the material points that now face each other."""
    slip = nominal_slip(rate[:, 1:], contact.ξ, ξ_before, growing_slip(contact), model.pair.ratio, span)
    for gear in Member:
        slip = slip + contact.spins[gear][:, 1:] * (contact.stand.extra[gear] - before.stand.extra[gear])
    return slip - before.jump[:, 1:]


def growing_slip(contact: GearContact) -> Floats:
    """(n, d−1) unit tangent along which slip grows with ξ: contact travels along the transverse normal n_t, and the
    pinion turns over the wheel about the pitch point, so this is e_z × n_t, at the pitch point too."""
    n = contact.operator.frames[:, 0]
    along = np.zeros_like(n)
    along[:, 0], along[:, 1] = -n[:, 1], n[:, 0]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return np.einsum("jia,ja->ji", contact.operator.frames, along)[:, 1:]


def recalled(contact: GearContact, memories: Sequence[Memory]) -> list[Past]:
    """What memories of one position, at several friction coefficients, tell the present contact."""
    if not memories:
        return []
    if not _same_rows(memories):  # deflected flanks are searched for each coefficient
        return [past for memory in memories for past in recalled(contact, [memory])]
    u1, u2 = (_traces(contact, memories, gear) for gear in Member)
    return [Past(memory.stand, _past_jump(contact, memory.stand, *u)) for memory, *u in zip(memories, u1, u2)]


def _same_rows(memories: Sequence[Memory]) -> bool:
    first, *others = (memory.rows for memory in memories)
    return all(np.array_equal(own, rows) for other in others for own, rows in zip(other, first))


def _past_jump(contact: GearContact, before: Stand, u1: Floats, u2: Floats) -> Floats:
    """(n, d) local: w = R_1 u_1 − R_2 Πu_2 of the past, turned with the wheel to the present. The velocity of points on
    deflected flanks tells that displacements turn with their gears: there each has been turned with its own."""
    d = contact.d
    R1, R2 = (contact.stand.rotation(gear, d) for gear in Member)
    if not contact.is_deflected:
        R1 = R2 @ before.rotation(Member.WHEEL, d).T @ before.rotation(Member.PINION, d)
    parts = zip(contact.teeth, contact.rows(Member.PINION)[1], contact.rows(Member.WHEEL)[1])
    w = [u1[own] @ R1.T - t.projection @ u2[other] @ R2.T for t, own, other in parts]
    return np.einsum("jia,ja->ji", contact.operator.frames, np.concatenate(w))


def _traces(contact: GearContact, memories: Sequence[Memory], gear: Member) -> Floats:
    """Displacements (memories, m, d) that the rows of the contact had then."""
    before, rows = memories[0].rows, contact.rows(gear)[0]
    forces = np.stack([memory.forces[gear] for memory in memories])
    u = contact.bodies[gear].chain.apply(before[gear], forces, rows)
    if gear == Member.PINION:
        both = _row_keys(before[0]), _row_keys(rows)
        _, then, now = np.intersect1d(*both, assume_unique=True, return_indices=True)
        u[:, now] += np.stack([memory.flux for memory in memories])[:, then]
    return u


def _row_keys(rows: Ints) -> Ints:
    """One number for each row (tooth, node)."""
    return rows[:, 0] * 2**32 + rows[:, 1]


def remembered(model: GearModel, contact: GearContact, found: Equilibrium) -> Memory:
    """The memory of a converged state."""
    d = contact.d
    pushed = contact.pushed(Member.PINION, found.force), contact.pushed(Member.WHEEL, found.force)
    flux = contact.operator.flux(_with_all_components(found.traction, d)) @ contact.stand.rotation(Member.PINION, d)
    stand = contact.stand.turned(model.load.on, float(found.motion[0]))
    return Memory(stand, (contact.rows(Member.PINION)[0], contact.rows(Member.WHEEL)[0]), pushed, flux)


def _with_all_components(values: Floats, d: int) -> Floats:
    return np.hstack([values, np.zeros((len(values), d - values.shape[1]))])
