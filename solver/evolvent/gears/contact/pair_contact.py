"""The contact of a gear pair at one position: tooth pairs within reach, their window, and the condensed system.

Only the nodes of a window about each contact line take part; a solution that touches the window's rim is refused by
`reaches_rim`, and the caller widens the window; what it leaves out altogether is `gear_overlap`'s. The whole flanks can
be searched instead, to show that it changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.equilibrium import CondensedSystem
from evolvent.contact.nitsche.contact_operator import ContactOperator, stacked
from evolvent.fem.parallel.cores import Threads
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.search_window import arc_distance
from evolvent.gears.contact.tooth_contact import PENETRATION, Displaced, ToothContact, tooth_contact
from evolvent.gears.kinematics import Stand, spin
from evolvent.gears.ring.ring_compliance import Part
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member

GEOMETRIC = "as_made", "hats", "tooth", "node", "spins", "ξ", "at_edge", "point_tooth", "across", "opposite", "distance"
"""What of a contact does not depend on wear."""


@dataclass(frozen=True)
class JumpMap:
    """Displacements at m flank nodes of one gear, in its frame, to local jumps at the n nodes of one tooth pair.

    weights: (n, m) of the projection, None where it is the identity. axes: (n, k, d) rows of the local frames in the
    gear's frame, with the jump's sign.
    """

    weights: Floats | None
    axes: Floats

    def jumps(self, displacements: Floats) -> Floats:
        """(n·k, c) from c columns of displacements (m·d, c)."""
        n, k, d = self.axes.shape
        columns = displacements.shape[1]
        u = displacements.reshape(-1, d * columns)
        projected = u if self.weights is None else self.weights @ u
        return np.matmul(self.axes, projected.reshape(n, d, columns)).reshape(n * k, columns)

    def forces(self, contact_forces: Floats) -> Floats:
        """(m, d) what contact forces (n, k) do to the gear's nodes: the transposed map."""
        pushed = np.einsum("jka,jk->ja", self.axes, contact_forces)
        return pushed if self.weights is None else self.weights.T @ pushed


@dataclass(frozen=True)
class GearContact:
    """All tooth pairs at a position.

    bodies: (pinion, wheel), the pinion carries the pressure; none on the way to another rank. half_width: of the window
    [mm of profile arc].
    """

    bodies: tuple[GearBody, ...]
    stand: Stand
    teeth: tuple[ToothContact, ...]
    half_width: float

    def on(self, bodies: tuple[GearBody, GearBody]) -> GearContact:
        """The same position between the same gears, worn otherwise: what geometry has found stays."""
        other = GearContact(bodies, self.stand, self.teeth, self.half_width)
        other.__dict__.update({name: getattr(self, name) for name in GEOMETRIC})
        return other

    @property
    def d(self) -> int:
        return self.bodies[0].d

    @property
    def is_deflected(self) -> bool:
        """Whether the flanks were searched as they have deflected."""
        return any(t.displaced is not None for t in self.teeth)

    @cached_property
    def as_made(self) -> ContactOperator:
        """All teeth's nodes in one list, before wear."""
        return stacked([t.operator for t in self.teeth])

    @cached_property
    def operator(self) -> ContactOperator:
        """The same as the bodies are worn."""
        if all(body.worn is None for body in self.bodies):
            return self.as_made
        worn = [hats @ body.worn for hats, body in zip(self.hats, self.bodies) if body.worn is not None]
        lost = np.sum(worn, axis=0)
        return self.as_made.worn(lost, np.zeros_like(lost))

    @cached_property
    def hats(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """(q, flank nodes) of pinion and wheel: hats of the flanks' nodes at the points."""
        pairs = [t.pairing for t in self.teeth]
        first = sp.vstack([self.bodies[0].flank.hat_matrix(p.facet1, p.xi1) for p in pairs]).tocsr()
        return first, sp.vstack([self.bodies[1].flank.hat_matrix(p.facet2, p.xi2) for p in pairs]).tocsr()

    @cached_property
    def tooth(self) -> Ints:
        """(n,) tooth pair of each node."""
        return np.concatenate([np.full(len(t.operator.nodes), t.tooth) for t in self.teeth])

    @cached_property
    def node(self) -> Ints:
        """(n,) flank node of the pinion's tooth."""
        return np.concatenate([t.operator.nodes for t in self.teeth])

    @cached_property
    def points(self) -> tuple[Floats, Floats]:
        """Positions (n, d) of the pinion's nodes and of the wheel's flank opposite in the common frame, undeflected."""
        first, second = [], []
        for t in self.teeth:
            first.append(t.operator.jump1 @ self._placed_points(Member.PINION, t.tooth))
            second.append(t.operator.jump2 @ self._placed_points(Member.WHEEL, t.tooth))
        return np.concatenate(first), np.concatenate(second)

    @cached_property
    def pressed_at(self) -> tuple[Floats, Floats]:
        """Where the forces act: the same, displaced as the flanks were when they were searched."""
        found = []
        for gear, points in zip(Member, self.points):
            found.append(np.concatenate([t.displaced_from(gear, x) for t, x in zip(self.teeth, self._split(points))]))
        return found[0], found[1]

    def _placed_points(self, gear: Member, tooth: int) -> Floats:
        R = self.stand.rotation(gear, self.d, tooth)
        return self.bodies[gear].flank.points @ R.T + self.stand.centre(gear, self.d)

    @cached_property
    def spins(self) -> tuple[Floats, Floats]:
        """Local jumps (n, d) per radian of pinion rotation and of wheel rotation (about +z each)."""
        result = []
        for gear in Member:
            moved = spin(self.pressed_at[gear], self.stand.centre(gear, self.d), self.stand.axis(gear))
            result.append(gear.sign * np.einsum("jia,ja->ji", self.operator.frames, moved))
        return result[0], result[1]

    def _split(self, values: Floats) -> list[Floats]:
        """Values (n, …) of the nodes by tooth pair."""
        return np.split(values, np.cumsum([len(t.operator.nodes) for t in self.teeth])[:-1])

    @cached_property
    def ξ(self) -> Floats:
        """(n,) roll distance of the contact line in each node's slice [mm]."""
        z = self.bodies[0].z[self.node]
        return self.stand.pair.roll_distance(self.stand.angle, self.tooth, z)

    def system(
        self, loaded: Member, torque: float, normal_only: bool = False, threads: Threads = nullcontext
    ) -> CondensedSystem:
        """Condensed system with one free rotation: of the `loaded` gear, under `torque` [N·mm; per mm of width in 2D].

        normal_only: without friction only the normal components are condensed, a ninth of the work. threads: in which
        each gear's compliance is put together.
        """
        k = 1 if normal_only else self.d
        n = len(self.node) * k
        A = sum(self._compliance(gear, k, threads) for gear in Member)
        motion = self.spins[loaded][:, :k].reshape(n, 1)
        lever = np.array([self.bodies[loaded].gear.base_radius])
        return CondensedSystem(self.operator, np.asarray(A), motion, np.zeros(n), np.array([torque]), lever)

    def rows(self, gear: Member) -> tuple[Ints, list[slice]]:
        """Rows (m, 2) of a gear's chain that the contact sees, and which of them belong to each tooth pair."""
        nodes = [t.touched(gear) for t in self.teeth]
        ends = np.cumsum([0] + [len(own) for own in nodes])
        rows = np.concatenate([self.bodies[gear].rows(t.tooth, own) for t, own in zip(self.teeth, nodes)])
        return rows, [slice(a, b) for a, b in pairwise(ends)]

    def jump_maps(self, gear: Member, k: int) -> list[JumpMap]:
        """For each tooth pair, the map from a gear's displacements at the touched nodes to local jumps."""
        R = self.stand.rotation(gear, self.d)
        result = []
        for t in self.teeth:
            axes = ((t.operator.frames @ R) * gear.sign)[:, :k]
            # the pinion's flank has a node where the jump has one
            result.append(JumpMap(None if gear == Member.PINION else t.projection, axes))
        return result

    def pushed(self, gear: Member, contact_forces: Floats) -> Floats:
        """What contact forces (n, k) do to a gear, (m, d) on its `rows` in its own frame [N]."""
        maps = self.jump_maps(gear, contact_forces.shape[1])
        return np.concatenate([-E.forces(f) for E, f in zip(maps, self._split(contact_forces))])

    def _compliance(self, gear: Member, k: int, threads: Threads) -> Floats:
        """A gear's part of the compliance of local jumps, (n·k, n·k)."""
        body, maps = self.bodies[gear], self.jump_maps(gear, k)
        parts = [Part(gear.sign * t.tooth, t.touched(gear), E.jumps) for t, E in zip(self.teeth, maps)]
        with threads():
            return body.chain.block(parts)

    @cached_property
    def at_edge(self) -> np.ndarray:
        """(q,) bool: points in the last row of facets before a tip edge, the pinion's own or the wheel's. Where these
        carry load the flank ends in a corner and the pressure is singular, a matter of the mesh."""
        parts = []
        for t in self.teeth:
            own = t.operator.shape @ self.bodies[0].tip_zone[t.operator.nodes].astype(float)
            other = np.abs(t.operator.shape) @ (np.abs(t.operator.jump2) @ self.bodies[1].tip_zone)
            parts.append((np.abs(own) > 1e-9) | (other > 0.05))
        return np.concatenate(parts)

    @cached_property
    def point_tooth(self) -> Ints:
        """(q,) tooth pair of each point."""
        return np.concatenate([np.full(len(t.operator.weights), t.tooth) for t in self.teeth])

    @cached_property
    def across(self) -> Floats:
        """(q,) signed distance [mm of profile arc] of the points from the nominal contact line, which is the flank's
        generator and perpendicular to the profile; positive towards the pinion's tip."""
        pair, base = self.stand.pair, self.bodies[0].gear.base_radius
        ρ_line = pair.pitch_point_roll_lengths[0] + self.ξ
        arc = (self.bodies[0].roll_length[self.node] ** 2 - ρ_line**2) / (2.0 * base)
        return np.asarray(self.operator.shape @ arc)

    @cached_property
    def opposite(self) -> Floats:
        """(q,) the same on the wheel's flank, of what lies opposite the points; positive towards the wheel's tip."""
        pair, base = self.stand.pair, self.bodies[1].gear.base_radius
        ρ_line = pair.pitch_point_roll_lengths[1] - self.ξ
        axis = self.stand.tilt(Member.WHEEL)[: self.d, : self.d]
        r = np.linalg.norm(((self.points[1] - self.stand.centre(Member.WHEEL, self.d)) @ axis)[:, :2], axis=1)
        return np.asarray(self.operator.shape @ ((r**2 - base**2 - ρ_line**2) / (2.0 * base)))

    @cached_property
    def distance(self) -> Floats:
        """(q,) how far the points lie from their contact lines, in half-widths of the window."""
        parts = [
            arc_distance(self.bodies[0], self.stand, t.tooth, t.operator.nodes) / self.half_width
            for t in self.teeth
        ]
        return np.asarray(self.operator.hat @ np.concatenate(parts))

    @property
    def too_deep(self) -> bool:
        """Whether undeflected flanks overlap nearly as deep as the search looks: deeper points would be missing."""
        deepest = -float(self.operator.gap.min())
        return deepest > 0.9 * PENETRATION * self.stand.pair.pinion.normal_module

    def reaches_rim(self, pressed: np.ndarray) -> bool:
        """Whether a point in contact (q,) bool lies at the window's rim, where the pressure may have been cut off."""
        return bool(np.any(pressed & (self.distance > 1.0)))


def gear_contact(
    bodies: tuple[GearBody, GearBody], stand: Stand, teeth: list[int], half_width: float,
    displaced: Mapping[int, Displaced] = MappingProxyType({}),
) -> GearContact:  # fmt: skip
    """Searches all tooth pairs that may touch at this stand. half_width: of the window [mm of profile arc],
    infinite where the whole flanks are searched. displaced: of tooth pairs that are searched as they have deflected.

    Raises SearchError.
    """
    found = [tooth_contact(bodies, stand, tooth, half_width, displaced.get(tooth)) for tooth in teeth]
    return GearContact(bodies, stand, tuple(contact for contact in found if contact is not None), half_width)


def relative_velocity(contact: GearContact) -> Floats:
    """(n, d) velocity of pinion over wheel per radian of pinion rotation, local frames."""
    return contact.spins[0] - contact.spins[1] / contact.stand.pair.ratio
