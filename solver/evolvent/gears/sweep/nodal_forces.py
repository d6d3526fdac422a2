"""Forces on the flanks of one gear at several positions, on the same rows of its compliance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True, eq=False)
class NodalForces:
    """Forces of n positions."""

    rows: Ints
    """(k, 2) tooth and flank node that bear load at some position, ascending."""
    forces: Floats
    """(n, k, d) in the gear's own frame [N; per mm of width in 2D]."""


def nodal_forces(results: Sequence[PositionResult], member: Member) -> NodalForces:
    """Of the pinion's or the wheel's flanks."""
    pinion = member is Member.PINION
    rows = [each.pinion_rows if pinion else each.wheel_rows for each in results]
    forces = [each.pinion_forces if pinion else each.wheel_forces for each in results]
    every, place = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    whole = np.zeros((len(results), len(every), forces[0].shape[1]))
    whole[np.repeat(np.arange(len(rows)), [len(own) for own in rows]), place.ravel()] = np.concatenate(forces)
    return NodalForces(every, whole)
