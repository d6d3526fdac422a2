"""The elastic part of the sliding velocity between gear flanks, from the deflection of the teeth.

Material points in contact are at x = c + R(X + u) on either gear, X on the worn flank. With n the direction of the line
of action, t = e_z × n the tangent along which sliding grows with ξ, ε the rotations beyond the nominal ones and a prime
for d/dφ, the sliding per radian of the pinion is

    n·(x_1 − c_1) + n·(x_2 − c_2)/u + ρ_1 ε_1' + ρ_2 ε_2' + t·(R_1 u_1' − R_2 u_2') ,

nominally (1 + 1/u) ξ. A position's own sliding is that of its undeflected flanks, as meshed; this file adds the part of
the deflection, and of the wear that the meshes do not include. u' is that of a material point. At a fixed distance s
from the contact line u changes slowly; as the line moves over the flank, it changes fast. Hence

    u' = ∂u/∂φ|_s − a' ∂u/∂a ,

the first term from the neighbouring positions, the second, the creep of rolling contact, from the position itself; a is
the arc of the contact line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.kinematics import PairRotation, line_of_action
from evolvent.wear.archard import grid_interval
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

Grids = tuple[FlankGrid, FlankGrid]
Both = tuple[Floats, Floats]
"""Arrays of pinion and wheel."""
DISPLACEMENT_ZONE = 3
"""Spacings of arc about loaded nodes where displacements are computed; a slope needs one beyond either neighbour."""


@dataclass(frozen=True)
class Deflection:
    """Deflection of the flanks at a position.

    teeth: (t,) numbers of the loaded tooth pairs.
    displacements: per gear (t, n, d) of the flank's nodes in the frame of their tooth [mm]; computed near the loaded
        nodes, and constant beyond.
    computed: per gear (t, l), layers in which they are computed.
    axes: per gear (t, 2, d), n and e_z × n in the frame of the tooth.
    """

    teeth: Ints
    displacements: Both
    computed: tuple[Bools, Bools]
    axes: Both

    @staticmethod
    def of(
        bodies: tuple[GearBody, GearBody], stand: PairRotation, rows: tuple[Ints, Ints], forces: Both, grids: Grids
    ) -> Deflection:
        """The deflection under forces (m, d) [N; N/mm in 2D], in the gear's frame, on rows (m, 2), tooth and node, of
        each gear. The pinion's displacements are those of the extended trace of contact_operator.py."""
        d, teeth = bodies[0].d, np.unique(rows[0][forces[0].any(axis=1), 0])
        fields, computed, axes = [], [], []
        for gear, body, nodes, force in zip(Member, bodies, rows, forces):
            loaded = nodes[force.any(axis=1)]
            near = nodes[_near(grids[gear], nodes, loaded)]
            u = body.chain.apply(loaded, force[force.any(axis=1)], near) @ stand.rotation(gear, d).T
            frames = [stand.rotation(gear, d, tooth) for tooth in teeth]
            of_tooth = [near[:, 0] == gear.sign * tooth for tooth in teeth]
            fields.append(
                np.stack([grids[gear].extended(near[own, 1], u[own] @ R) for own, R in zip(of_tooth, frames)])
            )
            computed.append(np.stack([grids[gear].layers_with(near[own, 1]) for own in of_tooth]))
            axes.append(np.stack([line_of_action(stand.pair, d) @ R for R in frames]))
        return Deflection(teeth, (fields[0], fields[1]), (computed[0], computed[1]), (axes[0], axes[1]))


@dataclass(frozen=True)
class PitchDeflection:
    """Deflections at the positions of one pitch in equal steps. All teeth are alike, so the next pitch is the same,
    shifted by a tooth pair.

    grids: of pinion and wheel flank.
    step: pinion rotation between positions [rad].
    stands: of all positions, with their free rotations.
    deflections: by position number; of every position that is evaluated, and of both its neighbours.
    worn: of pinion and wheel (n,) depth that the meshes do not include [mm], or None.
    """

    grids: Grids
    step: float
    stands: tuple[PairRotation, ...]
    deflections: Mapping[int, Deflection]
    worn: tuple[Floats | None, Floats | None]

    @property
    def pair(self) -> GearPair:
        """Geometry of the gear pair."""
        return self.stands[0].pair

    def elastic_sliding(self, numbers: Sequence[int], points: Sequence[ContactPoints]) -> list[Floats]:
        """Elastic part (q,) of the sliding [mm/rad] at the points of positions `numbers`, an array per position; to be
        added to the sliding of undeflected flanks."""
        if not points:
            return []
        counts, joined = [len(each.roll_distance) for each in points], ContactPoints.joined(points)
        k, tooth, ξ = np.repeat(numbers, counts), joined.tooth, joined.roll_distance
        rows = self._rows(k - 1, tooth), self._rows(k, tooth), self._rows(k + 1, tooth)
        total = np.zeros(len(k))
        for gear, s in zip(Member, (joined.across, joined.opposite)):
            flank = _FlankPoints(self, gear, joined.z, ξ, s, rows)
            by_rotation = self.pair.curvature_radii(ξ)[gear] * self._rotation_rates[gear, k]
            total += flank.shift() / (1.0, self.pair.ratio)[gear] + by_rotation + gear.sign * flank.tangential_rate()
        return np.split(total, np.cumsum(counts)[:-1])

    @cached_property
    def _rotation_rates(self) -> Floats:
        """Rates ε' (2, positions) of the gears' rotations by deflection [rad/rad]."""
        ε = np.array([stand.beyond_nominal for stand in self.stands]).T
        return np.asarray((np.roll(ε, -1, axis=1) - np.roll(ε, 1, axis=1)) / (2.0 * self.step))

    def _rows(self, k: Ints, tooth: Ints) -> Ints:
        """Rows (q,) in `joined` of teeth at positions k, also of the next pitch; −1 where a tooth carries no load."""
        pitch, position = np.divmod(k, len(self.stands))
        sought, keys = _key(position, tooth + pitch), self._keys
        place = np.minimum(np.searchsorted(keys, sought), len(keys) - 1)
        return np.where(keys[place] == sought, place, -1)

    @cached_property
    def _keys(self) -> Ints:
        """Keys of the rows of `joined`, ascending."""
        return np.concatenate([_key(np.full(len(d.teeth), k), d.teeth) for k, d in sorted(self.deflections.items())])

    @cached_property
    def joined(self) -> Deflection:
        """The teeth of all given positions, in the order of the positions."""
        parts = [deflection for _, deflection in sorted(self.deflections.items())]

        def both(name: str) -> tuple[NDArray[Any], NDArray[Any]]:
            first, second = (np.concatenate([getattr(part, name)[gear] for part in parts]) for gear in Member)
            return first, second

        teeth = np.concatenate([part.teeth for part in parts])
        return Deflection(teeth, both("displacements"), both("computed"), both("axes"))


@dataclass(frozen=True)
class _FlankPoints:
    """Contact points on the flank of one gear.

    pitch: deflections.
    gear: pinion or wheel.
    z: (q,) heights [mm].
    ξ: (q,) roll distances [mm].
    s: (q,) distances across the contact line [mm].
    rows: (q,) rows of `pitch.joined` of their teeth at the position before, at their own and at the next.
    """

    pitch: PitchDeflection
    gear: Member
    z: Floats
    ξ: Floats
    s: Floats
    rows: tuple[Ints, Ints, Ints]

    def shift(self) -> Floats:
        """Displacement (q,) [mm] of the points along the line of action, by deflection and wear."""
        worn, β = self.pitch.worn[self.gear], self.pitch.pair.pinion.base_helix_angle
        depth = np.zeros(len(self.z)) if worn is None else self._hats(self._arc(self.ξ)) @ worn
        return _dots(self._axis(0), self._u) - self.gear.sign * np.cos(β) * depth

    def tangential_rate(self) -> Floats:
        """t·R u' (q,) [mm/rad]; a one-sided difference where only one neighbouring position is computed."""
        pair, Δξ = self.pitch.pair, self.pitch.pair.pinion.base_radius * self.pitch.step
        computed = self._computed(0), self._computed(2)
        ends = [self._displacement(i, self._arc(self.ξ + shift)) for i, shift in ((0, -Δξ), (2, Δξ))]
        before, after = (np.where(given[:, None], end, self._u) for given, end in zip(computed, ends))
        change = (after - before) / (self.pitch.step * np.maximum(np.sum(computed, axis=0), 1)[:, None])
        line_speed = pair.curvature_radii(self.ξ)[self.gear] * (1.0, -1.0 / pair.ratio)[self.gear]
        line_speed = np.where(self._bearing(self.ξ) == self.ξ, line_speed, 0.0)
        return _dots(self._axis(1), change - line_speed[:, None] * self._slope())

    @cached_property
    def _u(self) -> Floats:
        """u (q, d) of the points at their own position [mm]."""
        return self._displacement(1, self._arc(self.ξ))

    def _bearing(self, ξ: Floats) -> Floats:
        """Roll distances (q,) at which this flank bears; beyond the path of contact that of its tip edge."""
        start, end = self.pitch.pair.path_of_contact
        return np.minimum(ξ, end) if self.gear == Member.PINION else np.maximum(ξ, start)

    def _arc(self, ξ: Floats) -> Floats:
        """Arcs (q,) [mm] of the points when the contact line is at ξ (q,)."""
        pair, gear = self.pitch.pair, self.gear
        offset = line_arc(pair, gear, self.ξ) - line_arc(pair, gear, self._bearing(self.ξ)) + self.s
        return line_arc(pair, gear, self._bearing(ξ)) + offset

    def _axis(self, which: int) -> Floats:
        """n (0) or t (1), (q, d), in the frame of the tooth at the points' own position."""
        return self.pitch.joined.axes[self.gear][self.rows[1], which]

    def _hats(self, arc: Floats) -> sp.csr_matrix:
        return self.pitch.grids[self.gear].hats(arc, self.z)

    def _displacement(self, when: int, arc: Floats) -> Floats:
        """u (q, d) [mm] at arcs (q,) of the position before (0), the points' own (1) or the next (2), in the tooth's
        frame; arbitrary where it is not computed."""
        hats, field = self._hats(arc), self.pitch.joined.displacements[self.gear]
        _, n, d = field.shape
        columns = hats.indices + n * np.repeat(np.maximum(self.rows[when], 0), np.diff(hats.indptr))
        at = sp.csr_matrix((hats.data, columns, hats.indptr), (len(arc), n * len(field)))
        return np.asarray(at @ field.reshape(-1, d))

    def _computed(self, when: int) -> Bools:
        """(q,) whether the displacements at the points' layers are computed before (0) or after (2)."""
        row, layers = self.rows[when], self.pitch.joined.computed[self.gear]
        low, _ = grid_interval(self.pitch.grids[self.gear].heights, self.z)
        high = np.minimum(low + 1, layers.shape[1] - 1)
        return np.asarray((row >= 0) & layers[row, low] & layers[row, high])

    def _slope(self) -> Floats:
        """∂u/∂a (q, d), a difference over two spacings of the flank's arcs."""
        arcs, arc = self.pitch.grids[self.gear].arcs, self._arc(self.ξ)
        h = float(np.median(np.diff(arcs)))
        low, high = np.clip(arc - h, arcs[0], arcs[-2]), np.clip(arc + h, arcs[1], arcs[-1])
        return (self._displacement(1, high) - self._displacement(1, low)) / (high - low)[:, None]


def _near(grid: FlankGrid, rows: Ints, loaded: Ints) -> Bools:
    """(m,) which rows, tooth and node, are within DISPLACEMENT_ZONE of loaded ones of their tooth."""
    near = np.zeros(len(rows), dtype=bool)
    for tooth in np.unique(loaded[:, 0]):
        own = np.flatnonzero(rows[:, 0] == tooth)
        near[own] = grid.neighbours(loaded[loaded[:, 0] == tooth, 1], DISPLACEMENT_ZONE)[rows[own, 1]]
    return near


def _key(k: Ints, tooth: Ints) -> Ints:
    """One integer for each position and tooth, ascending with both."""
    return k * 2**20 + tooth + 2**19


def _dots(a: Floats, b: Floats) -> Floats:
    """Dot products (q,) of vectors (q, d)."""
    return np.asarray(np.einsum("qa,qa->q", a, b))
