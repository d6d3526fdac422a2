"""Normal displacements of a gear's flanks under loads along their normals, between the nodes of all teeth.

A flank is a lattice: rows of nodes at radii, levels at heights. Loads and displacements are along the normals of the
helicoid there, towards the tooth; of the displacements of a condensed gear no more enters a line contact without
friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.ring.ring_compliance import ChainedCompliance, DirectedCompliance
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters


@dataclass(frozen=True, eq=False)
class FlankCompliance:
    """Compliance of the flanks of a gear along their normals."""

    gear: GearParameters
    """Geometry of the gear."""
    sign: int
    """Tooth pair i has tooth sign·i."""
    arcs: Floats
    """(R,) arc ρ²/2r_b of the rows of nodes, ascending towards the tip [mm]."""
    heights: Floats
    """(L,) heights of the levels of nodes, ascending [mm]; 0 alone in the plane."""
    between_nodes: DirectedCompliance
    """Between the nodes of all teeth, numbered by rows."""

    @staticmethod
    def of(body: GearBody) -> FlankCompliance:
        """The compliance of a gear that was condensed for line contact."""
        chain, points, base = body.chain, body.flank.points, body.gear.base_radius
        assert isinstance(chain, ChainedCompliance)
        lattice, flank = FlankLattice.of(np.pad(points, ((0, 0), (0, 3 - body.d)))), Flank(body.gear)
        roll = flank.roll_length(lattice.radius)
        normals = flank.helicoid_normal(roll[:, None], lattice.height)[..., : body.d]
        directed = chain.directed(lattice.nodes.ravel(), normals.reshape(-1, body.d))
        return FlankCompliance(body.gear, body.member.sign, roll**2 / (2.0 * base), lattice.height, directed)

    def shapes(self, arc: Floats, z: Floats) -> sp.csr_matrix:
        """Shape functions (p, nodes) at points of the flank, at arcs (p,) and heights (p,) [mm]."""
        rows, along = quadratic_shapes(self.arcs, arc)
        if len(self.heights) == 1:
            levels, across = np.zeros((len(z), 1), dtype=int), np.ones((len(z), 1))
        else:
            levels, across = quadratic_shapes(self.heights, z)
        nodes = rows[:, :, None] * len(self.heights) + levels[:, None, :]
        values = along[:, :, None] * across[:, None, :]
        count = nodes[0].size if len(nodes) else 1
        ends = count * np.arange(len(arc) + 1)
        return sp.csr_matrix((values.ravel(), nodes.ravel(), ends), (len(arc), len(self.arcs) * len(self.heights)))


def quadratic_shapes(grid: Floats, values: Floats) -> tuple[Ints, Floats]:
    """Nodes (p, 3) and shape functions (p, 3) of a line of second-order cells with nodes at `grid` (2n + 1,), at
    `values` (p,). The cells map ξ of [−1, 1] by the same shape functions."""
    cell = np.clip(np.searchsorted(grid[::2], values, side="right") - 1, 0, len(grid) // 2 - 1)
    nodes = 2 * cell[:, None] + np.arange(3)
    low, middle, high = grid[nodes].T
    half, bend = 0.5 * (high - low), 0.5 * (high + low) - middle
    target = values - middle  # = half ξ + bend ξ²
    ξ = 2.0 * target / (half + np.sqrt(np.maximum(half**2 + 4.0 * bend * target, 0.0)))
    return nodes, np.stack([0.5 * ξ * (ξ - 1.0), 1.0 - ξ**2, 0.5 * ξ * (ξ + 1.0)], axis=1)
