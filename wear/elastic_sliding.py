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

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from meshes.data import Floats, Ints
from meshes.parameters import GearPair
from solver.gear_body import GearBody
from solver.gear_position import ContactPoints
from solver.kinematics import Stand, line_of_action
from wear.flank_grid import FlankGrid, line_arc

Grids = tuple[FlankGrid, FlankGrid]
Both = tuple[Floats, Floats]


@dataclass(frozen=True)
class Deflection:
    """How the flanks of a position have deflected.

    stand: with the free rotation. teeth (t,). displacements: per gear (t, n, d) [mm] of the flank's nodes in the frame
    of their own tooth, beyond the window as at its rim. axes: per gear (t, 2, d), n and e_z × n in that frame.
    """

    stand: Stand
    teeth: Ints
    displacements: Both
    axes: Both

    @staticmethod
    def of(
        bodies: tuple[GearBody, GearBody], stand: Stand, rows: tuple[Ints, Ints], forces: Both, grids: Grids
    ) -> Deflection:
        """Under forces (m, d) [N; N/mm in 2D] on rows (m, 2) of each gear's chain, in the gear's frame."""
        d, teeth = bodies[0].d, np.unique(rows[0][:, 0])
        directions = line_of_action(stand.pair, d)
        fields, axes = [], []
        for gear, (body, own, pushed) in enumerate(zip(bodies, rows, forces)):
            loaded = pushed.any(axis=1)
            u = body.chain.apply(own[loaded], pushed[loaded], own) @ stand.rotation(gear, d).T
            frames = [stand.rotation(gear, d, tooth) for tooth in teeth]
            of_tooth = [own[:, 0] == body.sign * tooth for tooth in teeth]
            spread = [grids[gear].spread(own[here, 1], u[here] @ R) for here, R in zip(of_tooth, frames)]
            fields.append(np.stack(spread))
            axes.append(np.stack([directions @ R for R in frames]))
        return Deflection(stand, teeth, (fields[0], fields[1]), (axes[0], axes[1]))


@dataclass(frozen=True)
class PitchDeflection:
    """The positions of one pitch, equal steps [rad] apart; all teeth are alike, so the next pitch is the same again, a
    tooth pair on."""

    bodies: tuple[GearBody, GearBody]
    grids: Grids
    step: float
    positions: tuple[Deflection, ...]

    def sliding(self, numbers: Sequence[int], points: Sequence[ContactPoints]) -> list[Floats]:
        """What is to be added (q,) [mm/rad] at the points of each of the positions of these numbers."""
        if not points:
            return []
        k = np.repeat(numbers, [len(own.ξ) for own in points])
        tooth, z, ξ, *across = (
            np.concatenate([getattr(own, name) for own in points]) for name in ("tooth", "z", "ξ", "across", "opposite")
        )
        stands = self._stand(k - 1, tooth), self._stand(k, tooth), self._stand(k + 1, tooth)
        more = sum(self._of_gear(gear, k, stands, z, ξ, s) for gear, s in enumerate(across))
        return np.split(np.asarray(more), np.cumsum([len(own.ξ) for own in points])[:-1])

    def _of_gear(self, gear: int, k: Ints, stands: tuple[Ints, Ints, Ints], z: Floats, ξ: Floats, s: Floats) -> Floats:
        """Its part, at distances s (q,) from the contact line on its flank."""
        before, now, after = stands
        ρ, arc = self.pair.curvature_radii(ξ)[gear], line_arc(self.pair, gear, ξ) + s
        speed, sign = (1.0, -1.0 / self.pair.ratio)[gear], (1.0, -1.0)[gear]  # of rotation; of x in the sliding
        onward = self.pair.pinion.base_radius * self.step
        here = self._moved(gear, now, arc, z)
        earlier = self._moved(gear, before, line_arc(self.pair, gear, ξ - onward) + s, z)
        later = self._moved(gear, after, line_arc(self.pair, gear, ξ + onward) + s, z)
        at_distance = self._difference((before, earlier), here, (after, later))
        u_rate = at_distance - (speed * ρ)[:, None] * self._slope(gear, now, arc, z)
        n, t = np.moveaxis(self._axes[gear][now], 1, 0)
        ε = np.array([position.stand.extra[gear] for position in self.positions])
        ε_rate = (np.roll(ε, -1) - np.roll(ε, 1)) / (2.0 * self.step)
        shift = _dots(n, here) - sign * self._worn(gear, arc, z)
        return np.asarray(abs(speed) * shift + ρ * ε_rate[k] + sign * _dots(t, u_rate))

    def _worn(self, gear: int, arc: Floats, z: Floats) -> Floats:
        """(q,) [mm] how far wear of which the mesh does not know has moved a flank in the transverse section."""
        worn = self.bodies[gear].worn
        lost = np.zeros(len(arc)) if worn is None else self.grids[gear].hats(arc, z) @ worn
        return np.asarray(np.cos(self.pair.pinion.base_helix_angle) * lost)

    @property
    def pair(self) -> GearPair:
        """The gears' geometry."""
        return self.positions[0].stand.pair

    def _difference(self, earlier: tuple[Ints, Floats], here: Floats, later: tuple[Ints, Floats]) -> Floats:
        """∂u/∂φ (q, d) from stands (q,) and u (q, d) a step before and after; to one side where a tooth does not bear
        on the other."""
        there = [(stand >= 0)[:, None] for stand, _ in (earlier, later)]
        before, after = (np.where(known, u, here) for known, (_, u) in zip(there, (earlier, later)))
        return np.asarray((after - before) / (self.step * np.maximum(np.sum(there, axis=0), 1)))

    def _moved(self, gear: int, stand: Ints, arc: Floats, z: Floats) -> Floats:
        """u (q, d) on a gear's flank at arcs and heights (q,) of stands (q,), in the tooth's frame."""
        hats, field = self.grids[gear].hats(arc, z), self._fields[gear]
        _, n, d = field.shape
        columns = hats.indices + n * np.repeat(np.maximum(stand, 0), np.diff(hats.indptr))
        at = sp.csr_matrix((hats.data, columns, hats.indptr), (len(arc), n * len(field)))
        return np.asarray(at @ field.reshape(-1, d))

    def _slope(self, gear: int, stand: Ints, arc: Floats, z: Floats) -> Floats:
        """∂u/∂a (q, d), over two of the flank's spacings."""
        arcs = self.grids[gear].arcs
        h = float(np.median(np.diff(arcs)))
        low, high = np.clip(arc - h, arcs[0], arcs[-2]), np.clip(arc + h, arcs[1], arcs[-1])
        return (self._moved(gear, stand, high, z) - self._moved(gear, stand, low, z)) / (high - low)[:, None]

    @cached_property
    def _fields(self) -> Both:
        """Per gear (stands, n, d)."""
        first, second = (np.concatenate([p.displacements[gear] for p in self.positions]) for gear in (0, 1))
        return first, second

    @cached_property
    def _axes(self) -> Both:
        """Per gear (stands, 2, d)."""
        first, second = (np.concatenate([p.axes[gear] for p in self.positions]) for gear in (0, 1))
        return first, second

    def _stand(self, k: Ints, tooth: Ints) -> Ints:
        """(q,) number of a tooth at position k, which may be one of the next pitch; −1 where it does not bear."""
        pitch, own = np.divmod(k, len(self.positions))
        keys, found = _key(own, tooth + pitch), self._keys
        place = np.minimum(np.searchsorted(found, keys), len(found) - 1)
        return np.where(found[place] == keys, place, -1)

    @cached_property
    def _keys(self) -> Ints:
        """Ascending, of all stands."""
        return np.concatenate([_key(np.full(len(p.teeth), k), p.teeth) for k, p in enumerate(self.positions)])


def _key(k: Ints, tooth: Ints) -> Ints:
    """One number for each position and tooth, ascending with both."""
    return k * 2**20 + tooth + 2**19


def _dots(a: Floats, b: Floats) -> Floats:
    """(q,) of (q, d)."""
    return np.asarray(np.einsum("qa,qa->q", a, b))
