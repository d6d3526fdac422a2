"""What a tooth loses in one mesh passage, gathered in the moving frame of the contact line.

All teeth are alike, so the positions of a pitch are one tooth's passage. At a position the ridge of pressure lies at a
distance s across the contact line; to the neighbouring positions it travels over the flank with the line and changes
little. So each contact point is a parcel that goes with the line, over the step before its position and the one after,
while its share rises and falls linearly: that is the ridge interpolated linearly in ξ at fixed s. It takes away

    (K/H) w λ ∫ B(η) |v_s(ξ + η)| dη / r_b1 ,   v_s(ξ + η) = v_s(ξ) + (1 + 1/u) η per radian of the pinion,

B the hat of the step, at the places that it passes. A parcel that leaves the flank stays at its rim, where the tip's
edge bears instead. The volume is the integral of the parcels' work, whatever the step.
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

FINE = 0.5  # of the grid's finest spacing a parcel goes at a time


@dataclass(frozen=True)
class Passage:
    """One mesh passage at K/H = 1, linear in the pressures λ (q,) of all points of all positions.

    depths: of pinion and wheel flank, (n, q) [mm per MPa·mm²/N], per passage of a tooth of each. works: (q,) w ∫B|v_s|
    [mm³; mm² in 2D]. pressure: (q,) of the positions [MPa].
    """

    depths: tuple[sp.csc_matrix, sp.csc_matrix]
    works: Floats
    pressure: Floats

    @staticmethod
    def nothing(grids: tuple[FlankGrid, FlankGrid]) -> Passage:
        """Of no points."""
        none, (pinion, wheel) = np.zeros(0), (sp.csc_matrix((grid.node.size, 0)) for grid in grids)
        return Passage((pinion, wheel), none, none)

    @property
    def work(self) -> float:
        """∫∫p|v_s| dA dt [N·mm; per mm of width in 2D]."""
        return float(self.works @ self.pressure)


def passage(
    pair: GearPair, positions: Sequence[ContactPoints], grids: tuple[FlankGrid, FlankGrid], turn: float
) -> Passage:
    """Of some of the positions that stand equal steps `turn` [rad of the pinion] apart over one pitch."""
    if not positions:
        return Passage.nothing(grids)
    step = pair.pinion.base_radius * turn
    count = max(int(np.ceil(step / (FINE * np.diff(grid.arcs).min()))) for grid in grids)
    η = step * ((np.arange(-count, count) + 0.5) / count)
    points = ContactPoints.joined(positions)
    works = _shares(pair, points.sliding / (1.0 + 1.0 / pair.ratio), η, step) * points.weights[:, None]
    depths = []
    for gear, s in zip(Member, (points.across, points.opposite)):
        u = line_arc(pair, gear, points.ξ[:, None] + η) + s[:, None]
        depths.append(grids[gear].gathered(u, points.z, works))
    return Passage((depths[0], depths[1]), works.sum(axis=1), points.pressure)


def _shares(pair: GearPair, ξ: Floats, η: Floats, step: float) -> Floats:
    """(q, e) parts of the sliding distance [mm] ∫B|v_s| dη/r_b1 of each parcel, whose sliding is the nominal one at
    roll distances ξ (q,): by midpoints, their sum exact."""
    rough = (1.0 - np.abs(η) / step) * np.abs(ξ[:, None] + η)
    x = np.minimum(np.abs(ξ) / step, 1.0)
    whole = np.where(np.abs(ξ) >= step, np.abs(ξ), step * (1.0 / 3.0 + x**2 - x**3 / 3.0))
    scale = step * (1.0 + 1.0 / pair.ratio) / pair.pinion.base_radius
    return np.asarray(rough * (scale * whole / rough.sum(axis=1))[:, None])
