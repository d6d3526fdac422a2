"""The elastic part of the sliding between gear flanks: what deflected teeth add to the speeds of the nominal rotation.

The points that meet are x = c + R(X + u) on either gear, X on flanks as they are worn. With n the direction of the line
of action, t = e_z × n the tangent in which sliding grows with ξ, ε the rotations beyond the nominal ones and a dash for
d/dφ, they slide per radian of the pinion by

    n·(x_1 − c_1) + n·(x_2 − c_2)/u + ρ_1 ε_1' + ρ_2 ε_2' + t·(R_1 u_1' − R_2 u_2') ,

nominally by (1 + 1/u) ξ. A position knows that of its flanks as they stand, undeflected and as meshed; what deflection
and the wear in the gap add is here. u' belongs to a material point. At a fixed distance s from the contact line u
changes slowly; where the line goes over the flank, at once. So

    u' = ∂u/∂φ|_s − a' ∂u/∂a ,

the first from the neighbouring positions, the second, the creep of rolling contact, from the position itself; a is the
arc of the contact line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.kinematics import Stand, line_of_action
from evolvent.wear.archard import between
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.structured_grid import Mask

Grids = tuple[FlankGrid, FlankGrid]
Both = tuple[Floats, Floats]
REACH = 3  # spacings of arc about loaded nodes: a slope takes one to either side of a point between them


@dataclass(frozen=True)
class Deflection:
    """How the flanks of a position have deflected.

    teeth (t,). displacements: per gear (t, n, d) [mm] of the flank's nodes in the frame of their own tooth, found about
    those that carry force, farther away as at the last ones; seen: per gear (t, l), layers where they were found. axes:
    per gear (t, 2, d), n and e_z × n in that frame.
    """

    teeth: Ints
    displacements: Both
    seen: tuple[Mask, Mask]
    axes: Both

    @staticmethod
    def of(
        bodies: tuple[GearBody, GearBody], stand: Stand, rows: tuple[Ints, Ints], forces: Both, grids: Grids
    ) -> Deflection:
        """Under forces (m, d) [N; N/mm in 2D] on rows (m, 2) of each gear's chain, in the gear's frame. As contact
        sees the pinion, by the extended trace of contact_operator.py."""
        d, teeth = bodies[0].d, np.unique(rows[0][forces[0].any(axis=1), 0])
        fields, seen, axes = [], [], []
        for gear, body, own, pushed in zip(Member, bodies, rows, forces):
            loaded = own[pushed.any(axis=1)]
            wanted = own[_about(grids[gear], own, loaded)]
            u = body.chain.apply(loaded, pushed[pushed.any(axis=1)], wanted) @ stand.rotation(gear, d).T
            frames = [stand.rotation(gear, d, tooth) for tooth in teeth]
            nodes = [wanted[:, 0] == gear.sign * tooth for tooth in teeth]
            spread = [grids[gear].spread(wanted[here, 1], u[here] @ R) for here, R in zip(nodes, frames)]
            fields.append(np.stack(spread))
            seen.append(np.stack([grids[gear].seen(wanted[here, 1]) for here in nodes]))
            axes.append(np.stack([line_of_action(stand.pair, d) @ R for R in frames]))
        return Deflection(teeth, (fields[0], fields[1]), (seen[0], seen[1]), (axes[0], axes[1]))


@dataclass(frozen=True)
class PitchDeflection:
    """The positions of one pitch, equal steps apart; all teeth are alike, so the next pitch is the same again, a tooth
    pair on.

    stands: all of them, with their free rotations. known: deflections of some, with both neighbours of each that is
    asked for. worn: of pinion and wheel (n,) [mm] what the meshes do not know of, or None.
    """

    grids: Grids
    step: float
    stands: tuple[Stand, ...]
    known: Mapping[int, Deflection]
    worn: tuple[Floats | None, Floats | None]

    @property
    def pair(self) -> GearPair:
        """The gears' geometry."""
        return self.stands[0].pair

    def added(self, numbers: Sequence[int], points: Sequence[ContactPoints]) -> list[Floats]:
        """What is to be added (q,) [mm/rad] to the sliding of undeflected flanks, at points of positions k."""
        if not points:
            return []
        counts, every = [len(own.ξ) for own in points], ContactPoints.joined(points)
        k, tooth, ξ = np.repeat(numbers, counts), every.tooth, every.ξ
        teeth = self._stand(k - 1, tooth), self._stand(k, tooth), self._stand(k + 1, tooth)
        more = np.zeros(len(k))
        for gear, s in zip(Member, (every.across, every.opposite)):
            own = _OnFlank(self, gear, every.z, ξ, s, teeth)
            turning = self.pair.curvature_radii(ξ)[gear] * self._turning[gear, k]
            more += own.shift() / (1.0, self.pair.ratio)[gear] + turning + gear.sign * own.tangential_rate()
        return np.split(more, np.cumsum(counts)[:-1])

    @cached_property
    def _turning(self) -> Floats:
        """ε' (2, positions) [rad/rad]."""
        ε = np.array([stand.extra for stand in self.stands]).T
        return np.asarray((np.roll(ε, -1, axis=1) - np.roll(ε, 1, axis=1)) / (2.0 * self.step))

    def _stand(self, k: Ints, tooth: Ints) -> Ints:
        """(q,) number of a tooth at position k, which may be of the next pitch; −1 where it is not in the window."""
        pitch, own = np.divmod(k, len(self.stands))
        wanted, keys = _key(own, tooth + pitch), self._keys
        place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        return np.where(keys[place] == wanted, place, -1)

    @cached_property
    def _keys(self) -> Ints:
        """Ascending, of all teeth of the known positions."""
        parts = [_key(np.full(len(own.teeth), k), own.teeth) for k, own in sorted(self.known.items())]
        return np.concatenate(parts)

    @cached_property
    def all(self) -> Deflection:
        """The known positions' teeth in the order of their numbers."""
        parts = [own for _, own in sorted(self.known.items())]

        def both(name: str) -> tuple[np.ndarray, np.ndarray]:
            first, second = (np.concatenate([getattr(own, name)[gear] for own in parts]) for gear in Member)
            return first, second

        teeth = np.concatenate([own.teeth for own in parts])
        return Deflection(teeth, both("displacements"), both("seen"), both("axes"))


@dataclass(frozen=True)
class _OnFlank:
    """Points of one gear: heights z, roll distances ξ, distances s across the contact line (q,); numbers (q,) of their
    teeth at the position before, now and after."""

    pitch: PitchDeflection
    gear: Member
    z: Floats
    ξ: Floats
    s: Floats
    teeth: tuple[Ints, Ints, Ints]

    def shift(self) -> Floats:
        """(q,) [mm] how far along the line of action deflection and wear have moved the points."""
        worn, β = self.pitch.worn[self.gear], self.pitch.pair.pinion.base_helix_angle
        lost = np.zeros(len(self.z)) if worn is None else self._hats(self._arc(self.ξ)) @ worn
        return _dots(self._axis(0), self._here) - self.gear.sign * np.cos(β) * lost

    def tangential_rate(self) -> Floats:
        """t·R u' (q,) [mm/rad]."""
        pair, onward = self.pitch.pair, self.pitch.pair.pinion.base_radius * self.pitch.step
        there = self._seen(0), self._seen(2)
        ends = [self._moved(i, self._arc(self.ξ + way)) for i, way in ((0, -onward), (2, onward))]
        before, after = (np.where(known[:, None], end, self._here) for known, end in zip(there, ends))
        change = (after - before) / (self.pitch.step * np.maximum(np.sum(there, axis=0), 1)[:, None])
        line_speed = pair.curvature_radii(self.ξ)[self.gear] * (1.0, -1.0 / pair.ratio)[self.gear]
        line_speed = np.where(self._bearing(self.ξ) == self.ξ, line_speed, 0.0)
        return _dots(self._axis(1), change - line_speed[:, None] * self._slope())

    @cached_property
    def _here(self) -> Floats:
        """u (q, d) of the points now."""
        return self._moved(1, self._arc(self.ξ))

    def _bearing(self, ξ: Floats) -> Floats:
        """Roll distances (q,) at which this flank is touched; beyond the path of contact by its tip, which stays."""
        start, end = self.pitch.pair.path_of_contact
        return np.minimum(ξ, end) if self.gear == Member.PINION else np.maximum(ξ, start)

    def _arc(self, ξ: Floats) -> Floats:
        """(q,) of the points when the contact line is at ξ (q,)."""
        pair, gear = self.pitch.pair, self.gear
        offset = line_arc(pair, gear, self.ξ) - line_arc(pair, gear, self._bearing(self.ξ)) + self.s
        return line_arc(pair, gear, self._bearing(ξ)) + offset

    def _axis(self, which: int) -> Floats:
        """(q, d) n (0) or t (1) in the frame of the tooth, now."""
        return self.pitch.all.axes[self.gear][self.teeth[1], which]

    def _hats(self, arc: Floats) -> sp.csr_matrix:
        return self.pitch.grids[self.gear].hats(arc, self.z)

    def _moved(self, when: int, arc: Floats) -> Floats:
        """u (q, d) at arcs (q,) before (0), now (1) or after (2), in the tooth's frame; anything where not seen."""
        hats, field = self._hats(arc), self.pitch.all.displacements[self.gear]
        _, n, d = field.shape
        columns = hats.indices + n * np.repeat(np.maximum(self.teeth[when], 0), np.diff(hats.indptr))
        at = sp.csr_matrix((hats.data, columns, hats.indptr), (len(arc), n * len(field)))
        return np.asarray(at @ field.reshape(-1, d))

    def _seen(self, when: int) -> Mask:
        """(q,) bool: whether the window has the points' layers before (0) or after (2)."""
        tooth, layers = self.teeth[when], self.pitch.all.seen[self.gear]
        low, _ = between(self.pitch.grids[self.gear].heights, self.z)
        high = np.minimum(low + 1, layers.shape[1] - 1)
        return np.asarray((tooth >= 0) & layers[tooth, low] & layers[tooth, high])

    def _slope(self) -> Floats:
        """∂u/∂a (q, d), over two of the flank's spacings."""
        arcs, arc = self.pitch.grids[self.gear].arcs, self._arc(self.ξ)
        h = float(np.median(np.diff(arcs)))
        low, high = np.clip(arc - h, arcs[0], arcs[-2]), np.clip(arc + h, arcs[1], arcs[-1])
        return (self._moved(1, high) - self._moved(1, low)) / (high - low)[:, None]


def _about(grid: FlankGrid, rows: Ints, loaded: Ints) -> Mask:
    """(m,) bool: which rows are within REACH of loaded ones of their tooth."""
    found = np.zeros(len(rows), dtype=bool)
    for tooth in np.unique(loaded[:, 0]):
        own = np.flatnonzero(rows[:, 0] == tooth)
        found[own] = grid.near(loaded[loaded[:, 0] == tooth, 1], REACH)[rows[own, 1]]
    return found


def _key(k: Ints, tooth: Ints) -> Ints:
    """One number for each position and tooth, ascending with both."""
    return k * 2**20 + tooth + 2**19


def _dots(a: Floats, b: Floats) -> Floats:
    """(q,) of (q, d)."""
    return np.asarray(np.einsum("qa,qa->q", a, b))
