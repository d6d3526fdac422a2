"""Root stress of a certified pitch, with further positions around its largest values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import GearModel
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.solution.certified_pitch import CertifiedPitch
from evolvent.strength.peak_positions import (
    Roots,
    Stored,
    SweptRoots,
    roots_of,
    solved_at_once,
    with_angles,
    with_peaks,
)
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True, eq=False)
class CertifiedRoots:
    """Root stress over a pitch."""

    further: tuple[float, ...]
    """Pinion rotations of the further positions, ascending [rad]."""
    roots: Roots
    """Root stress of both gears at each friction coefficient, at all positions."""


def certified_roots(
    gears: GearModel, problem: GearProblem, solved: CertifiedPitch, frictions: Sequence[float], comm: MPI.Comm,
    angles: Sequence[float] | None = None, stored: Stored = solved_at_once,
) -> CertifiedRoots:
    """Root stress of both gears over a certified pitch, at positions beside its uniform ones, too. Collective.

    gears: condensed from meshes of `root_meshes`.
    angles: pinion rotations of the further positions [rad]; None: those at which a tooth of a spur gear is loaded at
        its outer point of single or double contact, and those around the largest values (`with_peaks`).
    stored: see `Stored`.

    Raises NotConverged, SearchError, BalanceError.
    """
    uniform, model = solved.positions, replace(gears, deflected=solved.deflected)
    every = SweptRoots(uniform, on_first(comm, lambda: roots_of(model, uniform)))
    wanted = outer_points(problem) if angles is None else angles
    every = with_angles(model, every, wanted, frictions, comm, stored)
    if angles is None:  # after the outer points, which narrow the intervals, too
        every = with_peaks(model, every, frictions, comm, stored)
    known = {each.angle for each in uniform}
    return CertifiedRoots(tuple(sorted(each.angle for each in every.positions if each.angle not in known)), every.roots)


def outer_points(problem: GearProblem) -> list[float]:
    """Pinion rotations in [0, pitch) at which teeth of spur gears are loaded at `RootLoad.outer_point` [rad]."""
    if problem.pair.pinion.helix_angle_deg > 0.0:
        return []
    loads = (RootLoad(problem.pair, member, problem.pinion_torque) for member in Member)
    pitch = 2.0 * math.pi / problem.pair.pinion.z
    return [load.tooth_rotation(load.outer_point.below_tip) % pitch for load in loads]
