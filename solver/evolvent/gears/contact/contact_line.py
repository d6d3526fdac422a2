"""The contact line of a tooth pair at a position without deflection, in profile arc and height on both flanks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from evolvent.fem.surface import Surface
from evolvent.gears.contact.moved_contact import farthest_moved, modified_depth, nearest_places
from evolvent.gears.contact.search_window import near_path
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.two_level.flank_cells import FlankCells
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

GROWTH = 0.5
"""Growth of cells towards the middle of a line: at its ends, where the load falls within a few layers, they are as long
as a layer."""
BESIDE = (-3.0, -1.5, 0.0, 1.5, 3.0)
"""Distances from the line, in widths of a row, at which the gap is looked at along it: a contact is up to so wide, and
where a relief starts in it, it bends the gap beside the line before it does on it."""
TURN = 0.5
"""How far, in widths of a row, the line may turn aside from a straight one over a cell."""
SHORT = 1e-3
"""Part of a layer below which a piece of it is joined with its neighbour."""


@dataclass(frozen=True)
class ContactLine:
    """Contact line of a tooth pair: where conjugate flanks touch or, with modifications along the profile, are nearest.
    In slices where that of conjugate flanks has left a flank, the end of the path of contact there.

    flanks: cells of the flanks of pinion and wheel.
    stand: angular position of the gears.
    tooth: number of the tooth pair.
    wheel_edges: heights (h,), and how far root and tip edge of the wheel's flank (2, h) lie on the pinion's from where
        they lie on conjugate flanks [mm of profile arc]; None where that is not known.
    """

    flanks: tuple[FlankCells, FlankCells]
    stand: PairRotation
    tooth: int
    wheel_edges: tuple[Floats, Floats] | None = None

    def arc(self, z: Floats) -> Floats:
        """Profile arc of the line on the pinion's flank at heights z, from the base circle on [mm]: where flanks with
        the gears' modifications are nearest to each other."""
        ξ = self.stand.roll_distance(self.tooth, z)
        if self._moved is not None:
            return self._arc(Member.PINION, ξ) + np.interp(z, *self._moved)
        return self._arc(Member.PINION, np.clip(ξ, *self.stand.pair.path_of_contact))

    @cached_property
    def _moved(self) -> tuple[Floats, Floats] | None:
        """Heights (h,) and how far the line lies from that of conjugate flanks there, profile arc on the pinion [mm];
        None without modifications along the profile."""
        if farthest_moved(self.stand.pair) == 0.0:
            return None
        z = self.flanks[Member.PINION].height
        ξ = self.stand.roll_distance(self.tooth, z)
        return z, nearest_places(self.stand.pair, ξ, z, self.edges(z, self._arc(Member.PINION, ξ)))

    def opposite(self, z: Floats, arc: Floats) -> Floats:
        """Profile arc on the wheel's flank opposite places at heights z and profile arcs on the pinion's [mm]: on
        conjugate flanks these are as far from the contact line, in either sense of the profiles."""
        ξ = self.stand.roll_distance(self.tooth, z)
        return self._arc(Member.WHEEL, ξ) - (arc - self._arc(Member.PINION, ξ))

    def _arc(self, gear: Member, ξ: Floats) -> Floats:
        """Profile arc on a gear's flank at roll distances ξ [mm]."""
        pair = self.stand.pair
        ρ = pair.pitch_point_roll_lengths[gear] + gear.sign * ξ
        return np.asarray(ρ**2 / (2.0 * pair.gears[gear].base_radius))

    def row_width(self, z: Floats) -> Floats:
        """Width of the rows of the pinion's flank where the line lies at heights z [mm of profile arc]."""
        limits = self.flanks[Member.PINION].arc[::2]
        return np.interp(self.arc(z), 0.5 * (limits[1:] + limits[:-1]), np.diff(limits))

    def edges(self, z: Floats, arc: Floats) -> tuple[Floats, Floats]:
        """Distances from places at heights z and profile arcs on the pinion's flank to the ends of what both flanks
        share there, towards the pinion's root and its tip [mm]."""
        own, (root, tip) = self.flanks[Member.PINION].arc, self.edges_of_wheel(z)
        return np.maximum(own[0], tip) - arc, np.minimum(own[-1], root) - arc

    def edges_of_wheel(self, z: Floats) -> tuple[Floats, Floats]:
        """Profile arcs on the pinion's flank that face root and tip edge of the wheel's at heights z [mm]."""
        other = self.flanks[Member.WHEEL].arc
        root, tip = (self.opposite(z, np.zeros_like(z)) - other[end] for end in (0, -1))
        if self.wheel_edges is None:
            return root, tip
        heights, away = self.wheel_edges
        return root + np.interp(z, heights, away[0]), tip + np.interp(z, heights, away[1])

    def distance(self, arc: Floats, z: Floats, surfaces: tuple[Surface, Surface]) -> Floats:
        """Distances (q,) along the pinion's normals between places that face each other on conjugate flanks [mm].

        arc, z: profile arcs on the pinion's flank and heights (q,) [mm].
        surfaces: flanks of pinion and wheel in place.
        """
        (first, second), (pinion, wheel) = surfaces, self.flanks
        facets, xi = pinion.reference(pinion.place(arc, z))
        x1, n = np.split(first.evaluate(np.hstack([first.points, first.normals]), facets, xi[:, None])[0][:, 0], 2, 1)
        facets, xi = wheel.reference(wheel.place(self.opposite(z, arc), z))
        between = second.positions(facets, xi[:, None])[:, 0] - x1
        return np.asarray(np.einsum("qa,qa->q", between, n) / np.linalg.norm(n, axis=1))

    def layer_limits(self, limits: Floats) -> Floats:
        """Heights between which the flanks' layers, and cells with limits (L + 1,), do not change [mm]."""
        layers = np.concatenate([flank.height[::2] for flank in self.flanks])
        inner = layers[(layers > limits[0]) & (layers < limits[-1])]
        return _without_short(inner, limits)

    def bend_of_gap(self, z: Floats) -> Floats:
        """Largest curvature (h,) along the line, over height, of the gap between the undeflected flanks in the layers
        about heights z [1/mm]: that of their modifications. At a kink it grows with the number of layers."""
        limits = self.flanks[Member.PINION].height[::2]
        return np.asarray(self._bend[np.clip(np.searchsorted(limits, z) - 1, 0, len(limits) - 2)])

    @cached_property
    def _bend(self) -> Floats:
        """Largest curvature (L,) of the gap, on the line and `BESIDE` it, at the limits of each layer of the pinion's
        flank and of its neighbours [1/mm]."""
        z = self.flanks[Member.PINION].height[::2]
        ξ, step = self.stand.roll_distance(self.tooth, z), np.diff(z)
        beside = np.array(BESIDE)[:, None] * self.row_width(z)
        depth = modified_depth(self.stand.pair, ξ, z, self.arc(z) - self._arc(Member.PINION, ξ) + beside)
        inner = np.abs(np.diff(np.diff(depth) / step) / (0.5 * (step[1:] + step[:-1]))).max(axis=0)
        about = np.lib.stride_tricks.sliding_window_view(np.pad(inner, 2, mode="edge"), 4)
        return np.asarray(about.max(axis=1))

    def cell_limits(self, length: Callable[[Floats], Floats], whole: bool = False) -> Floats:
        """Heights (L + 1,) that limit cells along the line [mm]; empty where the line has left the flanks.

        length: of cells at some heights (h,) [mm]; they are no shorter than a layer of the pinion's flank, and shorter
            where a line ends or turns.
        whole: all over the face, however far the line has left the path of contact.
        """
        pinion, wheel = (flank.height for flank in self.flanks)
        low, high = max(pinion[0], wheel[0]), min(pinion[-1], wheel[-1])
        layers = _without_short(pinion[::2][(pinion[::2] > low) & (pinion[::2] < high)], np.array([low, high]))
        near = near_path(self.stand, self.tooth, layers) | whole
        used = near[1:] | near[:-1]
        if not used.any():
            return np.zeros(0)
        first, last = np.flatnonzero(used)[[0, -1]]
        layers = layers[first : last + 2]
        bends = self._bends(layers[0], layers[-1])
        ends = np.concatenate([layers[:1], bends, layers[-1:]])
        layers = _without_short(layers[1:-1], ends)
        return np.concatenate([*(self._cells(layers, a, b, length) for a, b in pairwise(ends)), ends[-1:]])

    def _bends(self, low: float, high: float) -> Floats:
        """Heights (≤ 2,) between two at which the line of conjugate flanks leaves the path of contact [mm]."""
        ξ = self.stand.roll_distance(self.tooth, np.array([0.0, 1.0]))
        slope = ξ[1] - ξ[0]
        if slope == 0.0:
            return np.zeros(0)
        found = np.sort((np.array(self.stand.pair.path_of_contact) - ξ[0]) / slope)
        least = SHORT * (high - low)
        return found[(found > low + least) & (found < high - least)]

    def _cells(self, layers: Floats, low: float, high: float, length: Callable[[Floats], Floats]) -> Floats:
        """Heights from `low` to before `high` that limit cells between limits of layers."""
        here = layers[(layers >= low) & (layers <= high)]
        middle = 0.5 * (here[1:] + here[:-1])
        width, arc = self.row_width(middle), self.arc(here)
        slope = np.diff(arc) / np.diff(here)
        turn = np.pad(np.abs(np.diff(slope)), 1)  # at each limit
        size = np.diff(here) / length(middle)  # of a layer, in cells
        size = np.minimum(1.0, size + np.diff(here) * np.maximum(turn[1:], turn[:-1]) / (TURN * width))
        near = np.minimum(np.arange(len(size)), np.arange(len(size))[::-1])
        size = np.maximum(size, 1.0 / (1.0 + GROWTH * near))
        place = np.append(0.0, np.cumsum(size))
        count = max(1, int(np.ceil(place[-1] - 1e-9)))  # not fewer, so that those at the ends stay one layer long
        nearest = np.interp(np.linspace(0.0, place[-1], count + 1), place, np.arange(len(place)))
        return here[np.unique(np.rint(nearest).astype(int))][:-1]


def _without_short(inner: Floats, kept: Floats) -> Floats:
    """Limits of pieces: all of `kept`, and of `inner` those that are not next to one of them or to each other."""
    every = np.sort(np.concatenate([inner, kept]))
    least = SHORT * float(np.diff(every).max(initial=0.0))
    result = [float(kept[0])]
    for value in np.unique(every)[1:]:
        if value - result[-1] > least:
            result.append(float(value))
        elif value in kept:
            result[-1] = float(value)
    return np.array(result)
