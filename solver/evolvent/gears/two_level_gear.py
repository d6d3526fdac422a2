"""A gear condensed in levels: coarse sectors closed to the ring, and finer levels on the loaded flanks."""

from __future__ import annotations

import time
from contextlib import nullcontext
from dataclasses import replace

import numpy as np

from evolvent.contact.nitsche.flux_recovery import SAFETY, nitsche_traction
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.meshing.levelled_meshes import LevelledMesh, unmodified
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.two_level.flank_refinement import FlankRefinement, refined_levels
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.flank_points import on_flank


def two_level_gear(
    problem: GearProblem, member: Member, sector: LevelledMesh, threads: Threads = nullcontext
) -> GearBody:
    """Condenses the coarse sector and corrects its compliance on the levels of its flank.

    Raises NotPositiveDefinite, OutOfMemory.
    """
    gear, material, begin = problem.pair.gears[member], problem.materials[member], time.perf_counter()
    safety = SAFETY if member is Member.PINION else None
    teeth = problem.contact_teeth
    coarse = condensed_gear(unmodified(gear), sector.mesh, material, teeth, member, False, threads=threads)
    fine, refined = refined_levels(_refinement(problem, member, sector), safety)
    traction = None if safety is None else nitsche_traction(fine.mesh, material, fine.surface, safety)
    assert isinstance(coarse.chain, ChainedCompliance)
    ring = TwoLevelRing(coarse.chain, coarse.flank, refined, 2.0 * np.pi / gear.z)
    spent, flank = time.perf_counter() - begin - coarse.assemble_seconds, modified_flank(fine.surface, gear)
    return replace(
        coarse, gear=gear, flank=flank, traction=traction, chain=ring, condense_seconds=spent, levels=sector.levels
    )  # fmt: skip


def levelled_flank(problem: GearProblem, member: Member, sector: LevelledMesh) -> Surface:
    """The finest level of the flank with its modifications, as `two_level_gear` has it."""
    *_, finest = _refinement(problem, member, sector).bodies()
    return modified_flank(finest.fine.surface, problem.pair.gears[member])


def _refinement(problem: GearProblem, member: Member, sector: LevelledMesh) -> FlankRefinement:
    plain = unmodified(problem.pair.gears[member])
    return FlankRefinement(plain, sector.mesh, problem.materials[member], sector.levels)


def modified_flank(flank: Surface, gear: GearParameters) -> Surface:
    """A flank, condensed without the gear's modifications, with them."""
    if gear.modifications.is_empty:
        return flank
    return Surface.from_arrays(on_flank(gear, flank.points), flank.facets, flank.shape, flank.order, flank.nodes)
