"""Structured pieces of a section, and the polar rows of its tooth.

Above the flank start a point of the tooth has a row u and a column c. Rows run from 0 (flank start) to profile_elements
(tip); each has one radius. Columns run from 0 (loaded flank) to 1 through the thin layers, to 2 through the 3:1
transitions, then by 1 for each coarse column up to the back flank.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.profile import Profile, polar
from evolvent_meshes.mesh.reference_cells import node_positions
from evolvent_meshes.mesh.structured_grid import lattice_cells, subdivided

Piece = tuple[Floats, Ints]
"""Part of a section: points (n, 3), of which the third coordinate is the flank weight, and cells (m, 9)."""

TABLE = 801
"""Points of the tables by which nodes are distributed along an arc; the positions of the nodes are exact."""


SHORT_EDGE, COARSE_ROW = 0.75, 3
"""A tip's chamfer or rounding that is shorter than so many cells of the flank has one cell along its part of the flank,
others have a coarse row of them, or more: scaled Jacobians of 12 and more cells a flank are then 0.08 and more at edges
from 0.06 modules on; with two unequal cells in a coarse row they fold."""


def half_steps(start: float, end: float) -> Floats:
    """Numbers of the nodes and middle nodes of second-order cells between two integers: every half."""
    return np.linspace(start, end, round(2 * abs(end - start)) + 1)


def even(numbers: Floats) -> Floats:
    """Fractions from 0 to 1, evenly spaced, as many as `numbers`."""
    return np.linspace(0, 1, len(numbers))


def to_polar(points: Floats) -> tuple[Floats, Floats]:
    """Radii [mm] and angles [rad] (n,) of points (n, 2)."""
    return np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])


def line(start: Floats, end: Floats, fraction: Floats) -> Floats:
    """Points (n, 2) between two, at fractions (n,) of the way."""
    return np.asarray(start + fraction[:, None] * (end - start))


def grid_piece(points: Floats, weight: Floats | float = 0.0) -> Piece:
    """A structured piece of n × m cells from points (2n + 1, 2m + 1, 2) [mm].

    weight: flank weight, a number or (2n + 1, 2m + 1) broadcast.
    """
    n, m = points.shape[:2]
    weights = np.broadcast_to(weight, (n, m))[..., None]
    return np.concatenate([points, weights], axis=2).reshape(-1, 3), lattice_cells(((n - 1) // 2, (m - 1) // 2), 2)


_THREE_TO_ONE = np.array(
    [
        [[0, 0], [1, 0], [1, 0.5], [0, 1]],
        [[1, 0], [2, 0], [2, 0.5], [1, 0.5]],
        [[2, 0], [3, 0], [3, 1], [2, 0.5]],
        [[1, 0.5], [2, 0.5], [3, 1], [0, 1]],
    ]
)


def three_to_one(place: Callable[[Floats, Floats], Floats]) -> Piece:
    """Four cells between three edges (u from 0 to 3 at v = 0) and one (v = 1).

    place: gives the points (n, 3) at u (n,) and v (n,).
    """
    a, b = node_positions("quadrilateral", 2).T / 2.0
    bilinear = np.stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], axis=1)
    u, v = np.einsum("nc,qcd->dqn", bilinear, _THREE_TO_ONE).reshape(2, -1)
    return place(u, v), np.arange(36).reshape(4, 9)


def mirrored_piece(piece: Piece) -> Piece:
    """The mirror image at θ < 0, with flank weights 0."""
    points, cells = piece
    return points * [1.0, -1.0, 0.0], cells


def graded_fractions(length: float, first: float, n: int) -> Floats:
    """Cell ends (n + 1,), as fractions from 0 to 1, of n cells over `length` that grow geometrically from `first`.

    The cells are equal where n cells of the length `first` are too long.
    """
    if n == 1 or first * n >= length:
        return np.linspace(0, 1, n + 1)
    ratio = brentq(lambda r: first * (r**n - 1) / (r - 1) - length, 1 + 1e-9, length / first + 1)
    ends = (ratio ** np.arange(n + 1) - 1) / (ratio**n - 1)
    return np.asarray(ends)


def _smaller(first: Floats, second: Floats) -> Floats:
    """A smooth approximation from below of the minimum of positive numbers."""
    return np.asarray((first**-6.0 + second**-6.0) ** (-1 / 6))


@dataclass(frozen=True)
class ToothRows:
    """The rows of a tooth above the flank start.

    profile: of the gear.
    radii: (2 rows + 1,) radii of the nodes [mm].
    band: depth of the thin layers together [mm].
    tip_share: largest share of the tooth's thickness that the thin layers take.
    columns: columns behind the thin layers; the first is the transitions.
    fine_back: whether the back flank has thin layers and transitions as well; the transitions are then the last column.
    """

    profile: Profile
    radii: Floats
    band: float
    tip_share: float
    columns: int
    fine_back: bool = False

    @cached_property
    def plateau(self) -> Floats:
        """Radii (2 rows + 1,) of the rows apart from the flanks [mm]: rows beyond the tip form circle rise to the tip
        circle evenly, while a rounded flank falls back."""
        below, tip = self.below_edge, self.profile.gear.tip_diameter / 2
        rising = np.linspace(self.radii[len(below) - 1], tip, len(self.radii) - len(below) + 1)
        return np.concatenate([below, rising[1:]])

    @property
    def below_edge(self) -> Floats:
        """The radii up to the tip form circle [mm]."""
        form = self.profile.gear.tip_form_diameter / 2
        return self.radii[self.radii <= form + 1e-9 * form]

    @property
    def start(self) -> float:
        """Flank start radius [mm]."""
        return float(self.radii[0])

    @property
    def inner(self) -> int:
        """Number of columns between the bands of both flanks."""
        return self.columns if self.fine_back else self.columns - 1

    @property
    def coarse(self) -> int:
        """Number of coarse columns."""
        return self.columns - 1 - self.fine_back

    @property
    def sides(self) -> int:
        """Number of flanks with thin layers."""
        return 1 + self.fine_back

    def strip_width(self, radius: Floats) -> Floats:
        """Arc length [mm] of the thin layers along rows at radii [mm]; their depth is measured normal to the flank."""
        along_row = self.band * radius / self.profile.gear.base_radius
        most = self.tip_share / self.sides * 2 * radius * self.profile.angle(radius)
        return _smaller(along_row, most)

    def transition_width(self, radius: Floats) -> Floats:
        """Arc length [mm] of the 3:1 transitions along rows: the height of a coarse row below a tip's chamfer or
        rounding, or less in a thin tooth."""
        height = np.interp(radius, self.below_edge, 6 * np.gradient(self.below_edge))  # three fine rows: six nodes
        rest = 2 * radius * self.profile.angle(radius) / self.sides - self.strip_width(radius)
        return _smaller(0.45 * rest, height)

    def column_width(self, radius: Floats) -> Floats:
        """Arc length [mm] of a coarse column along rows at radii [mm]."""
        thickness = 2 * radius * self.profile.angle(radius)
        rest = thickness - self.sides * (self.strip_width(radius) + self.transition_width(radius))
        return np.asarray(rest / self.coarse)

    def points(self, row: Floats, column: Floats) -> Floats:
        """Points (..., 2) [mm] at rows and columns (...); rows are multiples of a half."""
        rows = np.arange(len(self.radii)) / 2
        radius, inside = np.interp(row, rows, self.radii), np.interp(row, rows, self.plateau)
        arc = self.strip_width(radius) * np.clip(column, 0, 1)
        arc += self.transition_width(radius) * np.clip(column - 1, 0, 1)
        arc += self.column_width(radius) * np.clip(column - 2, 0, self.coarse)
        arc += self.transition_width(radius) * np.maximum(column - 2 - self.coarse, 0)
        flank = self.profile.angle(radius)
        angle = flank - arc / radius
        if self.profile.edge is not None:
            radius = inside - (inside - radius) * self.profile.edge.drop(angle / flank)
        points = polar(radius, angle)
        last = (np.asarray(column) == 1 + self.columns) & (not self.fine_back)
        return np.where(last[..., None], polar(radius, -flank), points)


def row_radii(
    profile: Profile, start: float, n: int, size_at: Callable[[Floats], Floats] | None, graded_middles: bool = False
) -> Floats:
    """Radii (2n + 1,) [mm] of the nodes of n cells along the flank, from radius `start` [mm] to the tip.

    size_at: relative length of the cells at radii [mm]; None: uniform.
    graded_middles: see `SectorResolution`.
    On a chamfer or a rounding the cells are about as long as below it.
    """
    base, edge = profile.gear.base_radius, profile.edge
    end = profile.gear.tip_form_diameter / 2
    ends = profile.roll_length(np.array([start, end])) ** 2 / (2 * base)
    arc = np.linspace(ends[0], ends[1], TABLE)
    density = 1 / size_at(profile.radius(np.sqrt(2 * base * arc))) if size_at else np.ones(TABLE)
    count = np.concatenate([[0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    last = 0
    if edge is not None:
        share = edge.length * density[-1] / (count[-1] * (arc[1] - arc[0]))
        wanted = n * share / (1 + share)
        last = 1 if wanted < SHORT_EDGE else min(max(COARSE_ROW, round(wanted)), n - 1)
        n -= last
    if graded_middles:
        nodes = np.interp(np.linspace(0, count[-1], 2 * n + 1), count, arc)
    else:
        nodes = subdivided(np.interp(np.linspace(0, count[-1], n + 1), count, arc), 2)
    radii = profile.radius(np.sqrt(2 * base * nodes))
    radii[[0, -1]] = start, end
    return np.asarray(radii) if edge is None else np.concatenate([radii, edge.radii(2 * last)[1:]])
