"""Seconds a position of the gear pair: programs that solve three teeth anew, and a pitch by Evolvent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np

from evidence.benchmarks.comparison.programs import EVOLVENT, Program, Solved, solve
from evidence.benchmarks.gears.pitch import pitch_cost
from evidence.benchmarks.gears.three_teeth import ROTATION, pair_scene, three_teeth
from evidence.processes import RunFailed

PITCH = 2 * np.pi / 17
TASK = "gear.npz"


@dataclass(frozen=True)
class GearRow:
    """One program on one model of the gear pair."""

    program: str
    model: str
    """Three teeth or whole gears."""
    order: int
    elements: float
    """Across the contact width 2b."""
    dofs: int
    positions: int
    seconds: float = nan
    """CPU time a position, all but meshing."""
    ratio: float = nan
    """Of the seconds over those of Evolvent's largest pitch."""
    memory_MB: float = nan
    iterations: float = nan
    stiffness: float = nan
    """Torque over the pinion's elastic rotation at φ = 0 [N·m/mrad]."""
    error: float = nan
    """Relative, of the stiffness, against the overkill solution of the same model."""
    reference_error: float = nan
    """Of that solution."""
    note: str = ""


@dataclass(frozen=True)
class GearSizes:
    """Elements across 2b, and positions, of what is run."""

    teeth: tuple[float, ...]
    """Of the three teeth, order 1."""
    pitch: tuple[float, ...]
    """Of Evolvent's pitches, order 2."""
    positions: int
    peer_positions: int
    overkill_teeth: tuple[float, float]
    """Coarser and finer, order 2; likewise of the whole gears."""
    overkill_gears: tuple[float, float]


FULL = GearSizes((1.9,), (1.0,), 20, 1, (1.0, 1.2), (1.2, 1.4))
SMALL = GearSizes((1.0,), (1.0,), 3, 1, (1.0, 1.2), (1.0, 1.2))


def rows(peers: Sequence[Program], sizes: GearSizes, folder: Path) -> Iterator[GearRow]:
    """Evolvent's pitches first: the others are compared with the largest one. Raises RunFailed."""
    coarse, fine = (pitch_cost(folder, n, 2)[1].transmission_error[0] for n in sizes.overkill_gears)
    scene, fast = pair_scene(1.0), nan
    force = scene.load.torque_Nm * scene.gear_pair().pinion.base_radius
    for elements in sizes.pitch:
        cost, facts = pitch_cost(folder, elements, sizes.positions)
        fast = (cost.cpu - facts.mesh) / facts.counted
        error = facts.transmission_error[0]
        yield GearRow(
            EVOLVENT.name, "whole gears", 2, elements, facts.dofs, facts.counted, fast, 1.0, cost.memory_MB,
            float(np.mean(facts.iterations)), 1e-3 * force / error, fine / error - 1.0, abs(fine / coarse - 1.0),
        )
    coarse, fine = (_solved(EVOLVENT, folder, n, order=2)[1].answer.torque for n in sizes.overkill_teeth)
    for elements in sizes.teeth:
        for program in (EVOLVENT, *peers):
            yield _teeth_row(program, elements, sizes.peer_positions, folder, fast, fine, abs(coarse / fine - 1.0))


def _solved(
    program: Program, folder: Path, elements: float, rotation: float = 0.0, order: int = 1
) -> tuple[int, Solved]:
    """Degrees of freedom and solution of three teeth. Raises RunFailed."""
    task = three_teeth(elements, rotation, order)
    task.write(folder / TASK)
    return task.dofs, solve(program, folder / TASK, folder)


def _teeth_row(
    program: Program, elements: float, positions: int, folder: Path, fast: float, exact: float, exact_error: float
) -> GearRow:
    """Positions in the half of the pitch in which the three teeth touch."""
    head, solutions, dofs = (program.name, "three teeth", 1, elements), [], 0
    for k in range(positions):
        try:
            dofs, solution = _solved(program, folder, elements, 0.5 * PITCH * k / positions)
        except RunFailed as failure:
            return GearRow(*head, three_teeth(elements).dofs, k, note=failure.reason)
        solutions.append(solution)
    seconds, torque = float(np.mean([s.cost.cpu for s in solutions])), solutions[0].answer.torque
    return GearRow(
        *head, dofs, len(solutions), seconds, seconds / fast, max(s.cost.memory_MB for s in solutions),
        float(np.mean([s.answer.iterations for s in solutions])), 1e-6 * torque / ROTATION, torque / exact - 1.0,
        exact_error,
    )
