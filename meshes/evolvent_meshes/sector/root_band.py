"""Outline from the flank start over fillet and root arc to the cut, and the band of cells below it."""

from __future__ import annotations

import numpy as np
from scipy.integrate import cumulative_trapezoid

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.profile import Profile, mirror, polar
from evolvent_meshes.sector.section_blocks import TABLE, Piece, graded_fractions, grid_piece, half_steps

FIRST_CELL_ASPECT = 2.0
"""Largest length of the band's first cell over its width; beyond, the cells that join three layers are too slanted."""


class RootBand:
    """Band of cells, one cell thick, along one side of the root.

    A coordinate q numbers the cells from 0 (flank start) over `neck` (where half of the fillet's turn is reached) to
    `cells` (cut). Nodes of the outline are exact. On each side of `neck` the cells have equal lengths along the middle
    of the band; above it they grow towards it where the first would be much longer than the band is wide. The inner
    side is straight within each cell: a curved one would move its middle nodes off the middle below a tight fillet.
    """

    def __init__(
        self, profile: Profile, start: float, cells: tuple[int, int], widths: tuple[float, float], mirrored: bool
    ) -> None:
        """The band of a profile.

        start: flank start radius [mm].
        cells: number of cells down to the middle of the fillet, and in all.
        widths: width of the band at the first row and at the cut [mm].
        mirrored: whether it lies at θ < 0.
        """
        self.neck, self.cells = cells
        self.widths, self.mirrored = widths, mirrored
        self._profile, self._start = profile, start
        self._ends = self._segment_ends()
        arc = np.linspace(0, self._ends[-1], TABLE)
        points, direction = self._outline(arc), self._directions(arc)
        inward = np.column_stack([-np.sin(direction), np.cos(direction)])
        offset = np.linspace(*widths, TABLE)[:, None] * inward
        self._arcs = self._cell_arcs(arc, direction, points + 0.5 * offset)
        corners = np.stack([np.interp(self._arcs, arc, (points + offset)[:, k]) for k in (0, 1)], axis=1)
        fade = np.clip(1 - self._arcs / self._arcs[self.neck], 0, 1)[:, None] ** 2
        first = polar(start, float(profile.angle(start)) - widths[0] / start)
        self._inner = corners + fade * (first - corners[0])

    def _segment_ends(self) -> Floats:
        """Arc lengths (4,) [mm] at which involute, fillet and root arc begin and end."""
        base, lengths = self._profile.gear.base_radius, self._profile.arc_lengths
        roll, form = float(self._profile.roll_length(self._start)), max(self._profile.roll_lengths[0], 0.0)
        above = max((roll**2 - form**2) / (2 * base), 0.0)
        return np.cumsum([0.0, above, lengths["fillet"], lengths["root"]])

    def _outline(self, arc: Floats) -> Floats:
        """Exact points (n, 2) at arc lengths [mm] from the flank start, at θ > 0."""
        _, form, root, cut = self._ends
        square = self._profile.roll_length(self._start) ** 2 - 2 * self._profile.gear.base_radius * arc
        on_involute = self._profile.involute_at_roll(np.sqrt(np.maximum(square, 0.0)))
        on_fillet = self._profile.fillet(np.clip(1 - (arc - form) / (root - form), 0, 1))
        on_root = self._profile.root_arc(np.clip(1 - (arc - root) / max(cut - root, 1e-12), 0, 1))
        return np.where((arc < form)[:, None], on_involute, np.where((arc <= root)[:, None], on_fillet, on_root))

    def _directions(self, arc: Floats) -> Floats:
        """Angles (n,) [rad] of the outline's tangent, towards the cut."""
        tangent = np.gradient(self._outline(arc), arc, axis=0)
        direction = np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0]))
        at_cut = np.pi / 2 + self._profile.sector_angle  # exactly: there the band's depth runs along the cut
        direction[-1] = at_cut + 2 * np.pi * np.round((direction[-1] - at_cut) / (2 * np.pi))
        return np.asarray(direction)

    def _cell_arcs(self, arc: Floats, direction: Floats, middle_line: Floats) -> Floats:
        """Arc lengths (cells + 1,) [mm] of the cell ends."""
        turned = abs(direction - direction[0])
        speed = np.linalg.norm(np.gradient(middle_line, arc, axis=0), axis=1)
        length = cumulative_trapezoid(speed, arc, initial=0)
        half = length[np.argmax(turned >= 0.5 * turned.max())]
        above = half * graded_fractions(half, FIRST_CELL_ASPECT * self.widths[0], self.neck)
        below = np.linspace(half, length[-1], self.cells - self.neck + 1)
        wanted = np.concatenate([above, below[1:]])
        return np.interp(wanted, length, arc)

    def _turned(self, points: Floats) -> Floats:
        return mirror(points) if self.mirrored else points

    def surface(self, q: Floats) -> Floats:
        """Points (n, 2) [mm] of the outline at coordinates q (n,)."""
        return self._turned(self._outline(np.interp(q, np.arange(self.cells + 1), self._arcs)))

    def inner(self, q: Floats) -> Floats:
        """Points (n, 2) [mm] of the inner side at coordinates q (n,); it starts at the inner end of the first row."""
        columns = [np.interp(q, np.arange(self.cells + 1), self._inner[:, k]) for k in (0, 1)]
        return self._turned(np.stack(columns, axis=1))

    def band(self, first: int = 0) -> Piece:
        """The cells from number `first` to the cut."""
        q = half_steps(first, self.cells)
        surface, inner = self.surface(q), self.inner(q)
        return grid_piece(np.stack([surface, 0.5 * (surface + inner), inner], axis=1))
