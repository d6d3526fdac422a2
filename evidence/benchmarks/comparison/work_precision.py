"""Work against precision on round contacts: seconds and errors of every program on the same meshes."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path

from evidence.benchmarks.comparison.pressure import Pressure, Reference
from evidence.benchmarks.comparison.programs import EVOLVENT, Program, Solved, solve
from evidence.benchmarks.comparison.round_contacts import Hertz, cylinder, line_contact, point_contact, sphere
from evidence.benchmarks.comparison.task import Task
from evidence.processes import Cost, RunFailed, empty_cache

TASK = "task.npz"


@dataclass(frozen=True)
class Mesh:
    """A mesh of a case."""

    cells: float
    """On a half-width of contact."""
    order: int
    shape: str


@dataclass(frozen=True)
class Case:
    """A round contact, its meshes and those of its overkill solution."""

    name: str
    dimension: int
    task: Callable[[float, int, str], Task]
    hertz: Hertz
    meshes: tuple[Mesh, ...]
    overkill: tuple[Mesh, Mesh]
    """A coarser and a finer one."""
    repeats: int
    """How often each program runs."""


@dataclass(frozen=True)
class Sizes:
    """Cells on a half-width, and repeats, of a case."""

    first: tuple[float, ...]
    """Of first-order cells."""
    second: tuple[float, ...]
    overkill: tuple[float, float]
    repeats: int = 1


def line_case(sizes: Sizes) -> Case:
    """A cylinder on a block, in plane strain."""
    shapes = "quadrilateral", "triangle"
    return Case("hertz2d", 2, cylinder, line_contact(), *_meshes(shapes, sizes), sizes.repeats)


def point_case(sizes: Sizes) -> Case:
    """A quarter of a ball on a block."""
    return Case("hertz3d", 3, sphere, point_contact(), *_meshes(("hexahedron", "tetrahedron"), sizes), sizes.repeats)


def _meshes(shapes: tuple[str, str], sizes: Sizes) -> tuple[tuple[Mesh, ...], tuple[Mesh, Mesh]]:
    """Those that are compared, and those of the overkill solution."""
    orders = (1, sizes.first), (2, sizes.second)
    coarse, fine = (Mesh(cells, 2, shapes[0]) for cells in sizes.overkill)
    return tuple(Mesh(n, k, s) for s in shapes for k, cells in orders for n in cells), (coarse, fine)


FULL = {
    "hertz2d": line_case(Sizes((8, 16, 32, 48), (4, 8, 16), (32, 64), 3)),
    "hertz3d": point_case(Sizes((4, 8, 12), (2, 4), (6, 8))),
}
SMALL = {
    "hertz2d": line_case(Sizes((8,), (4,), (16, 32))),
    "hertz3d": point_case(Sizes((4,), (2,), (4, 6))),
}


@dataclass(frozen=True)
class OverkillRow:
    """An overkill solution, and by what it differs from a coarser one: relative errors."""

    force: float
    """[N; N/mm]."""
    peak: float
    """[MPa]."""
    half_width: float
    """[mm]."""
    force_error: float
    peak_error: float
    profile_error: float


@dataclass(frozen=True)
class Row:
    """A program on a mesh."""

    case: str
    program: str
    shape: str
    order: int
    cells: float
    dofs: int
    wall: float = nan
    """Of the whole process without meshing, median [s]; `cpu` likewise."""
    cpu: float = nan
    cold: float = nan
    """CPU time of a first run, which compiles its forms [s]."""
    ratio: float = nan
    """CPU time over Evolvent's: median over runs side by side."""
    memory_MB: float = nan
    iterations: int = 0
    force_error: float = nan
    """Relative, as that of the fitted peak and of the pressure (L2)."""
    peak_error: float = nan
    profile_error: float = nan
    note: str = ""
    """Why there is nothing."""


def overkill(case: Case, folder: Path) -> tuple[Reference, OverkillRow]:
    """Of two solutions of Evolvent on meshes finer than any that is compared. Raises RunFailed."""
    coarse, fine = (_solved_pressure(case, mesh, folder) for mesh in case.overkill)
    a = case.hertz.half_width
    nearly, exact = (Reference.fitted(pressure, a, case.dimension) for pressure in (coarse, fine))
    errors = abs(coarse.force / fine.force - 1.0), abs(coarse.peak(a) / fine.peak(a) - 1.0)
    return exact, OverkillRow(
        fine.force, fine.peak(a), exact.half_width, *errors, nearly.distance(exact, case.dimension)
    )


def _solved_pressure(case: Case, mesh: Mesh, folder: Path) -> Pressure:
    task = case.task(mesh.cells, mesh.order, mesh.shape)
    task.write(folder / TASK)
    return Pressure.of(task, solve(EVOLVENT, folder / TASK, folder).answer)


def rows(
    case: Case, peers: Sequence[Program], reference: Reference, known: OverkillRow, folder: Path
) -> Iterator[Row]:
    """One row a mesh and a program, the programs of a mesh side by side."""
    compiled: set[tuple[str, int]] = set()
    for mesh in case.meshes:
        task = case.task(mesh.cells, mesh.order, mesh.shape)
        task.write(folder / TASK)
        programs = [EVOLVENT, *(p for p in peers if p.takes(task))]
        solutions, failed = _side_by_side(programs, folder, case.repeats)
        cold = nan
        if (mesh.shape, mesh.order) not in compiled:
            compiled.add((mesh.shape, mesh.order))
            cold = solve(EVOLVENT, folder / TASK, folder, variables=empty_cache(folder)).cost.cpu
        ours = [solution.cost.cpu for solution in solutions[EVOLVENT.name]]
        for program in programs:
            head = (case.name, program.name, mesh.shape, mesh.order, mesh.cells, task.dofs)
            if program.name in failed:
                yield Row(*head, note=failed[program.name])
                continue
            cost = Cost.median([solution.cost for solution in solutions[program.name]])
            ratio = statistics.median(s.cost.cpu / other for s, other in zip(solutions[program.name], ours))
            first = cold if program is EVOLVENT else nan
            answer = solutions[program.name][0].answer
            pressure, a = Pressure.of(task, answer), case.hertz.half_width
            yield Row(
                *head, cost.wall, cost.cpu, first, ratio, cost.memory_MB, answer.iterations,
                pressure.force / known.force - 1.0, pressure.peak(a) / known.peak - 1.0, pressure.error(reference),
            )


def _side_by_side(
    programs: Sequence[Program], folder: Path, repeats: int
) -> tuple[dict[str, list[Solved]], dict[str, str]]:
    """Solutions by program, and why a program has none; one that failed is not run again."""
    solutions: dict[str, list[Solved]] = {program.name: [] for program in programs}
    failed: dict[str, str] = {}
    solve(EVOLVENT, folder / TASK, folder)  # compiles its forms
    for _ in range(repeats):
        for program in programs:
            if program.name in failed:
                continue
            try:
                solutions[program.name].append(solve(program, folder / TASK, folder))
            except RunFailed as failure:
                failed[program.name] = failure.reason
    return solutions, failed
