"""Root stress of a certified pitch, with further positions around its largest values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import GearModel
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.solution.certificates import certify
from evolvent.gears.solution.certified_pitch import CertifiedPitch, Observer, certified_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.strength.peak_positions import Roots, SweptRoots, roots_of, with_angles, with_peaks
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True, eq=False)
class CertifiedRoots:
    """A pitch with root stress."""

    solved: CertifiedPitch
    """Uniform positions of the pitch."""
    further: tuple[float, ...]
    """Pinion rotations of the further positions, ascending [rad]."""
    roots: Roots
    """Root stress of both gears at each friction coefficient, at all positions."""


def certified_roots(
    gears: GearModel, problem: GearProblem, pitch: Pitch, frictions: Sequence[float], comm: MPI.Comm,
    observe: Observer = lambda _: None, angles: Sequence[float] | None = None,
) -> CertifiedRoots:
    """Root stress of both gears over a pitch, at positions beside its uniform ones, too. Collective.

    gears: condensed from meshes of `root_meshes`. observe: called with each uniform position.
    angles: pinion rotations of the further positions [rad]; None: those at which a tooth of a spur gear is loaded at
        its outer point of single or double contact, and those around the largest values (`with_peaks`).

    Raises NotConverged, SearchError, BalanceError.
    """
    solved = certified_pitch(gears, pitch, frictions, comm, observe)
    uniform, model = solved.positions, replace(gears, deflected=solved.deflected)
    every = SweptRoots(uniform, on_first(comm, lambda: roots_of(model, uniform)))
    every = with_angles(model, every, outer_points(problem) if angles is None else angles, frictions, comm)
    if angles is None:  # after the outer points, which narrow the intervals, too
        every = with_peaks(model, every, frictions, comm)
    known = {each.angle for each in uniform}
    further = sorted((each for each in every.positions if each.angle not in known), key=lambda each: each.angle)
    for position in further:
        certify(position.results)
    return CertifiedRoots(solved, tuple(each.angle for each in further), every.roots)


def outer_points(problem: GearProblem) -> list[float]:
    """Pinion rotations in [0, pitch) at which teeth of spur gears are loaded at `RootLoad.outer_point` [rad]."""
    if problem.pair.pinion.helix_angle_deg > 0.0:
        return []
    loads = (RootLoad(problem.pair, member, problem.pinion_torque) for member in Member)
    pitch = 2.0 * math.pi / problem.pair.pinion.z
    return [load.tooth_rotation(load.outer_point.below_tip) % pitch for load in loads]
