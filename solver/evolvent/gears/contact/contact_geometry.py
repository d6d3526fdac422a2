"""Geometry of the contact of a gear pair at one position, without wear, from one search. `pair_contact` has the gap of
worn flanks."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.applied_compliance import summed
from evolvent.contact.newton.block_inverse import NearlyNormal
from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.nitsche.contact_operator import ContactOperator, stacked
from evolvent.fem.parallel.cores import Threads
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.tooth_contact import ToothContact
from evolvent.gears.kinematics import PairRotation, spin
from evolvent.gears.ring.jump_map import JumpMap
from evolvent.gears.ring.ring_compliance import MappedNodes
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class ContactGeometry:
    """All tooth pairs within reach at a position: n nodes of the pinion's flanks, q quadrature points between them.

    bodies: pinion and wheel without wear; empty while it is sent between ranks.
    stand: where the gears stood in the search.
    teeth: the tooth pairs whose flanks face each other.
    half_width: of the window [mm of profile arc], infinite where the whole flanks were searched.
    """

    bodies: tuple[GearBody, ...]
    stand: PairRotation
    teeth: tuple[ToothContact, ...]
    half_width: float

    @property
    def d(self) -> int:
        """Space dimension."""
        return self.bodies[Member.PINION].d

    @property
    def is_deflected(self) -> bool:
        """Whether the flanks were searched as they have deflected."""
        return any(t.displaced is not None for t in self.teeth)

    @cached_property
    def operator(self) -> ContactOperator:
        """Contact of all tooth pairs, their nodes in one list, without wear."""
        return stacked([t.operator for t in self.teeth])

    @cached_property
    def flank_hats(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """Hat functions (q, flank nodes) of the flank nodes of pinion and wheel at the points."""
        pairs, (pinion, wheel) = [t.pairing for t in self.teeth], (body.flank for body in self.bodies)
        first = sp.vstack([pinion.hat_matrix(p.facet1, p.xi1) for p in pairs]).tocsr()
        return first, sp.vstack([wheel.hat_matrix(p.facet2, p.xi2) for p in pairs]).tocsr()

    @cached_property
    def tooth(self) -> Ints:
        """Tooth pair (n,) of each node of the jump."""
        return np.concatenate([np.full(t.operator.n, t.tooth) for t in self.teeth])

    @cached_property
    def z(self) -> Floats:
        """Heights (n,) of the jump's nodes [mm]."""
        return np.concatenate([t.z for t in self.teeth])

    @cached_property
    def arc(self) -> Floats:
        """Profile arc (n,) of the jump's nodes on the pinion's flank, from the base circle on [mm]."""
        return np.concatenate([t.arc for t in self.teeth])

    @cached_property
    def point_tooth(self) -> Ints:
        """Tooth pair (q,) of each point."""
        return np.concatenate([np.full(len(t.operator.weights), t.tooth) for t in self.teeth])

    @cached_property
    def node(self) -> Ints:
        """Flank nodes (m,) of the pinion's teeth about the points."""
        return np.concatenate([t.operator.nodes for t in self.teeth])

    @cached_property
    def node_tooth(self) -> Ints:
        """Tooth pair (m,) of each of these."""
        return np.concatenate([np.full(len(t.operator.nodes), t.tooth) for t in self.teeth])

    @cached_property
    def roll_distance(self) -> Floats:
        """Roll distance ξ (n,) of the contact line in each node's slice [mm]."""
        return self.stand.pair.roll_distance(self.stand.angle, self.tooth, self.z)

    @cached_property
    def points(self) -> tuple[Floats, Floats]:
        """Positions (n, d) of the pinion's nodes and of the wheel's flank opposite in the common frame, undeflected."""
        first, second = [], []
        for t in self.teeth:
            first.append(t.operator.jump1 @ self._placed_points(Member.PINION, t.tooth))
            second.append(t.operator.jump2 @ self._placed_points(Member.WHEEL, t.tooth))
        return np.concatenate(first), np.concatenate(second)

    @cached_property
    def force_points(self) -> tuple[Floats, Floats]:
        """Points at which the forces act: `points`, displaced as the flanks were when they were searched."""
        result = []
        for gear, points in zip(Member, self.points):
            result.append(np.concatenate([t.displaced_from(gear, x) for t, x in zip(self.teeth, self._split(points))]))
        return result[0], result[1]

    @cached_property
    def spins(self) -> tuple[Floats, Floats]:
        """Local jumps (n, d) per radian of pinion rotation and of wheel rotation (about +z each)."""
        result = []
        for gear in Member:
            moved = spin(self.force_points[gear], self.stand.centre(gear, self.d), self.stand.axis(gear))
            result.append(gear.sign * np.einsum("jia,ja->ji", self.operator.frames, moved))
        return result[0], result[1]

    @cached_property
    def at_tip_edge(self) -> Bools:
        """Points (q,) bool whose jump depends on the last row before a tip edge of either gear. Where these carry load
        the flank ends in a corner and the pressure is singular, a matter of the mesh."""
        return np.concatenate([t.at_tip_edge for t in self.teeth])

    @cached_property
    def across(self) -> Floats:
        """Signed distance (q,) [mm of profile arc] of the points from the nominal contact line, which is the flank's
        generator and perpendicular to the profile; positive towards the pinion's tip."""
        base = self.bodies[Member.PINION].gear.base_radius
        ρ_line = self.stand.pair.pitch_point_roll_lengths[Member.PINION] + self.roll_distance
        return np.asarray(self.operator.shape @ (self.arc - ρ_line**2 / (2.0 * base)))

    @cached_property
    def opposite(self) -> Floats:
        """Signed distance (q,) [mm of profile arc] of the points' partners on the wheel's flank from the nominal
        contact line; positive towards the wheel's tip."""
        wheel, base = self.bodies[Member.WHEEL].flank, self.bodies[Member.WHEEL].gear.base_radius
        pairs = [t.pairing for t in self.teeth]
        x = np.concatenate([wheel.positions(p.facet2, p.xi2[:, None])[:, 0] for p in pairs])
        ρ_line = self.stand.pair.pitch_point_roll_lengths[Member.WHEEL] - self.operator.shape @ self.roll_distance
        return np.asarray((x[:, 0] ** 2 + x[:, 1] ** 2 - base**2 - ρ_line**2) / (2.0 * base))

    @cached_property
    def window_distance(self) -> Floats:
        """Distance (q,) of the points from the lines about which they were searched, in half-widths of the window."""
        return np.concatenate([t.distance for t in self.teeth]) / self.half_width

    def reaches_rim(self, pressed: Bools) -> bool:
        """Whether a point in contact (q,) bool lies at the window's rim, where the pressure may have been cut off."""
        return bool(np.any(pressed & (self.window_distance > 1.0)))

    def rows(self, gear: Member) -> tuple[Ints, list[slice]]:
        """Rows (m, 2) of a gear's compliance that the jumps depend on, and which of them belong to each tooth pair."""
        nodes = [t.coupled_nodes(gear) for t in self.teeth]
        ends = np.cumsum([0] + [len(each) for each in nodes])
        rows = np.concatenate([self.bodies[gear].rows(t.tooth, each) for t, each in zip(self.teeth, nodes)])
        return rows, [slice(a, b) for a, b in pairwise(ends)]

    def jump_maps(self, gear: Member, k: int) -> list[JumpMap]:
        """Map of each tooth pair from a gear's displacements at its coupled nodes to the first k components of the
        local jumps."""
        R = self.stand.rotation(gear, self.d)
        result = []
        for t in self.teeth:
            axes = ((t.operator.frames @ R) * gear.sign)[:, :k]
            result.append(JumpMap(t.projections[gear], axes))
        return result

    def flank_forces(self, gear: Member, contact_forces: Floats) -> Floats:
        """Forces (m, d) [N] on the `rows` of a gear, in its own frame, under contact forces (n, k)."""
        maps = self.jump_maps(gear, contact_forces.shape[1])
        return np.concatenate([-E.forces(f) for E, f in zip(maps, self._split(contact_forces))])

    def compliance(
        self, k: int, threads: Threads = nullcontext, rough: NearlyNormal | None = None
    ) -> JumpCompliance:
        """Compliance of the first k components of the local jumps, (n·k, n·k): the sum over both gears.

        threads: context in which each gear's is assembled. rough: its approximate matrix where that is known, only for
        gears whose compliance is applied without a matrix.
        """
        parts = []
        for gear, body in zip(Member, self.bodies):
            maps = zip(self.teeth, self.jump_maps(gear, k))
            wanted = [MappedNodes(gear.sign * t.tooth, t.coupled_nodes(gear), E) for t, E in maps]
            with threads():
                parts.append(body.chain.jumps(wanted))
        return summed(parts, k, rough)

    def _placed_points(self, gear: Member, tooth: int) -> Floats:
        R = self.stand.rotation(gear, self.d, tooth)
        return self.bodies[gear].flank.points @ R.T + self.stand.centre(gear, self.d)

    def _split(self, values: Floats) -> list[Floats]:
        """Values (n, …) of the nodes by tooth pair."""
        return np.split(values, np.cumsum([t.operator.n for t in self.teeth])[:-1])


def relative_velocity(geometry: ContactGeometry) -> Floats:
    """Velocity (n, d) of pinion over wheel per radian of pinion rotation, in local frames."""
    return geometry.spins[Member.PINION] - geometry.spins[Member.WHEEL] / geometry.stand.pair.ratio
