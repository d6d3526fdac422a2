"""The torque that holds a gear pair: constant, or repeating with the mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True, eq=False)
class TorqueCourse:
    """How a torque varies over an angular pitch, linearly between equidistant phases."""

    shares: Floats
    """(n,) of the constant torque, at phases 0, 1/n, ... of the pitch."""
    teeth: int
    """Of the pinion."""

    def at(self, angle: float) -> float:
        """Share at a pinion rotation [rad]."""
        n = len(self.shares)
        phase = angle * self.teeth / (2.0 * np.pi)
        return float(np.interp(phase * n, np.arange(n), self.shares, period=n))


@dataclass(frozen=True)
class GearLoad:
    """A torque on one gear; the other one is driven."""

    torque: float
    """[N·mm; per mm of face width in 2D]."""
    on: Member = Member.PINION
    """The gear with the torque."""
    course: TorqueCourse | None = None
    """How it varies with the mesh; None: not at all."""

    def at(self, angle: float) -> float:
        """The torque at a pinion rotation [rad]; [N·mm; per mm of face width in 2D]."""
        return self.torque if self.course is None else self.torque * self.course.at(angle)


def gear_load(problem: GearProblem) -> GearLoad:
    """The torque, per mm of face width where the problem is plane."""
    return GearLoad(problem.torque / (problem.pair.face_width if problem.is_plane else 1.0), problem.torque_on)
