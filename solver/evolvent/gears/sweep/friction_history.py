"""The friction history of a gear pair: the last position's state, interpolated to the present contact nodes.

Coulomb friction depends on the slip since the last position, and so on the elastic jump between the flanks there. It is
kept as forces: the displacements of any flank nodes follow from them by the compliance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium, with_components
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.contact_patch import FrictionPattern
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn

NO_LOAD = 1e-9  # of the largest force: what Newton's method may leave on a tooth without contact


@dataclass(frozen=True)
class FrictionHistory:
    """The state of a position that friction at the next one depends on.

    stand: where the gears stood.
    rows: per gear (m, 2), rows (tooth, node) of its compliance.
    forces: per gear (m, d), contact forces on these rows in the gear's own frame [N; per mm of width in 2D].
    flux: (m, d), F at the pinion's rows in its own frame [mm].
    pattern: friction at the points, from which the next position starts; None where it was read from a file.
    """

    stand: PairRotation
    rows: tuple[Ints, Ints]
    forces: tuple[Floats, Floats]
    flux: Floats
    pattern: FrictionPattern | None = None

    @staticmethod
    def of(model: GearModel, contact: GearContact, equilibrium: Equilibrium) -> FrictionHistory:
        """Friction history of a converged state."""
        geometry = contact.geometry
        pinion_rows, wheel_rows = (geometry.rows(gear)[0] for gear in Member)
        pinion, wheel = (geometry.flank_forces(gear, equilibrium.force) for gear in Member)
        traction = with_components(equilibrium.traction, geometry.d)
        flux = contact.operator.flux(traction) @ geometry.stand.rotation(Member.PINION, geometry.d)
        stand = geometry.stand.turned(model.load.on, float(equilibrium.motion[0]))
        pattern = FrictionPattern.of(geometry, traction)
        return FrictionHistory(stand, (pinion_rows, wheel_rows), (pinion, wheel), flux, pattern)

    def earlier(self, pitches: int) -> FrictionHistory:
        """Friction history moved back by whole angular pitches, where other teeth of both gears stand as these do;
        forward where their number is negative. Teeth without load are left out: the contact need not look at them at
        that time."""
        d, angle, step = self.flux.shape[1], 2.0 * np.pi * pitches, np.array([pitches, 0])
        turns = [-gear.sign * angle / self.stand.pair.gears[gear].z for gear in Member]
        loaded = [_on_loaded_teeth(rows, forces) for rows, forces in zip(self.rows, self.forces)]
        pinion_rows, wheel_rows = (self.rows[gear][loaded[gear]] + gear.sign * step for gear in Member)
        pinion, wheel = (self.forces[gear][loaded[gear]] @ turn(turns[gear], d) for gear in Member)
        flux = self.flux[loaded[Member.PINION]] @ turn(turns[Member.PINION], d)
        stand = replace(self.stand, angle=self.stand.angle + turns[Member.PINION])
        return FrictionHistory(stand, (pinion_rows, wheel_rows), (pinion, wheel), flux, self.pattern)


@dataclass(frozen=True)
class PreviousJump:
    """Friction history interpolated to the current contact nodes.

    stand: where the gears stood.
    jump: (n, d), elastic jump w there, in the local frames of now [mm].
    pattern: of friction there, None where it is not known.
    """

    stand: PairRotation
    jump: Floats
    pattern: FrictionPattern | None = None


def previous_jumps(
    geometry: ContactGeometry, histories: Sequence[FrictionHistory], vibration: Callable[[Member], Floats] | None = None
) -> list[PreviousJump]:
    """Interpolates histories of one position, at several friction coefficients, to the nodes of the present contact.

    vibration: displacements (m, d) of a gear's rows in the present contact, in its own frame, that were there beside
    those by the contact forces [mm].
    """
    if not histories:
        return []
    if not _have_equal_rows(histories):  # deflected flanks are searched for each coefficient
        return [jump for history in histories for jump in previous_jumps(geometry, [history], vibration)]
    u1, u2 = (_displacements(geometry, histories, gear) for gear in Member)
    if vibration is not None:
        u1, u2 = u1 + vibration(Member.PINION), u2 + vibration(Member.WHEEL)
    jumps = [_jump(geometry, each.stand, *u) for each, *u in zip(histories, u1, u2)]
    return [PreviousJump(each.stand, jump, each.pattern) for each, jump in zip(histories, jumps)]


def previous_friction(geometry: ContactGeometry, history: FrictionHistory) -> Floats:
    """Previous contact forces (n, d−1) on the nodes of the present contact [N; per mm of width in 2D], in the present
    tangent planes: where the normals have turned, they contain some of the normal forces, too. Forces on nodes that the
    present contact does not have are left out."""
    rows, parts = geometry.rows(Member.PINION)
    forces = np.zeros((len(rows), geometry.d))
    then, now = _shared_rows(history, rows)
    forces[now] = history.forces[Member.PINION][then]
    gathered = np.concatenate([t.operator.gathered(forces[part]) for t, part in zip(geometry.teeth, parts)])
    turned = gathered @ geometry.stand.rotation(Member.PINION, geometry.d).T
    local: Floats = -np.einsum("jia,ja->ji", geometry.operator.frames, turned)  # −f acts on the pinion
    return local[:, 1:]


def _on_loaded_teeth(rows: Ints, forces: Floats) -> Bools:
    """Rows (m,) bool of teeth that carry load."""
    size = np.abs(forces).max(axis=1)
    return np.isin(rows[:, 0], rows[size > NO_LOAD * size.max(initial=0.0), 0])


def _have_equal_rows(histories: Sequence[FrictionHistory]) -> bool:
    first, *others = (history.rows for history in histories)
    return all(np.array_equal(one, other) for rows in others for one, other in zip(rows, first))


def _jump(geometry: ContactGeometry, before: PairRotation, u1: Floats, u2: Floats) -> Floats:
    """Elastic jump (n, d) in local frames, w = R_1 u_1 − R_2 Πu_2 of the previous position, turned with the wheel to
    the present one. On deflected flanks the velocity of their points has the rotation of displacements with their
    gears: there each is turned with its own."""
    d, pinion, wheel = geometry.d, Member.PINION, Member.WHEEL
    R1, R2 = (geometry.stand.rotation(gear, d) for gear in Member)
    if not geometry.is_deflected:
        R1 = R2 @ before.rotation(wheel, d).T @ before.rotation(pinion, d)
    w = []
    for t, first, second in zip(geometry.teeth, geometry.rows(pinion)[1], geometry.rows(wheel)[1]):
        w.append(t.projected(pinion, u1[first] @ R1.T) - t.projected(wheel, u2[second] @ R2.T))
    return np.einsum("jia,ja->ji", geometry.operator.frames, np.concatenate(w))


def _displacements(geometry: ContactGeometry, histories: Sequence[FrictionHistory], gear: Member) -> Floats:
    """Displacements (histories, m, d) [mm] at the previous position of the rows of the present contact."""
    before, rows = histories[0].rows, geometry.rows(gear)[0]
    if not any(history.forces[gear].any() for history in histories):  # nothing touched
        return np.zeros((len(histories), len(rows), geometry.d))
    forces = np.stack([history.forces[gear] for history in histories])
    u = geometry.bodies[gear].chain.apply(before[gear], forces, rows)
    if gear == Member.PINION:
        then, now = _shared_rows(histories[0], rows)
        u[:, now] += np.stack([history.flux for history in histories])[:, then]
    return u


def _shared_rows(history: FrictionHistory, rows: Ints) -> tuple[Ints, Ints]:
    """Indices of the history's rows of the pinion that are among the present `rows` (m, 2), and indices of these in
    `rows`."""
    both = _row_keys(history.rows[Member.PINION]), _row_keys(rows)
    _, then, now = np.intersect1d(*both, assume_unique=True, return_indices=True)
    return then, now


def _row_keys(rows: Ints) -> Ints:
    """One number for each row (tooth, node)."""
    return rows[:, 0] * 2**32 + rows[:, 1]
