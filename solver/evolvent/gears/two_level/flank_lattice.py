"""The nodes of a swept flank as a lattice: rows along the profile, levels along the face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent_meshes.arrays import Floats, Ints, different

SAME = 1e-6
"""Radii or heights closer than this are one row or level [mm]."""


@dataclass(frozen=True)
class FlankLattice:
    """A flank of R × L second-order cells.

    points: (2R + 1, 2L + 1, 3) by rows from the root to the tip, and levels of z [mm].
    nodes: (2R + 1, 2L + 1) their numbers.
    """

    points: Floats
    nodes: Ints

    @staticmethod
    def of(points: Floats) -> FlankLattice:
        """The lattice of a flank's nodes (n, 3) [mm]. Raises ValueError where they are none."""
        (radius, row), (height, level) = (
            different(values, SAME) for values in (np.hypot(points[:, 0], points[:, 1]), points[:, 2])
        )
        nodes = np.full((len(radius), len(height)), -1)
        nodes[row, level] = np.arange(len(points))
        if nodes.size != len(points) or nodes.min() < 0:
            raise ValueError(
                f"flank: wanted a lattice of nodes, found {len(points)} on {len(radius)} radii and "
                f"{len(height)} heights"
            )
        return FlankLattice(points[nodes], nodes)

    @property
    def cells(self) -> tuple[int, int]:
        """Rows R and layers L of cells."""
        rows, levels = self.nodes.shape
        return rows // 2, levels // 2

    @property
    def radius(self) -> Floats:
        """Radius (2R + 1,) of each row [mm]."""
        return np.hypot(self.points[:, 0, 0], self.points[:, 0, 1])

    @property
    def height(self) -> Floats:
        """Height (2L + 1,) of each level [mm]."""
        return self.points[0, :, 2]

    def place(self, points: Floats) -> Ints:
        """Row and level (n, 2) of some of its points (n, 3)."""
        radius = np.hypot(points[:, 0], points[:, 1])
        rows = np.searchsorted(self.radius, radius - SAME)
        return np.column_stack([rows, np.searchsorted(self.height, points[:, 2] - SAME)])

    def interpolation(self, points: Floats) -> sp.csr_matrix:
        """Interpolation (n, nodes) from values at the nodes to those at points (n, 3) of the flank, linear between four
        nodes."""
        radius = np.hypot(points[:, 0], points[:, 1])
        (row, along), (level, across) = _place(self.radius, radius), _place(self.height, points[:, 2])
        corners = [(i, j) for i in (0, 1) for j in (0, 1)]
        weights = [np.abs(1 - i - along) * np.abs(1 - j - across) for i, j in corners]
        nodes = [self.nodes[row + i, level + j] for i, j in corners]
        rows = np.tile(np.arange(len(points)), 4)
        matrix = sp.csr_matrix((np.concatenate(weights), (rows, np.concatenate(nodes))), (len(points), self.nodes.size))
        matrix.data[np.abs(matrix.data) < SAME] = 0.0
        matrix.eliminate_zeros()
        return matrix

    def edges(self) -> Floats:
        """Longest edge along the profile and along the face (2,) [mm]."""
        corners = self.points[::2, ::2]
        return np.array([np.linalg.norm(np.diff(corners, axis=axis), axis=-1).max() for axis in (0, 1)])


def _place(grid: Floats, values: Floats) -> tuple[Ints, Floats]:
    """Interval (n,) of a grid that holds each value, or is nearest, and where in it (n,), from 0 to 1."""
    interval = np.clip(np.searchsorted(grid, values, side="right") - 1, 0, len(grid) - 2)
    width = grid[interval + 1] - grid[interval]
    return interval, np.clip((values - grid[interval]) / width, 0.0, 1.0)

