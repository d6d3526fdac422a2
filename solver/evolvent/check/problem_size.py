"""Size and memory of a scene, estimated without meshing it, and whether the machine has this memory."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from evolvent.check.levels_memory import levels_megabytes
from evolvent.fem.parallel.machine import machine_megabytes
from evolvent.gears.meshing.companion_meshes import coarser_levels
from evolvent.gears.meshing.element_sizes import ELEMENTS_PER_WIDTH, sector_resolution
from evolvent.gears.meshing.flank_levels import levelled_sector
from evolvent.gears.meshing.levelled_meshes import is_two_level
from evolvent.gears.meshing.root_meshes import finer_roots
from evolvent.gears.meshing.sector_sizes import SectorSize, levelled_sizes, one_mesh_sizes, root_dofs, sector_size
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import LINE
from evolvent.scene.scene import Scene
from evolvent.scene.schema.bodies import FEWEST_ELEMENTS, Level
from evolvent.scene.schema.errors import InputProblem, SceneError, shown
from evolvent.scene.schema.output import ExactSection
from evolvent.scene.schema.strength import StrengthSection
from evolvent.scene.skips import wanted_output
from evolvent_meshes.gears.member import Member

if TYPE_CHECKING:
    from mpi4py import MPI

MEGABYTES_BASE = {2: 150.0, 3: 250.0}
MEGABYTES_PER_DOF = {2: 2.5e-3, 3: 1e-2}
DENSE_COPIES = 1.65
"""Memory of a run by dimension: constant part, part per degree of freedom, and copies of each dense matrix. Compared
with 25 runs of 0.2 to 23 GB (Yang's pair of both orders and shapes up to 829,020 degrees of freedom, He's in 3D;
docs/benchmark.md) the estimate is from 12 % low to 35 % high, from 2 GB on from 12 % low to 20 % high."""
SELDOM_AT_ONCE = 0.75
"""Part of the memory of eliminating the coarse sectors of both gears that two ranks take together: each is at its
largest for a moment (whole runs on flanks in levels, docs/benchmark.md)."""
MOST_MODES, SQUARES_PER_TOOTH = 300, 6
"""Modes that couple the teeth of a ring (200 in Yang's pair at quick), and square matrices of this size for each tooth
(`evolvent.gears.ring.ring_modes`): negligible but for hundreds of teeth where far ones are not skipped."""
NUMBERS_KEPT = 6
"""Archived numbers of a position's result, over the degrees of freedom of the pinion's loaded flank: 3 in 2D, 5 in 3D.
"""
MEGABYTES_PER_MESHED_DOF = 6e-4
"""Memory of `evolvent mesh`, which keeps both sectors and checks their cells: of tetrahedra; hexahedra need 4e-4."""
MemoryEstimate = Callable[[Scene, int], float]
"""(scene, ranks on the machine) -> memory of a command [MB]."""
MOST_DOUBLINGS = 60
"""Largest number of doublings of the torque in search of one with which a mesh fits."""
LEVELS: tuple[Level, ...] = ("fine", "standard", "quick")


def sector_sizes(scene: Scene) -> tuple[SectorSize, SectorSize]:
    """Sizes of the sectors of (pinion, wheel) that are condensed: coarse ones where flanks have levels of their own."""
    problem = gear_problem(scene)
    if not is_two_level(problem):
        return one_mesh_sizes(problem)
    pinion, wheel = levelled_sizes(problem)
    return pinion.sector, wheel.sector


def flank_dofs(scene: Scene) -> tuple[int, int]:
    """Degrees of freedom of the flanks of (pinion, wheel) that contact is computed on."""
    problem = gear_problem(scene)
    sizes = levelled_sizes(problem) if is_two_level(problem) else one_mesh_sizes(problem)
    return sizes[0].flank, sizes[1].flank


def memory_megabytes(scene: Scene, ranks: int = 1) -> float:
    """Largest memory [MB] of a run on so many ranks of one machine."""
    return _condensing_megabytes(scene, ranks, _factored_sizes(scene)) + results_megabytes(scene)


def strength_megabytes(scene: Scene, ranks: int = 1) -> float:
    """Largest memory [MB] of `evolvent strength`. Its sectors have finer roots than those of a run, and condense them,
    too."""
    problem, times = gear_problem(scene), (scene.strength or StrengthSection()).root_refinement
    pinion, wheel = (_with_roots(problem, member, times) for member in Member)
    return _condensing_megabytes(scene, ranks, (pinion, wheel)) + results_megabytes(scene)


def _with_roots(problem: GearProblem, member: Member, times: int) -> SectorSize:
    """Size of a sector with finer roots."""
    levelled = is_two_level(problem)
    sector = levelled_sector(problem, member).coarse if levelled else sector_resolution(problem, member)
    finer, order, plane = finer_roots(sector, times), problem.mesh.order, problem.is_plane
    size = sector_size(finer, order, plane, problem.pair.gears[member])
    return replace(size, roots=root_dofs(finer, order, plane))


def _condensing_megabytes(scene: Scene, ranks: int, sizes: tuple[SectorSize, SectorSize]) -> float:
    """Memory [MB] of condensing bodies of these sizes. One rank holds one gear's elimination beside the other gear's
    compliance, several ranks both eliminations at once."""
    problem, (pinion, _) = gear_problem(scene), sizes
    dimension = 2 if problem.is_plane else 3
    first, second = (
        MEGABYTES_PER_DOF[dimension] * size.dofs + DENSE_COPIES * _square_megabytes(size.flank + size.cuts + size.roots)
        for size in sizes
    )
    gears = first + second if ranks > 1 else max(first, second + _square_megabytes(pinion.flank))
    far = 2 * len(problem.contact_teeth) if problem.options.all_teeth else 0
    modes = min(MOST_MODES, max(size.cuts for size in sizes))
    ring = far * SQUARES_PER_TOOTH * _square_megabytes(modes)
    if is_two_level(problem):
        gears *= SELDOM_AT_ONCE if ranks > 1 else 1.0
        sectors = [levelled_sector(problem, member) for member in Member]
        companion = [coarser_levels(sector) for sector in sectors] if wanted_output(scene).error_bars else sectors
        gears = max(gears, levels_megabytes(sectors, ranks), levels_megabytes(companion, ranks))
    return ranks * MEGABYTES_BASE[dimension] + gears + ring


def result_count(scene: Scene) -> int:
    """Number of archived results: positions of all pitches at all friction coefficients and all reports of wear."""
    pairs = 1 if scene.wear is None else 1 + len(scene.wear.reports)
    return pairs * gear_problem(scene).pitches * scene.sweep.positions * len(scene.contact.friction)


def results_megabytes(scene: Scene) -> float:
    """Memory [MB] of all results, which are loaded together for tables and pictures."""
    return 8e-6 * NUMBERS_KEPT * flank_dofs(scene)[0] * result_count(scene)


def mesh_megabytes(scene: Scene, ranks: int = 1) -> float:
    """Largest memory [MB] of `evolvent mesh`, where the first rank meshes both sectors."""
    dofs = sum(size.dofs for size in sector_sizes(scene))
    return ranks * MEGABYTES_BASE[2] + MEGABYTES_PER_MESHED_DOF * dofs


MEMORY_OF: Mapping[str, MemoryEstimate] = MappingProxyType(
    {"run": memory_megabytes, "mesh": mesh_megabytes, "strength": strength_megabytes}
)
"""Command -> estimate of its memory; commands that condense a run's meshes have a run's."""


def _factored_sizes(scene: Scene) -> tuple[SectorSize, SectorSize]:
    """Sizes of the bodies that are eliminated for (pinion, wheel): a sector, or the whole gear."""
    problem, (pinion, wheel) = gear_problem(scene), sector_sizes(scene)
    if not problem.options.whole_gears:
        return pinion, wheel
    teeth = len(problem.contact_teeth)
    return pinion.times(scene.pinion.teeth, teeth), wheel.times(scene.wheel.teeth, teeth)


def _square_megabytes(rows: int) -> float:
    """Memory [MB] of a dense square matrix."""
    return 8e-6 * rows**2


def room_problem(scene: Scene, needed: MemoryEstimate, processes: int = 1) -> InputProblem | None:
    """The problem where a command needs more memory than this machine or container has, None where it fits.

    needed: memory of the command. processes: ranks on this machine.
    """
    there, wanted = machine_megabytes(), needed(scene, processes)
    if wanted <= there:
        return None
    allowed = f"what fits into {gigabytes(there)}, the memory of this machine or container"
    kept = 0.0 if needed is mesh_megabytes else results_megabytes(scene)
    if kept > 0.5 * wanted and wanted - kept <= there:
        count, of = result_count(scene), "positions, times friction coefficients, pitches and reports of wear"
        found = f"{scene.sweep.positions}: {counted(count)} results ({of}) that want about {gigabytes(kept)}"
        found += f" of {gigabytes(wanted)} in all"
        remedy = "take fewer positions, friction coefficients or reports, or a coarser mesh; --force goes on"
        return InputProblem("sweep.positions", found, allowed, remedy)
    name = "level" if scene.mesh.elements_per_contact_width is None else "elements_per_contact_width"
    ranks = f" on {processes} ranks" if processes > 1 else ""
    finer = " and finer roots" if needed is strength_megabytes else ""
    needs = f"{_counted_dofs(scene)}{finer} that want about {gigabytes(wanted)}{ranks}"
    found = f"{shown(getattr(scene.mesh, name))}, {needs}"
    return InputProblem(f"mesh.{name}", found, allowed, f"{_remedy(scene, needed, processes, there)}; --force goes on")


def _counted_dofs(scene: Scene) -> str:
    """Degrees of freedom of both gears, in words."""
    flanks = f" and {counted(sum(flank_dofs(scene)))} of fine flanks" if is_two_level(gear_problem(scene)) else ""
    return f"{counted(sum(size.dofs for size in sector_sizes(scene)))} degrees of freedom{flanks}"


def require_memory(scene: Scene, needed: MemoryEstimate, comm: MPI.Comm | None) -> None:
    """Raises SceneError on all ranks where one of their machines has too little memory. Collective.

    comm: the ranks that take part; None: this process alone, without MPI.
    """
    found = room_problem(scene, needed, 1 if comm is None else _ranks_of_machine(comm))
    for problem in [found] if comm is None else comm.allgather(found):
        if problem is not None:
            raise SceneError([problem])


def _ranks_of_machine(comm: MPI.Comm) -> int:
    """Number of ranks on this machine. Collective."""
    from mpi4py import MPI

    node = comm.Split_type(MPI.COMM_TYPE_SHARED)
    count: int = node.size
    node.Free()
    return count


def gigabytes(megabytes: float) -> str:
    """Memory in GB with three digits."""
    value = megabytes / 1e3
    return f"{value:.3g} GB" if value < 1e3 else f"{value:,.0f} GB" if value < 1e6 else f"{value:.1e} GB"


def counted(number: int) -> str:
    """A count with separators between thousands, with an exponent from 1e9 on."""
    return f"{number:,}" if number < 1e9 else f"{number:.1e}"


def _remedy(scene: Scene, needed: MemoryEstimate, processes: int, there: float) -> str:
    """The finest settings with which the command fits into the memory `there` [MB], in words."""
    if processes > 1 and needed(scene, 1) <= there:
        return "run on one rank"
    if lightest := _lightest_that_fits(scene, needed, processes, there):
        return f"leave out loads below about {lightest:.3g} N·m (--percent, load_case), or take a coarser mesh"
    for words, other in _coarser(scene):
        if (wanted := needed(other, processes)) <= there:
            return f"take {words} ({gigabytes(wanted)})"
    for doublings in range(1, MOST_DOUBLINGS):
        torque = scene.load.torque_Nm * 2.0**doublings
        other = scene.changed("mesh", level="quick", elements_per_contact_width=None).changed("load", torque_Nm=torque)
        if needed(other, processes) <= there:
            return f"no mesh fits: the contact is too narrow. From about {torque:.4g} N·m on --level quick does"
    return "no mesh fits: take narrower gears, or a machine with more memory"


def _lightest_that_fits(scene: Scene, needed: MemoryEstimate, processes: int, there: float) -> float | None:
    """The lightest torque [N·m], in steps of two, that the meshes of a load list may serve within the memory `there`
    [MB]; None where none does, or the scene is no load list's."""
    lightest, heaviest = scene.load.mesh_torques_Nm or (0.0, 0.0)
    while 0.0 < (lightest := 2.0 * lightest) <= heaviest:
        served = lightest, heaviest
        scenes = (scene.changed("load", torque_Nm=each, mesh_torques_Nm=served) for each in served)
        if all(needed(each, processes) <= there for each in scenes):
            return lightest
    return None


def _coarser(scene: Scene) -> Iterator[tuple[str, Scene]]:
    """Ever coarser scenes, each with the command-line options for it: first with all shortcuts, then at coarser levels,
    then with fewer elements across the contact."""
    long_ways = [name for name in ("one-sector", "coarse-body", "two-level", "plane") if name in scene.exact.parts]
    if long_ways:
        kept = ExactSection(parts=tuple(name for name in scene.exact.parts if name not in long_ways))
        scene = scene.model_copy(update={"exact": kept})
        yield f"{' and '.join(long_ways)} out of exact.parts (--exact)", scene
    if scene.mesh.level == LINE:
        return
    if (count := scene.mesh.elements_per_contact_width) is None:
        for level in LEVELS[LEVELS.index(scene.mesh.level) + 1 :]:
            yield f"--level {level}", scene.changed("mesh", level=level)
        scene, prefix, count = scene.changed("mesh", level="quick"), "--level quick ", ELEMENTS_PER_WIDTH["quick"]
    else:
        prefix = ""
    for tenths in range(math.ceil(10 * count) - 1, round(10 * FEWEST_ELEMENTS) - 1, -1):
        words = f"{prefix}--set mesh.elements_per_contact_width={tenths / 10:g}"
        yield words, scene.changed("mesh", elements_per_contact_width=tenths / 10)
