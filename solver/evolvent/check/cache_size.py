"""Size of what is kept of a scene's condensed gears, estimated from their numbers of degrees of freedom."""

from __future__ import annotations

from evolvent.gears.meshing.levelled_meshes import is_two_level
from evolvent.gears.meshing.sector_sizes import SectorSize, levelled_sizes, one_mesh_sizes
from evolvent.gears.problem.gear_problem import GearProblem

LEVELS_PER_DOF, TRACTION_PER_DOF = 2.7e-3, 1.7e-3
"""Megabytes of the levels of a flank, per degree of freedom of the finest, and of the recovered traction of the pinion:
Yang's pair at standard."""


def kept_megabytes(problem: GearProblem) -> float:
    """Size [MB] of the entries of both gears, without those of the error bars' coarse gears; 0 where none are kept."""
    if problem.options.whole_gears:
        return 0.0
    if not is_two_level(problem):
        return sum(map(_sector_megabytes, one_mesh_sizes(problem)))
    sizes = levelled_sizes(problem)
    flanks = LEVELS_PER_DOF * sum(size.flank for size in sizes) + TRACTION_PER_DOF * sizes[0].flank
    return flanks + sum(_sector_megabytes(size.sector) for size in sizes)


def _sector_megabytes(size: SectorSize) -> float:
    """Compliance of the flank, transfer to the cut faces, their stiffness [MB]."""
    return 8e-6 * (size.flank**2 + size.flank * size.cuts + size.cuts**2)
