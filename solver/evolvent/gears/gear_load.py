"""The torque that holds a gear pair: constant, or repeating with the mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True, eq=False)
class TorqueCourse:
    """Variation of a torque over an angular pitch, linear between equidistant phases."""

    shares: Floats
    """Torque over the constant torque (n,), at phases 0, 1/n, ... of the pitch."""
    teeth: int
    """Number of teeth of the pinion."""

    def at(self, angle: float) -> float:
        """Torque over the constant torque at a pinion rotation [rad]."""
        n = len(self.shares)
        phase = angle * self.teeth / (2.0 * np.pi)
        return float(np.interp(phase * n, np.arange(n), self.shares, period=n))


@dataclass(frozen=True)
class GearLoad:
    """A torque on one gear; the rotation of the other one is prescribed."""

    torque: float
    """Torque [N·mm; per mm of face width in 2D]."""
    on: Member = Member.PINION
    """Gear on which the torque acts."""
    course: TorqueCourse | None = None
    """Variation of the torque over an angular pitch; None: constant."""
    driving: Member = Member.PINION
    """Gear that drives the other one: the pinion turns counter-clockwise where it drives, clockwise where the wheel
    drives on the same flanks."""

    def at(self, angle: float) -> float:
        """The torque at a pinion rotation [rad]; [N·mm; per mm of face width in 2D]."""
        return self.torque if self.course is None else self.torque * self.course.at(angle)


def gear_load(problem: GearProblem) -> GearLoad:
    """The torque, per mm of face width where the problem is plane."""
    torque = problem.torque / (problem.pair.face_width if problem.is_plane else 1.0)
    return GearLoad(torque, problem.torque_on, driving=problem.driving)
