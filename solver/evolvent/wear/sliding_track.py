"""A body that travels through a contact, and the wear track on its surface: a ring, or an endless belt.

Every place of the track passes the contact in turn, so the worn depth varies across the track only, over a coordinate
c, and is constant along it. With hat functions ψ over a grid of c and the track's length l(c),

    m_k h_k = (K/H) Σ_q w_q ψ_k(c_q) λ_q s_q ,   m_k = ∫ψ_k l(c) dc

so that the volume Σ m_k h_k equals (K/H)∫∫p|v_s| dA dt here, too. The model has to contain the whole contact: a contact
cut by a plane of symmetry across the path wears the track by half. All contacts of a track within one cycle have to be
in the same facet group.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.contact.problem.definition import Placement
from evolvent.fem.surface import Surface
from evolvent.wear.archard import grid_interval
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

FLATNESS = 1e-3  # of a track's width: largest distance of its surface from the ring or the plane
MAX_INTERVALS = 1000  # across a track

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Travel:
    """Rigid motion of a body per cycle: a translation, or a rotation about an axis through `centre`.

    body: index of the body in the problem.
    translation: [mm].
    rotation: rotation vector [rad].
    centre: a point of the axis [mm].

    Contact points take the velocity that the motion has at its start; a rotating body may turn more than once.

    >>> import numpy as np
    >>> disc = Travel(body=1, rotation=(0.0, 0.0, 2.0 * np.pi), centre=(0.0, -40.0, 0.0))  # one revolution per cycle
    >>> disc.at(np.array([[0.0, 0.0, 0.0]])).round(3)
    array([[-251.327,    0.   ,    0.   ]])
    """

    body: int
    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Vector = (0.0, 0.0, 0.0)
    centre: Vector = (0.0, 0.0, 0.0)

    def at(self, points: Floats) -> Floats:
        """Path per cycle (q, d) [mm] of points (q, d), from their velocity at the start."""
        d = points.shape[1]
        arms: Floats = np.pad(points - np.asarray(self.centre)[:d], ((0, 0), (0, 3 - d)))
        return np.asarray(np.asarray(self.translation) + np.cross(self.rotation, arms))[:, :d]

    def in_frame(self, placement: Placement) -> Travel:
        """The rigid motion in the frame of a body placed there; in 2D its part in the plane."""
        d = len(placement.translation)
        R, shift, in_plane = np.eye(3), np.zeros(3), np.arange(3) < d
        R[:d, :d], shift[:d] = placement.rotation, placement.translation
        path = np.where(in_plane, self.translation, 0.0)
        axis = np.where(in_plane & (d == 2), 0.0, self.rotation)
        local = np.stack([path, axis, np.asarray(self.centre) - shift]) @ R
        return Travel(self.body, *((x, y, z) for x, y, z in local.tolist()))


@dataclass(frozen=True)
class TrackCoordinate:
    """The coordinate c [mm] across a track.

    centre: (3,) origin, or a point of the axis [mm].
    direction: (3,) unit vector along which c is measured, or the axis.
    radial: c is the distance from the axis.
    """

    centre: Floats
    direction: Floats
    radial: bool = False

    def at(self, points: Floats) -> Floats:
        """Coordinates c (q,) of points (q, d)."""
        arms = np.pad(points, ((0, 0), (0, 3 - points.shape[1]))) - self.centre
        along = arms @ self.direction
        return np.linalg.norm(arms - along[:, None] * self.direction, axis=1) if self.radial else along


@dataclass(frozen=True)
class Track:
    """A wear track, in the frame of its body.

    coordinate: c across the track.
    grid: (g,) nodes of the depth over c, ascending [mm]; one in 2D.
    lengths: (g,) length l of the track there [mm].
    """

    coordinate: TrackCoordinate
    grid: Floats
    lengths: Floats

    @cached_property
    def areas(self) -> Floats:
        """Areas m_k (g,) of the nodes [mm²; mm in 2D], exact where l is linear in c."""
        if len(self.grid) == 1:
            return self.lengths
        step, low, high = np.diff(self.grid) / 6.0, self.lengths[:-1], self.lengths[1:]
        return np.append(step * (2.0 * low + high), 0.0) + np.append(0.0, step * (low + 2.0 * high))

    def hats(self, points: Floats) -> sp.csr_matrix:
        """Hat functions (q, g) at points (q, d) in the body's frame; a point beside the track counts to its rim."""
        i, t = grid_interval(self.grid, self.coordinate.at(points))
        columns = np.stack([i, np.minimum(i + 1, len(self.grid) - 1)], axis=1)
        values, ends = np.stack([1.0 - t, t], axis=1), 2 * np.arange(len(i) + 1)
        return sp.csr_matrix((values.ravel(), columns.ravel(), ends), (len(i), len(self.grid)))


def track_of(surface: Surface, travel: Travel) -> Track:
    """The track of a surface, both in the body's frame.

    Raises InputError unless the body either rotates or translates, and the whole surface lies on one track.
    """
    x, rotates, translates = surface.points, any(travel.rotation), any(travel.translation)
    if rotates == translates:
        raise InputError(
            f"wear of body {travel.body}, which travels: wanted a body that turns or goes straight on, found "
            f"{'both' if rotates else 'neither'}; its track has to be a ring or an endless belt"
        )
    c, normal = _ring(travel) if rotates else _belt(travel, x)
    if x.shape[1] == 3 and np.ptp(c.at(x)) < np.ptp(normal.at(x)):
        c, normal = normal, c
    width, deviation = np.ptp(c.at(x) if x.shape[1] == 3 else x, axis=0).max(), np.ptp(normal.at(x))
    if not deviation < FLATNESS * width:
        raise InputError(
            f"wear of body {travel.body}, which travels: wanted a surface that stays on its own track, a disc's flat "
            f"face, a cylinder's side or a plane along the path, found one {width:.3g} mm wide that leaves it by "
            f"{deviation:.3g} mm; check the axis, and give curved or inclined parts no K/H"
        )
    grid = _grid(c.at(x), surface)
    radius = grid if c.radial else np.full(len(grid), normal.at(x).mean())
    lengths = 2.0 * np.pi * radius if rotates else np.full(len(grid), np.linalg.norm(travel.translation))
    return Track(c, grid, lengths)


def _ring(travel: Travel) -> tuple[TrackCoordinate, TrackCoordinate]:
    """Coordinates of a rotation: along the axis, and the distance from it."""
    axis, centre = np.asarray(travel.rotation) / np.linalg.norm(travel.rotation), np.asarray(travel.centre)
    return TrackCoordinate(centre, axis), TrackCoordinate(centre, axis, radial=True)


def _belt(travel: Travel, points: Floats) -> tuple[TrackCoordinate, TrackCoordinate]:
    """Coordinates of a translation, normal to the path: where the points (n, d) spread most, and normal to that; in 2D
    the first is z."""
    path = np.asarray(travel.translation) / np.linalg.norm(travel.translation)
    if points.shape[1] == 2:
        wide = np.array([0.0, 0.0, 1.0])
    else:
        arms = (points - points.mean(axis=0)) @ (np.eye(3) - np.outer(path, path))
        wide = np.linalg.eigh(arms.T @ arms)[1][:, -1]
        wide *= np.sign(wide[np.argmax(np.abs(wide))])
    return TrackCoordinate(np.zeros(3), wide), TrackCoordinate(np.zeros(3), np.cross(path, wide))


def _grid(c: Floats, surface: Surface) -> Floats:
    """Grid (g,) over the surface's c (n,), about as fine as its smallest cells; one node in 2D."""
    if surface.points.shape[1] == 2:
        return c[:1]
    size = float(np.sqrt(surface.areas().min())) / surface.order
    return np.linspace(c.min(), c.max(), 1 + min(max(round(float(np.ptp(c)) / size), 1), MAX_INTERVALS))
