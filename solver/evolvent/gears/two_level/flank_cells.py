"""The facets of a swept flank by row and layer: the facet and the reference coordinates of a place on the flank."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.fem.reference_facets import reference_cell
from evolvent.fem.surface import Surface
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.arrays import Bools, Floats, Ints

CORNERS = np.array([[0, 0], [1, 0], [0, 1], [1, 1]])
"""Row and layer of a cell's corners, over those of the cell."""


@dataclass(frozen=True)
class FlankCells:
    """Second-order facets of a swept flank as R × L cells, rows from root to tip, layers along the face.

    arc: (2R + 1,) profile arc of the rows of nodes, from the base circle on [mm].
    height: (2L + 1,) of the levels of nodes [mm].
    facets: (R, L) facet of each cell.
    axes: (m, 3, 2) of each facet: reference coordinates of the cell's first corner, and how they grow along the
        profile and along the face.
    """

    arc: Floats
    height: Floats
    facets: Ints
    axes: Floats

    @staticmethod
    def of(lattice: FlankLattice, surface: Surface, base_radius: float) -> FlankCells:
        """The cells of a flank with nodes on a lattice. base_radius: of the gear [mm]."""
        row, level = np.empty((2, lattice.nodes.size), dtype=np.int64)
        row[lattice.nodes] = np.arange(lattice.nodes.shape[0])[:, None]
        level[lattice.nodes] = np.arange(lattice.nodes.shape[1])
        corners = surface.facets[:, :4]
        i, k = row[corners] // 2, level[corners] // 2
        first = i.min(axis=1), k.min(axis=1)
        facets = np.full(lattice.cells, -1)
        facets[first] = np.arange(len(surface.facets))
        which = (i - first[0][:, None]) + 2 * (k - first[1][:, None])
        at = reference_cell(surface.shape, surface.order).nodes[:4][np.argsort(which, axis=1)]
        axes = np.stack([at[:, 0], at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]], axis=1)
        arc = np.maximum(lattice.radius**2 - base_radius**2, 0.0) / (2.0 * base_radius)
        return FlankCells(arc, lattice.height, facets, axes)

    def place(self, arc: Floats, height: Floats) -> FlankPlaces:
        """Places on the flank with profile arcs and heights (q,) [mm], or nearest to them on its edges."""
        row, t = _within(self.arc, arc)
        layer, s = _within(self.height, height)
        return FlankPlaces(row, layer, np.column_stack([t, s]))

    def reference(self, places: FlankPlaces) -> tuple[Ints, Floats]:
        """Facets (q,) and reference coordinates (q, 2) of places."""
        facets = self.facets[places.row, places.layer]
        axes = self.axes[facets]
        return facets, axes[:, 0] + np.einsum("qs,qsa->qa", places.at, axes[:, 1:])

    def is_inner(self, places: FlankPlaces) -> Bools:
        """Whether places lie on cells (q,) bool that are not at the edge of the flank."""
        rows, layers = self.facets.shape
        across = (places.row > 0) & (places.row < rows - 1)
        return np.asarray(across & (places.layer > 0) & (places.layer < layers - 1))

    def is_beyond(self, places: FlankPlaces, part: float) -> Bools:
        """Whether places lie beyond the edges of the flank (q,) bool, by more than a part of their cells."""
        cell, last = np.column_stack([places.row, places.layer]), np.array(self.facets.shape) - 1
        before, after = (cell == 0) & (places.at < -part), (cell == last) & (places.at > 1.0 + part)
        return np.asarray((before | after).any(axis=1))

    def slopes(self, places: FlankPlaces) -> Floats:
        """Growth (q, 2) of profile arc and height with the coordinates in the cells [mm]."""
        parts = []
        for nodes, cell, t in zip((self.arc, self.height), (places.row, places.layer), places.at.T):
            a, m, b = (nodes[2 * cell + i] for i in range(3))
            parts.append(4.0 * m - 3.0 * a - b + 4.0 * (a - 2.0 * m + b) * t)
        return np.stack(parts, axis=1)

    def arc_of(self, places: FlankPlaces) -> Floats:
        """Profile arcs (q,) of places [mm]; beyond a cell its own are continued."""
        t = places.at[:, 0]
        a, m, b = (self.arc[2 * places.row + i] for i in range(3))
        return np.asarray(a + (4.0 * m - 3.0 * a - b) * t + 2.0 * (a - 2.0 * m + b) * t**2)

    def moved(self, places: FlankPlaces, xi: Floats) -> FlankPlaces:
        """Places with other reference coordinates (q, 2) on the same facets, which may lie beyond these: then on the
        neighbouring cell, as far as there is one."""
        axes = self.axes[self.facets[places.row, places.layer]]
        at = np.einsum("qa,qsa->qs", xi - axes[:, 0], axes[:, 1:])  # the axes are unit vectors
        rows, layers = self.facets.shape
        step = np.clip(np.floor(at), -1, 1).astype(np.int64)
        row, layer = (np.clip(old + by, 0, n - 1) for old, by, n in
                      ((places.row, step[:, 0], rows), (places.layer, step[:, 1], layers)))
        return FlankPlaces(row, layer, at - np.column_stack([row - places.row, layer - places.layer]))


@dataclass(frozen=True)
class FlankPlaces:
    """Places on a flank.

    row, layer: (q,) of the cells.
    at: (q, 2) coordinates in the cell along the profile and along the face, from 0 to 1 within it.
    """

    row: Ints
    layer: Ints
    at: Floats

    def of(self, chosen: Ints | Bools) -> FlankPlaces:
        """Some of the places."""
        return FlankPlaces(self.row[chosen], self.layer[chosen], self.at[chosen])

    def replaced(self, which: Ints, others: FlankPlaces) -> FlankPlaces:
        """The places, of which some (k,) are others."""
        row, layer, at = self.row.copy(), self.layer.copy(), self.at.copy()
        row[which], layer[which], at[which] = others.row, others.layer, others.at
        return FlankPlaces(row, layer, at)


def _within(nodes: Floats, values: Floats) -> tuple[Ints, Floats]:
    """Cell (q,) of a line of second-order cells in which values (q,) lie, and the coordinates (q,) there: 0, ½ and 1 at
    its nodes (2n + 1,). Values beyond the line have its ends."""
    cell = np.clip(np.searchsorted(nodes[::2], values, side="right") - 1, 0, len(nodes) // 2 - 1)
    a, m, b = (nodes[2 * cell + i] for i in range(3))
    bend, slope = 2.0 * (a - 2.0 * m + b), 4.0 * m - 3.0 * a - b  # value = a + slope t + bend t²
    root = np.sqrt(np.maximum(slope**2 + 4.0 * bend * (values - a), 0.0))
    return cell, np.clip(2.0 * (values - a) / (slope + root), 0.0, 1.0)
