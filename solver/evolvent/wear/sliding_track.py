"""A body that travels through a contact, and the track that a surface of it wears on: a ring, or an endless belt.

Every place of the track comes under the contact in turn, so that its depth is a field over one coordinate c across the
track and the same all along it. With hats ψ over a grid of c, and the track's length l(c),

    m_k h_k = (K/H) Σ_q w_q ψ_k(c_q) λ_q s_q ,   m_k = ∫ψ_k l(c) dc

so that the volume Σ m_k h_k is (K/H)∫∫p|v_s| dA dt here, too. The contact has to be there as a whole: one that is cut
by a plane of symmetry across the path wears the track by half. What touches a track twice in a cycle has to do so
within one facet group.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.contact.problem.definition import Placement
from evolvent.fem.surface import Surface
from evolvent.wear.archard import between
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

FLAT = 1e-3  # of a track's width: how far its surface may leave the ring or the plane
MOST = 1000  # intervals across a track

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Travel:
    """A rigid motion of a body in each cycle: translation [mm], then rotation [rad] about an axis through `centre`.

    Contact points take the speed that the motion has at the start; a body that turns goes round and round.
    """

    body: int
    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Vector = (0.0, 0.0, 0.0)
    centre: Vector = (0.0, 0.0, 0.0)

    def at(self, points: Floats) -> Floats:
        """Path (q, d) per cycle of points (q, d) [mm]."""
        d = points.shape[1]
        arms: Floats = np.pad(points - np.asarray(self.centre)[:d], ((0, 0), (0, 3 - d)))
        return np.asarray(np.asarray(self.translation) + np.cross(self.rotation, arms))[:, :d]

    def in_frame(self, where: Placement) -> Travel:
        """The same motion as a body that stands there sees it; in 2D what stays in the plane."""
        d = len(where.translation)
        R, shift, plane = np.eye(3), np.zeros(3), np.arange(3) < d
        R[:d, :d], shift[:d] = where.rotation, where.translation
        path = np.where(plane, self.translation, 0.0)
        axis = np.where(plane & (d == 2), 0.0, self.rotation)
        seen = np.stack([path, axis, np.asarray(self.centre) - shift]) @ R
        return Travel(self.body, *((x, y, z) for x, y, z in seen.tolist()))


@dataclass(frozen=True)
class Across:
    """A coordinate c [mm]: the place along the line through `centre` (3,) in this direction (3,), or, where radial, the
    distance from it."""

    centre: Floats
    direction: Floats
    radial: bool = False

    def at(self, points: Floats) -> Floats:
        """(q,) of points (q, d)."""
        arms = np.pad(points, ((0, 0), (0, 3 - points.shape[1]))) - self.centre
        along = arms @ self.direction
        return np.linalg.norm(arms - along[:, None] * self.direction, axis=1) if self.radial else along


@dataclass(frozen=True)
class Track:
    """across: c of points in the body's frame. grid: (g,) of c, ascending; in 2D one place. lengths: (g,) l [mm]."""

    across: Across
    grid: Floats
    lengths: Floats

    @cached_property
    def areas(self) -> Floats:
        """(g,) m_k [mm²; mm in 2D], exact where l is linear in c."""
        if len(self.grid) == 1:
            return self.lengths
        step, low, high = np.diff(self.grid) / 6.0, self.lengths[:-1], self.lengths[1:]
        return np.append(step * (2.0 * low + high), 0.0) + np.append(0.0, step * (low + 2.0 * high))

    def hats(self, points: Floats) -> sp.csr_matrix:
        """(q, g) ψ at points (q, d) in the body's frame; a point beside the track counts to its rim."""
        i, t = between(self.grid, self.across.at(points))
        columns = np.stack([i, np.minimum(i + 1, len(self.grid) - 1)], axis=1)
        values, ends = np.stack([1.0 - t, t], axis=1), 2 * np.arange(len(i) + 1)
        return sp.csr_matrix((values.ravel(), columns.ravel(), ends), (len(i), len(self.grid)))


def track_of(surface: Surface, travel: Travel) -> Track:
    """The track of a surface; both in the body's frame. Raises InputError where the surface is not all on one track."""
    x, turns, goes = surface.points, any(travel.rotation), any(travel.translation)
    if turns == goes:
        raise InputError(
            f"wear of body {travel.body}, which travels: wanted a body that turns or goes straight on, found "
            f"{'both' if turns else 'neither'}; its track has to be a ring or an endless belt"
        )
    c, other = _ring(travel) if turns else _belt(travel, x)
    if x.shape[1] == 3 and np.ptp(c.at(x)) < np.ptp(other.at(x)):
        c, other = other, c
    width, off = np.ptp(c.at(x) if x.shape[1] == 3 else x, axis=0).max(), np.ptp(other.at(x))
    if not off < FLAT * width:
        raise InputError(
            f"wear of body {travel.body}, which travels: wanted a surface that stays on its own track, a disc's flat "
            f"face, a cylinder's side or a plane along the path, found one {width:.3g} mm wide that leaves it by "
            f"{off:.3g} mm; mind the axis, and give curved or inclined parts no K/H"
        )
    grid = _grid(c.at(x), surface)
    radius = grid if c.radial else np.full(len(grid), other.at(x).mean())
    lengths = 2.0 * np.pi * radius if turns else np.full(len(grid), np.linalg.norm(travel.translation))
    return Track(c, grid, lengths)


def _ring(travel: Travel) -> tuple[Across, Across]:
    """Along the axis, and the distance from it."""
    axis, centre = np.asarray(travel.rotation) / np.linalg.norm(travel.rotation), np.asarray(travel.centre)
    return Across(centre, axis), Across(centre, axis, radial=True)


def _belt(travel: Travel, points: Floats) -> tuple[Across, Across]:
    """Across the path: where the points (n, d) spread most, and at a right angle to that; in 2D the first is z."""
    path = np.asarray(travel.translation) / np.linalg.norm(travel.translation)
    if points.shape[1] == 2:
        wide = np.array([0.0, 0.0, 1.0])
    else:
        arms = (points - points.mean(axis=0)) @ (np.eye(3) - np.outer(path, path))
        wide = np.linalg.eigh(arms.T @ arms)[1][:, -1]
        wide *= np.sign(wide[np.argmax(np.abs(wide))])
    return Across(np.zeros(3), wide), Across(np.zeros(3), np.cross(path, wide))


def _grid(c: Floats, surface: Surface) -> Floats:
    """(g,) over the surface's c (n,), about as fine as its smallest cells; one place in 2D."""
    if surface.points.shape[1] == 2:
        return c[:1]
    size = float(np.sqrt(surface.areas().min())) / surface.order
    return np.linspace(c.min(), c.max(), 1 + min(max(round(float(np.ptp(c)) / size), 1), MOST))
