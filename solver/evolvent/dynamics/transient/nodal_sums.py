"""Moments, modal forces and resultants of a pair's contact forces, summed over the nodes of the flanks.

The step is solved in the jumps of the contact (pair_step.py). Here the forces on both gears, in the gears' own frames,
are summed at the nodes on which they act: as moments about the axes, forces on the modes, and resultants.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class NodalSums:
    """Sums of the contact forces over the nodes of the flanks at one time."""

    modal: Floats
    """Forces (m,) on the modes of both gears [N·mm per unit amplitude]."""
    torques: tuple[float, float]
    """Torques that the contact takes from pinion and wheel about their axes, signed as in `PositionResult` [N·mm; N in
    2D]."""
    resultants: Floats
    """Resultant forces (2, d) on pinion and wheel in the common frame [N; N/mm in 2D]."""
    about_pinion: tuple[float, float]
    """Moments of the forces on pinion and wheel, both about the pinion's axis [N·mm; N in 2D]."""

    @staticmethod
    def of(pair: MovingPair, searched: PairRotation, result: PositionResult) -> NodalSums:
        """Sums of the contact forces of a result. searched: where the gears stood in the search, in whose frames the
        forces are."""
        rows, forces = (result.pinion_rows, result.wheel_rows), (result.pinion_forces, result.wheel_forces)
        torques, resultants, about_pinion = [], [], []
        for member, own, force in zip(Member, rows, forces):
            body, d = pair.model.bodies[member], force.shape[1]
            points, R = _points(body, own), searched.rotation(member, d)
            placed, pushed = points @ R.T + searched.centre(member, d), force @ R.T
            torques.append(-_moment(points, force))
            resultants.append(pushed.sum(axis=0))
            about_pinion.append(_moment(placed, pushed))
        return NodalSums(
            pair.modal_forces(result), (torques[0], torques[1]), np.array(resultants),
            (about_pinion[0], about_pinion[1]),
        )


def _points(body: GearBody, rows: Ints) -> Floats:
    """Undeflected positions (k, d) of rows (k, 2) in the gear's frame."""
    d, points = body.d, body.flank.points[rows[:, 1]]
    turned = np.zeros_like(points)
    for tooth in np.unique(rows[:, 0]):
        here = rows[:, 0] == tooth
        turned[here] = points[here] @ turn(2.0 * np.pi * tooth / body.gear.z, d).T
    return turned


def _moment(points: Floats, forces: Floats) -> float:
    """Moment of forces at points about the z axis through the origin."""
    return float(np.sum(points[:, 0] * forces[:, 1] - points[:, 1] * forces[:, 0]))
