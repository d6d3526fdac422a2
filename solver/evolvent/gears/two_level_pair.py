"""Both gears in levels: each rank condenses some of the patches of both, and a coarse sector or none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mpi4py import MPI

from evolvent.fem.cache.cache import NOT_KEPT, Cache
from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.division import divided, exchanged
from evolvent.fem.parallel.memory import Stack, return_free_memory
from evolvent.fem.parallel.ranks import together
from evolvent.gears.condensed_gear import GearBody, in_words
from evolvent.gears.meshing.levelled_meshes import LevelledMesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.two_level.level_patches import COST
from evolvent.gears.two_level_gear import (
    CondensedFlanks,
    FlankPatches,
    PatchName,
    TimedResponse,
    coarse_gear,
    corrected_gears,
    flank_inputs,
)
from evolvent_meshes.gears.member import Member

SECTOR = 1.5
"""Time of a coarse sector, closed to the ring, over that of a patch with as many cells."""

NamedPatch = tuple[Member, PatchName]


def two_level_pair(
    problem: GearProblem, sectors: Mapping[Member, LevelledMesh], counts: Mapping[Member, Sequence[int]],
    comm: MPI.Comm, cores: Cores, cache: Cache = NOT_KEPT,
) -> dict[Member, dict[int, GearBody]]:
    """The gears whose sectors this rank has, with so many levels as each of the counts says: see `two_level_gear`.
    Collective: each rank has other sectors. cache: keeps coarse sectors and flanks.

    Raises NotPositiveDefinite, OutOfMemory, OSError.
    """
    names = {m: cache.name(flank_inputs(problem, m, sector, counts[m])) for m, sector in sectors.items()}
    about = {m: f"flank in levels, {in_words(problem.pair.gears[m])}" for m in sectors}
    kept = {m: found for m in sectors if (found := cache.read(names[m], CondensedFlanks, about[m])) is not None}

    def patches() -> dict[Member, FlankPatches]:
        return {m: FlankPatches.of(problem, m, sectors[m], counts[m]) for m in sectors if m not in kept}

    new = exchanged(comm, together(comm, patches, cores.lent))
    own = _division(new, comm.allgather(sum(_cost(sector) for sector in sectors.values())))[comm.rank]

    def condensed() -> tuple[dict[Member, GearBody], dict[NamedPatch, TimedResponse]]:
        bodies = {m: coarse_gear(problem, m, sector, cores.used, cache) for m, sector in sectors.items()}
        stack = Stack()
        return bodies, {(m, name): new[m].response(name, stack) for m, name in own}

    coarse, some = together(comm, condensed, cores.lent)
    responses = exchanged(comm, some)
    del some  # a hundred megabytes, and the ranks of a node share the others

    def corrected(member: Member) -> dict[int, GearBody]:
        known = {name: response for (m, name), response in responses.items() if m == member}
        body, sector, flanks = coarse[member], sectors[member], kept.get(member)
        if flanks is None:
            flanks = new[member].condensed(body.material, known)
            cache.write(names[member], flanks, CondensedFlanks, about[member])
        return corrected_gears(problem, body, sector, flanks, sum(each.seconds for each in known.values()))

    gears = together(comm, lambda: {member: corrected(member) for member in sectors}, cores.lent)
    return_free_memory()  # of the patches; positions want less at once
    return gears


def _division(flanks: Mapping[Member, FlankPatches], busy: list[float]) -> list[list[NamedPatch]]:
    """The patches of each rank; busy: cost of the coarse sectors of each."""
    patches = {(m, name): patch for m in sorted(flanks) for name, patch in flanks[m].named().items()}
    names = list(patches)
    return [[names[task] for task in own] for own in divided([patches[name].cost for name in names], busy)]


def _cost(sector: LevelledMesh) -> float:
    """Estimated cost of a coarse sector, closed to the ring, in the measure of `LoadedPatch.cost`."""
    return SECTOR * float(len(sector.mesh.cells)) ** COST
