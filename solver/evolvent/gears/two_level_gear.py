"""A gear condensed in levels: coarse sectors closed to the ring, and finer levels on the loaded flanks."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.nitsche.flux_recovery import SAFETY, nitsche_stabiliser
from evolvent.fem.cache.cache import NOT_KEPT, Cache
from evolvent.fem.material import Material
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.parallel.memory import Stack
from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.meshing.levelled_meshes import LevelledMesh
from evolvent.gears.meshing.sector_meshes import unmodified
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.two_level.flank_refinement import FlankRefinement, RefinedFlank, patches_of_levels
from evolvent.gears.two_level.level_patches import Block, BlockResponse, LevelPatches, LoadedPatch
from evolvent.gears.two_level.refined_level import RefinedLevel
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_digest import mesh_digest
from evolvent_meshes.sector.flank_points import on_flank

PatchName = tuple[int, Block]
"""Level of a patch, and its coarse cells with forces."""


@dataclass(frozen=True)
class TimedResponse:
    """Response of a patch, and the time to compute it."""

    response: BlockResponse
    seconds: float
    """Wall time of the condensation [s]."""


@dataclass(frozen=True)
class FlankPatches:
    """The patches that a gear's flank needs, and the levels from their responses.

    counts: after how many levels contact is computed; see `patches_of_levels`.
    levels: patches of each level, from the coarsest to the finest.
    patches: the same, level by level, as they are condensed.
    flux_safety: factor on the stabilisation of Nitsche's method, of the pinion, which has the pressure side; else None.
    """

    counts: tuple[int, ...]
    levels: tuple[LevelPatches, ...]
    patches: tuple[tuple[LoadedPatch, ...], ...]
    flux_safety: float | None

    @staticmethod
    def of(
        problem: GearProblem, member: Member, sector: LevelledMesh, counts: Sequence[int], safety: float = SAFETY
    ) -> FlankPatches:
        """Patches of the pinion's or the wheel's flank. safety: factor on the stabilisation of Nitsche's method."""
        flux_safety = safety if member is Member.PINION else None
        levels = patches_of_levels(_refinement(problem, member, sector), counts, flux_safety)
        patches = tuple(tuple(each.patches()) for each in levels)
        return FlankPatches(tuple(counts), tuple(levels), patches, flux_safety)

    def named(self) -> dict[PatchName, LoadedPatch]:
        """All patches by name."""
        levels = enumerate(self.patches)
        return {(level, patch.block): patch for level, patches in levels for patch in patches}

    def response(self, name: PatchName, stack: Stack) -> TimedResponse:
        """Condenses a patch. stack: memory of the patches, one after the other. Raises NotPositiveDefinite,
        OutOfMemory."""
        begin = time.perf_counter()
        response = self.levels[name[0]].response(self.named()[name], stack)
        return TimedResponse(response, time.perf_counter() - begin)

    def condensed(self, material: Material, responses: Mapping[PatchName, TimedResponse]) -> CondensedFlanks:
        """The flank with so many levels as each of the counts says. responses: of all patches."""
        by_level = [
            {block: each.response for (level, block), each in responses.items() if level == number}
            for number in range(len(self.levels))
        ]
        result: CondensedFlanks = {}
        for count, levels in RefinedFlank(self.levels, by_level).levels(self.counts).items():
            fine, safety = self.levels[count - 1].surface, self.flux_safety
            γ = None if safety is None else nitsche_stabiliser(fine.mesh, material, fine.surface, safety)
            result[count] = CondensedFlank(fine.surface, γ, tuple(levels))
        return result


@dataclass(frozen=True)
class CondensedFlank:
    """A flank with some of its levels, condensed without the modifications of the gear."""

    surface: Surface
    """Finest of the levels."""
    stabiliser: Floats | None
    """Stabiliser γ and γ_t (n, 2) of Nitsche's method [MPa/mm], of the pinion; else None."""
    levels: tuple[RefinedLevel, ...]
    """Levels from the coarsest to the finest."""


CondensedFlanks = dict[int, CondensedFlank]
"""Flanks of a gear by their numbers of levels."""


def flank_inputs(problem: GearProblem, member: Member, sector: LevelledMesh, counts: Sequence[int]) -> object:
    """All that the `CondensedFlanks` of a gear depend on."""
    plain, material = unmodified(problem.pair.gears[member]), problem.materials[member]
    safety = SAFETY if member is Member.PINION else None
    return "levels", plain, mesh_digest(sector.mesh), material.elasticity, sector.levels, tuple(counts), safety


def two_level_gear(
    problem: GearProblem, member: Member, sector: LevelledMesh, threads: Threads = nullcontext, safety: float = SAFETY
) -> GearBody:
    """Condenses the coarse sector and corrects its compliance on all levels of its flank, all on this rank. safety: see
    `FlankPatches.of`.

    Raises NotPositiveDefinite, OutOfMemory.
    """
    count = len(sector.levels)
    coarse = coarse_gear(problem, member, sector, threads)
    patches, stack = FlankPatches.of(problem, member, sector, [count], safety), Stack()
    responses = {name: patches.response(name, stack) for name in patches.named()}
    return corrected_gears(problem, coarse, sector, patches.condensed(coarse.material, responses))[count]


def coarse_gear(
    problem: GearProblem, member: Member, sector: LevelledMesh, threads: Threads, cache: Cache = NOT_KEPT
) -> GearBody:
    """The coarse sector, condensed and closed to the ring. Raises NotPositiveDefinite, OutOfMemory."""
    gear, material = unmodified(problem.pair.gears[member]), problem.materials[member]
    teeth = problem.contact_teeth
    return condensed_gear(gear, sector.mesh, material, teeth, member, False, threads=threads, cache=cache)


def corrected_gears(
    problem: GearProblem, coarse: GearBody, sector: LevelledMesh, flanks: CondensedFlanks, seconds: float = 0.0
) -> dict[int, GearBody]:
    """The gear with each of the flanks, by their numbers of levels. seconds: wall time of condensing the flanks [s]."""
    pitch, gear = 2.0 * np.pi / coarse.gear.z, problem.pair.gears[coarse.member]
    assert isinstance(coarse.chain, ChainedCompliance)
    return {
        count: replace(
            coarse, gear=gear, flank=modified_flank(flank.surface, gear), stabiliser=flank.stabiliser,
            chain=TwoLevelRing(coarse.chain, coarse.flank, flank.levels, pitch), levels=sector.levels[:count],
            condense_seconds=coarse.condense_seconds + seconds,
        )
        for count, flank in flanks.items()
    }


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
