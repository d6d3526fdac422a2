"""Normal displacements of a gear's flanks under loads along their normals, between the nodes of all teeth.

A flank is a lattice: rows of nodes at radii, levels at heights. Loads and displacements are along the normals of the
helicoid there, towards the tooth; of the displacements of a condensed gear no more enters a line contact without
friction. Friction acts along the profile, in the transverse section; it moves the flanks along their normals too.
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
    nodes: Ints
    """(n,) numbers on the condensed flank of the nodes, which here are numbered by rows."""
    inwards: Floats
    """(n, d) normals of the helicoid at the nodes of tooth 0, towards the tooth."""
    towards_tip: Floats
    """(n, d) tangents of the profile at the nodes of tooth 0, in the transverse section."""
    between_nodes: DirectedCompliance
    """Between the nodes of all teeth, numbered by rows."""
    by_friction: DirectedCompliance | None = None
    """Displacements along the normals under forces along the profile towards the tip; None where there is no friction.
    """

    @staticmethod
    def of(body: GearBody, friction: bool = False) -> FlankCompliance:
        """The compliance of a gear that was condensed for line contact. friction: whether tangential loads act."""
        chain, points, base = body.chain, body.flank.points, body.gear.base_radius
        assert isinstance(chain, ChainedCompliance)
        lattice, flank = FlankLattice.of(np.pad(points, ((0, 0), (0, 3 - body.d)))), Flank(body.gear)
        roll = flank.roll_length(lattice.radius)
        inwards = -flank.helicoid_normal(roll[:, None], lattice.height)[..., : body.d]
        nodes, across = lattice.nodes.ravel(), inwards.reshape(-1, body.d)
        along = _towards_tip(across, points[nodes])
        tangential = chain.directed(nodes, across, along) if friction else None
        return FlankCompliance(
            body.gear, body.member.sign, roll**2 / (2.0 * base), lattice.height, nodes, across, along,
            chain.directed(nodes, across), tangential,
        )

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


def _towards_tip(normals: Floats, points: Floats) -> Floats:
    """Unit tangents (n, d) of the profile in the transverse section, towards the tip, from the normals (n, d) of the
    flank at its points (n, d) [mm]."""
    tangents = np.zeros_like(normals)
    tangents[:, 0], tangents[:, 1] = -normals[:, 1], normals[:, 0]
    outwards = np.sum(tangents[:, :2] * points[:, :2], axis=1)
    return np.asarray(tangents * (np.sign(outwards) / np.linalg.norm(tangents, axis=1))[:, None])


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
