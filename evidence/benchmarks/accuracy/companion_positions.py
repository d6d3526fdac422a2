"""Error bars with the coarse companion at every second position beside those with it at all positions.

`python -m evidence.benchmarks.accuracy.companion_positions` measures them, ten minutes of one core; `python -m
evidence.pages` then writes docs/evidence.md. How wide both are, and what their companions cost on the same condensed
gears; and how many of them hold the true error of a narrow helical pair, on meshes of both orders and shapes.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import astuple, dataclass, replace
from pathlib import Path

from mpi4py import MPI

from evidence.benchmarks.accuracy.error_bars import (
    FIGURES,
    SCENES,
    BarProblem,
    BarRow,
    bar_rows,
    figures_of,
    helical_problem,
    known,
    solved,
    solved_companion,
)
from evidence.checkout import DEMOS, DOCS
from evidence.tables import markdown, read_rows, write_rows
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.companion_pitch import companion_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.results.archive.gear_shapes import gear_shape
from evolvent.results.error_bars.estimation import Companion, at_common_positions, errors_between, estimated_errors
from evolvent.results.run_data import RunData, run_data
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene

BARS, COSTS = "benchmark/companion_bars.csv", "benchmark/companion_costs.csv"
HELD = "benchmark/companion_held.csv"
COMMAND = "python -m evidence.benchmarks.accuracy.companion_positions"
NARROW = SCENES / "narrow_helical.toml"
REFERENCES = 2.8, 2.2
"""Elements across the contact of the reference, and of the mesh by which its own error is told."""
QUICK, FEWEST = ('mesh.level="quick"', "sweep.positions=20"), ("sweep.positions=16",)


@dataclass(frozen=True)
class BarsRow:
    """A figure at one friction coefficient; all in the figure's unit."""

    case: str
    figure: str
    friction: float
    value: float
    every: float
    """Error bar with the companion at all positions."""
    second: float
    """Error bar with the companion at every second one."""
    step: float
    """By how much steps twice as long move the companion's figure, at the positions of both: what friction's history
    adds to the difference of the meshes, or takes from it."""


@dataclass(frozen=True)
class CostRow:
    """What the positions of a companion cost."""

    case: str
    solved: int
    """Positions solved until friction is periodic, of a companion at all positions."""
    solved_second: int
    """Positions solved until friction is periodic, of a companion at every second one."""
    seconds: float
    """Processor time [s] of the companion at all positions."""
    seconds_second: float
    """Processor time [s] of the companion at every second one."""


@dataclass(frozen=True)
class HeldRow:
    """How many error bars, of the mesh alone, hold the true error on all meshes of the narrow pair."""

    figure: str
    bars: int
    """Number of bars: of meshes and friction coefficients."""
    every: int
    """Bars that hold the true error with the companion at all positions."""
    second: int
    """Bars that hold the true error with the companion at every second one."""


def cases() -> Iterator[tuple[str, Scene]]:
    """A wide helical pair, one with tip relief, and a narrow one, with little overlap, under more friction."""
    yield "Yang", load_scene(DEMOS / "yang2022.toml", [*QUICK, "contact.friction=[0.1]"])
    yield "tutorial", load_scene(DEMOS / "first_pair.toml", [*QUICK, "contact.friction=[0.08]"])
    yield "narrow", load_scene(NARROW, [*FEWEST, "contact.friction=[0.2]"])


def measured(name: str, scene: Scene) -> tuple[list[BarsRow], CostRow]:
    """Bars and cost of a scene, on this rank alone. Raises what `certified_pitch` does."""
    whole = pitch_of(scene)
    thinned = companion_pitch(whole, gear_problem(scene).is_plane)
    run = solved(scene)
    coarse = prepare_model(gear_problem(scene), MPI.COMM_SELF, companion_mesh).model
    (every, count, seconds), (second, fewer, less) = (_companion(scene, coarse, pitch) for pitch in (whole, thinned))
    bars = [estimated_errors(run, Companion(each, "", 0.0)).figures for each in (every, second)]
    moved = [friction_rows(each, run.inner_path) for each in (at_common_positions(every, second), second)]
    rows = [
        BarsRow(name, figure, row.friction, value, wide, narrow, abs(before - after))
        for row, *others in zip(friction_rows(run), *bars, *moved)
        for figure in FIGURES
        for value, wide, narrow, before, after in [[float(getattr(each, figure)) for each in (row, *others)]]
    ]
    return rows, CostRow(name, count, fewer, seconds, less)


def held(problem: BarProblem) -> list[HeldRow]:
    """Bars of all cases of a problem, on this rank alone."""
    references = [solved(problem.with_mesh([f"elements_per_contact_width={width}"])) for width in REFERENCES]
    pairs: list[tuple[BarRow, BarRow]] = []
    for case in problem.cases:
        scene = problem.with_mesh(case)
        run = solved(scene)
        values = [figures_of(each, run.inner_path) for each in (run, *references)]
        every, second = (
            bar_rows(", ".join(case), run.frictions, values[0], bars, *values[1:])
            for coarse in (solved(scene, companion_mesh), solved_companion(scene))
            for bars in [[astuple(errors) for errors in errors_between(run, coarse)]]
        )
        pairs += [pair for pair in zip(every, second) if not known(pair[0])]
    figures = {figure: [pair for pair in pairs if pair[0].figure == figure] for figure in FIGURES}
    return [
        HeldRow(name, len(rows), sum(one.inside for one, _ in rows), sum(other.inside for _, other in rows))
        for name, rows in figures.items()
    ]


def _companion(scene: Scene, model: GearModel, pitch: Pitch) -> tuple[RunData, int, float]:
    """A pitch on condensed gears, the number of positions solved, and the processor time of these [s]."""
    count: list[object] = []
    begin = time.process_time()
    solution = certified_pitch(model, pitch, scene.contact.friction, MPI.COMM_SELF, count.append)
    seconds = time.process_time() - begin
    shapes = [gear_shape(MeshedGear.of(body)) for body in model.bodies]
    return run_data(scene, (shapes[0], shapes[1]), solution.positions), len(count), seconds


def table(docs: Path) -> str:
    """The table of docs/evidence.md and what the companions cost. Raises ValueError where nothing was measured."""
    rows, costs = read_rows(docs / BARS, BarsRow), read_rows(docs / COSTS, CostRow)
    if not rows or not costs or not (docs / HELD).exists():
        raise ValueError(f"{docs}: wanted {BARS}, {COSTS} and {HELD}, found not all of them; `{COMMAND}` writes them")
    heads = list(dict.fromkeys(f"{row.case}, μ = {row.friction:g}" for row in rows))
    figures = list(dict.fromkeys(row.figure for row in rows))
    cells = {figure: [_cell(row) for row in rows if row.figure == figure] for figure in figures}
    counts = read_rows(docs / HELD, HeldRow)
    bars, every, second = (sum(getattr(row, name) for row in counts) for name in ("bars", "every", "second"))
    lines = markdown(["% of the figure", *heads], [[figure, *cells[figure]] for figure in figures])
    spent = "; ".join(
        f"{row.case}: {row.solved} positions in {row.seconds:.2g} s of processor time, "
        f"{row.solved_second} in {row.seconds_second:.2g} s"
        for row in costs
    )
    return (
        f"{lines}\n\nPositions until friction is periodic, on gears that are condensed: {spent}.\n\n"
        f"Of {bars} bars of the narrow pair, by the mesh alone, {every} hold the true error with all positions and "
        f"{second} with every second one: cells of both orders and shapes, μ = 0 and 0.2, against a finer mesh."
    )


def _cell(row: BarsRow) -> str:
    every, second, step = (100.0 * each / row.value for each in (row.every, row.second, row.step))
    return f"{every:.2g} → {second:.2g} ({step:.1g})"


if __name__ == "__main__":
    found = [measured(*case) for case in cases()]
    write_rows(DOCS / BARS, [row for rows, _ in found for row in rows])
    write_rows(DOCS / COSTS, [cost for _, cost in found])
    problem = helical_problem()
    write_rows(DOCS / HELD, held(replace(problem, scene=load_scene(NARROW, FEWEST))))
    print(table(DOCS))
