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
from evolvent.gears.meshing.flank_levels import levelled_sector
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.two_level.flank_refinement import FlankRefinement, refined_levels
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.gear_geometry import Modifications
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.flank_points import on_flank
from evolvent_meshes.sector.sector import sector_mesh


def levelled_mesh(problem: GearProblem, member: Member) -> MeshData:
    """The coarse sector without flank modifications, which do not change the compliance. Raises MeshError."""
    return sector_mesh(_unmodified(problem.pair.gears[member]), levelled_sector(problem, member).coarse)


def two_level_gear(
    problem: GearProblem, member: Member, mesh: MeshData, threads: Threads = nullcontext
) -> GearBody:
    """Condenses the coarse sector and corrects its compliance on the levels of its flank.

    mesh: `levelled_mesh`. Raises NotPositiveDefinite, OutOfMemory.
    """
    gear, material, begin = problem.pair.gears[member], problem.materials[member], time.perf_counter()
    safety = SAFETY if member is Member.PINION else None
    plain, levels = _unmodified(gear), levelled_sector(problem, member).levels
    coarse = condensed_gear(plain, mesh, material, problem.contact_teeth, member, False, threads=threads)
    fine, refined = refined_levels(FlankRefinement(plain, mesh, material, levels), safety)
    flank = fine.surface if gear.modifications.is_empty else _modified(fine.surface, gear)
    traction = None if safety is None else nitsche_traction(fine.mesh, material, fine.surface, safety)
    assert isinstance(coarse.chain, ChainedCompliance)
    ring = TwoLevelRing(coarse.chain, coarse.flank, refined, 2.0 * np.pi / gear.z)
    spent = time.perf_counter() - begin - coarse.assemble_seconds
    return replace(coarse, gear=gear, flank=flank, traction=traction, chain=ring, condense_seconds=spent)


def _unmodified(gear: GearParameters) -> GearParameters:
    return replace(gear, modifications=Modifications())


def _modified(flank: Surface, gear: GearParameters) -> Surface:
    """A flank with the gear's modifications."""
    return Surface.from_arrays(on_flank(gear, flank.points), flank.facets, flank.shape, flank.order, flank.nodes)
