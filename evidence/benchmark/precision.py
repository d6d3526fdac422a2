"""Work against precision on the round contacts: seconds and errors of every program on the same meshes."""

from __future__ import annotations

import os
import shutil
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from evidence.benchmark.cases import Hertz, cylinder, line_contact, point_contact, sphere
from evidence.benchmark.pressure import Pressure, Reference
from evidence.benchmark.programs import EVOLVENT, Program, Solved, solve
from evidence.benchmark.runs import Cost, RunFailed
from evidence.benchmark.task import Task


@dataclass(frozen=True)
class Mesh:
    """One mesh of a case: cells a half-width, order, shape."""

    cells: float
    order: int
    shape: str


@dataclass(frozen=True)
class Case:
    """A round contact, its meshes and those of its overkill solution. repeats: how often each program runs."""

    name: str
    task: Callable[[float, int, str], Task]
    hertz: Hertz
    meshes: tuple[Mesh, ...]
    overkill: tuple[Mesh, Mesh]
    repeats: int


def _ladder(shapes: Sequence[str], first: Sequence[float], second: Sequence[float]) -> tuple[Mesh, ...]:
    return tuple(Mesh(n, k, s) for s in shapes for k, cells in ((1, first), (2, second)) for n in cells)


HERTZ_2D = Case(
    "hertz2d", cylinder, line_contact(),
    _ladder(("quadrilateral", "triangle"), (8, 16, 32, 48), (4, 8, 16)),
    (Mesh(32, 2, "quadrilateral"), Mesh(64, 2, "quadrilateral")), 3,
)  # fmt: skip
HERTZ_3D = Case(
    "hertz3d", sphere, point_contact(),
    _ladder(("hexahedron", "tetrahedron"), (4, 8, 12), (2, 4)),
    (Mesh(6, 2, "hexahedron"), Mesh(8, 2, "hexahedron")), 1,
)  # fmt: skip
SMALL_2D = Case(
    "hertz2d", cylinder, line_contact(), _ladder(("quadrilateral", "triangle"), (8,), (4,)),
    (Mesh(16, 2, "quadrilateral"), Mesh(32, 2, "quadrilateral")), 1,
)  # fmt: skip
SMALL_3D = Case(
    "hertz3d", sphere, point_contact(), _ladder(("hexahedron", "tetrahedron"), (4,), (2,)),
    (Mesh(4, 2, "hexahedron"), Mesh(6, 2, "hexahedron")), 1,
)  # fmt: skip


@dataclass(frozen=True)
class Overkill:
    """The reference and its own error: what the finer of two overkill solutions differs from the coarser by."""

    reference: Reference
    force: float
    peak: float
    force_error: float
    peak_error: float
    profile_error: float

    def row(self) -> OverkillRow:
        return OverkillRow(
            self.force, self.peak, self.reference.half_width, self.force_error, self.peak_error, self.profile_error
        )


@dataclass(frozen=True)
class OverkillRow:
    """An overkill solution as a line of a table: force [N; N/mm], peak [MPa], half-width [mm], own relative errors."""

    force: float
    peak: float
    half_width: float
    force_error: float
    peak_error: float
    profile_error: float


@dataclass(frozen=True)
class Row:
    """A program on a mesh. cpu, wall [s]: of the whole process without meshing, medians. cold: the CPU seconds of a
    first run, that compiles its forms. ratio: of this program's CPU seconds over Evolvent's, the median over runs side
    by side. errors: relative, of force, fitted peak and pressure (L2). note: why there is nothing."""

    case: str
    program: str
    shape: str
    order: int
    cells: float
    dofs: int
    wall: float = float("nan")
    cpu: float = float("nan")
    cold: float = float("nan")
    ratio: float = float("nan")
    memory_MB: float = float("nan")
    iterations: int = 0
    force_error: float = float("nan")
    peak_error: float = float("nan")
    profile_error: float = float("nan")
    note: str = ""


def overkill(case: Case, folder: Path) -> Overkill:
    """Two solutions of Evolvent on meshes finer than any that is compared. Raises RunFailed."""
    coarse, fine = (_solved_pressure(case, mesh, folder) for mesh in case.overkill)
    a = case.hertz.half_width
    d = 2 if case.name == "hertz2d" else 3
    references = [Reference.fitted(p, a, d) for p in (coarse, fine)]
    return Overkill(
        references[1], fine.force, fine.peak(a),
        abs(coarse.force / fine.force - 1.0), abs(coarse.peak(a) / fine.peak(a) - 1.0),
        references[0].distance(references[1], d),
    )  # fmt: skip


def _solved_pressure(case: Case, mesh: Mesh, folder: Path) -> Pressure:
    task = case.task(mesh.cells, mesh.order, mesh.shape)
    task.write(folder / "overkill.npz")
    return Pressure.of(task, solve(EVOLVENT, folder / "overkill.npz", folder).answer)


def rows(case: Case, peers: Sequence[Program], known: Overkill, folder: Path) -> Iterator[Row]:
    """One row a mesh and a program, the programs of a mesh side by side."""
    cold_done: set[tuple[str, int]] = set()
    for mesh in case.meshes:
        task, path = case.task(mesh.cells, mesh.order, mesh.shape), folder / "task.npz"
        task.write(path)
        programs = [EVOLVENT, *(p for p in peers if p.takes(task))]
        found, failed = _side_by_side(programs, path, folder, case.repeats)
        cold = float("nan")
        if (mesh.shape, mesh.order) not in cold_done:
            cold_done.add((mesh.shape, mesh.order))
            cold = cold_start(path, folder).cpu
        ours = [s.cost.cpu for s in found[EVOLVENT.name]]
        for program in programs:
            head = (case.name, program.name, mesh.shape, mesh.order, mesh.cells, task.dofs)
            runs = found[program.name]
            if program.name in failed:
                yield Row(*head, note=failed[program.name])
            else:
                yield _row(head, task, runs, ours, cold if program is EVOLVENT else float("nan"), case, known)


def cold_start(path: Path, folder: Path) -> Cost:
    """What Evolvent's first run on a kind of cells costs, with an empty cache of compiled forms. Raises RunFailed."""
    empty = folder / "cold"
    shutil.rmtree(empty, ignore_errors=True)
    os.makedirs(empty)
    return solve(EVOLVENT, path, folder, cache_folder=empty).cost


def _side_by_side(
    programs: Sequence[Program], path: Path, folder: Path, repeats: int
) -> tuple[dict[str, list[Solved]], dict[str, str]]:
    """Solutions by program, and why a program has none; one that failed once isn't asked again."""
    found: dict[str, list[Solved]] = {program.name: [] for program in programs}
    failed: dict[str, str] = {}
    solve(EVOLVENT, path, folder)  # compiles its forms
    for _ in range(repeats):
        for program in programs:
            if program.name in failed:
                continue
            try:
                found[program.name].append(solve(program, path, folder))
            except RunFailed as failure:
                failed[program.name] = str(failure).rsplit(": ", 1)[-1][:160]
    return found, failed


def _row(
    head: tuple[str, str, str, int, float, int], task: Task, runs: list[Solved], ours: list[float], cold: float,
    case: Case, known: Overkill,
) -> Row:  # fmt: skip
    answer, cost = runs[0].answer, Cost.median([s.cost for s in runs])
    pressure, a = Pressure.of(task, answer), case.hertz.half_width
    return Row(
        *head, cost.wall, cost.cpu, cold,
        statistics.median(s.cost.cpu / other for s, other in zip(runs, ours)),
        cost.memory_MB, answer.iterations,
        pressure.force / known.force - 1.0,
        pressure.peak(a) / known.peak - 1.0,
        pressure.error(known.reference),
    )  # fmt: skip
