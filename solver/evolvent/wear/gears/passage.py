"""The worn depth of one mesh passage of a tooth, accumulated in the moving frame of the contact line.

All teeth are alike, so the positions of a pitch make up one tooth's passage. At a position the pressure ridge lies at a
distance s across the contact line; until the neighbouring positions it moves over the flank with the line and hardly
changes. So each contact point is carried along with the line, over the step before its position and the one after, and
its share rises and falls linearly: this interpolates the ridge linearly in ξ at fixed s. Along its path it removes

    (K/H) w λ ∫ B(η) |v_s(ξ + η)| dη / r_b1 ,   v_s(ξ + η) = v_s(ξ) + (1 + 1/u) η per radian of the pinion,

B the hat function of the step. A point that leaves the flank stays at its rim, where the tip edge bears. The worn
volume is the integral of p|v_s| for any step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

PATH_STEP = 0.5  # of the grid's finest spacing: integration step along a point's path


@dataclass(frozen=True)
class MeshPassage:
    """One mesh passage at K/H = 1, linear in the pressures λ (q,) of all points of all positions.

    depths: of pinion and wheel, nodal depths (n, q) per unit pressure at the points [mm per MPa·mm²/N].
    swept_volumes: (q,) w ∫B|v_s| of the points [mm³; mm² in 2D].
    pressure: (q,) [MPa].
    """

    depths: tuple[sp.csc_matrix, sp.csc_matrix]
    swept_volumes: Floats
    pressure: Floats

    @staticmethod
    def empty(grids: tuple[FlankGrid, FlankGrid]) -> MeshPassage:
        """A passage without contact points."""
        none, (pinion, wheel) = np.zeros(0), (sp.csc_matrix((grid.node.size, 0)) for grid in grids)
        return MeshPassage((pinion, wheel), none, none)

    @property
    def work(self) -> float:
        """∫∫p|v_s| dA dt [N·mm; per mm of width in 2D]."""
        return float(self.swept_volumes @ self.pressure)


def mesh_passage(
    pair: GearPair, positions: Sequence[ContactPoints], grids: tuple[FlankGrid, FlankGrid], step_angle: float
) -> MeshPassage:
    """The contribution of some positions of a pitch to a mesh passage.

    positions: contact points of each.
    grids: of pinion and wheel flank.
    step_angle: pinion rotation between the positions of the pitch [rad].
    """
    if not positions:
        return MeshPassage.empty(grids)
    step = pair.pinion.base_radius * step_angle
    count = max(int(np.ceil(step / (PATH_STEP * np.diff(grid.arcs).min()))) for grid in grids)
    η = step * ((np.arange(-count, count) + 0.5) / count)
    points = ContactPoints.joined(positions)
    swept = _sliding_shares(pair, points.sliding / (1.0 + 1.0 / pair.ratio), η, step) * points.weights[:, None]
    depths = []
    for gear, s in zip(Member, (points.across, points.opposite)):
        u = line_arc(pair, gear, points.roll_distance[:, None] + η) + s[:, None]
        depths.append(grids[gear].depths_from_volumes(u, points.z, swept))
    return MeshPassage((depths[0], depths[1]), swept.sum(axis=1), points.pressure)


def _sliding_shares(pair: GearPair, ξ: Floats, η: Floats, step: float) -> Floats:
    """Parts (q, e) of the sliding distance ∫B|v_s| dη/r_b1 [mm] of points along their paths η (e,) [mm].

    ξ: (q,) roll distances at which the nominal sliding is that of the points [mm]. By the midpoint rule, scaled to the
    exact sum.
    """
    rough = (1.0 - np.abs(η) / step) * np.abs(ξ[:, None] + η)
    x = np.minimum(np.abs(ξ) / step, 1.0)
    whole = np.where(np.abs(ξ) >= step, np.abs(ξ), step * (1.0 / 3.0 + x**2 - x**3 / 3.0))
    scale = step * (1.0 + 1.0 / pair.ratio) / pair.pinion.base_radius
    return np.asarray(rough * (scale * whole / rough.sum(axis=1))[:, None])
