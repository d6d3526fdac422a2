"""The gear pair: seconds a position, of programs that solve three teeth anew, and of a pitch by Evolvent."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evidence.benchmark.gears import FRICTION, ROTATION, scene, three_teeth
from evidence.benchmark.pitch import PitchFacts, read_facts
from evidence.benchmark.programs import EVOLVENT, Program, solve
from evidence.benchmark.runs import Command, Cost, RunFailed, run
from evidence.benchmark.task import Answer
from evidence.checkout import PYTHONPATH

PITCH = 2 * np.pi / 17
TIME_LIMIT = 600.0  # s


@dataclass(frozen=True)
class GearRow:
    """One program on one model of the gear pair. model: "three teeth" or "whole gears". seconds: CPU, a position, all
    but meshing. stiffness [N·m/mrad]: torque over the pinion's elastic rotation at φ = 0. error: relative, of that,
    against the overkill solution of the same model; reference_error: that solution's own. ratio: of the seconds over
    those of Evolvent's largest pitch."""

    program: str
    model: str
    order: int
    elements: float
    dofs: int
    positions: int
    seconds: float = float("nan")
    ratio: float = float("nan")
    memory_MB: float = float("nan")
    iterations: float = float("nan")
    stiffness: float = float("nan")
    error: float = float("nan")
    reference_error: float = float("nan")
    note: str = ""


@dataclass(frozen=True)
class GearSizes:
    """What is run. elements: across 2b, of the three teeth (order 1) and of the pitch (order 2); overkill: of three
    teeth at order 2, and of the whole gears, a coarser and a finer one each."""

    elements: tuple[float, ...]
    pitch: tuple[float, ...]
    positions: int
    peer_positions: int
    overkill_teeth: tuple[float, float]
    overkill_gears: tuple[float, float]


FULL = GearSizes((1.9,), (1.0,), 20, 1, (1.0, 1.2), (1.2, 1.4))
SMALL = GearSizes((1.0,), (1.0,), 3, 1, (1.0, 1.2), (1.0, 1.2))


def rows(peers: Sequence[Program], sizes: GearSizes, folder: Path) -> Iterator[GearRow]:
    """Evolvent's pitches first: what the others are compared with is the largest one."""
    fine = [pitch(folder, n, 2).transmission_error[0] for n in sizes.overkill_gears]
    own, fast = scene(1.0), float("nan")
    base = own.gear_pair().pinion.base_radius
    for elements in sizes.pitch:
        cost, facts = pitch_cost(folder, elements, sizes.positions)
        fast = (cost.cpu - facts.mesh) / facts.counted
        yield GearRow(
            "Evolvent", "whole gears", 2, elements, facts.dofs, facts.counted, fast, 1.0, cost.memory_MB,
            float(np.mean(facts.iterations)), 1e-3 * own.load.torque_Nm * base / facts.transmission_error[0],
            fine[1] / facts.transmission_error[0] - 1.0, abs(fine[1] / fine[0] - 1.0),
        )  # fmt: skip
    yield from _three_teeth(peers, sizes, folder, fast)


def _three_teeth(peers: Sequence[Program], sizes: GearSizes, folder: Path, fast: float) -> Iterator[GearRow]:
    coarse, fine = (_overkill_torque(folder, n) for n in sizes.overkill_teeth)
    for elements in sizes.elements:
        for program in (EVOLVENT, *peers):
            yield _teeth_row(program, elements, sizes.peer_positions, folder, fast, fine, abs(coarse / fine - 1.0))


def _overkill_torque(folder: Path, elements: float) -> float:
    three_teeth(elements, order=2).write(folder / "overkill.npz")
    return solve(EVOLVENT, folder / "overkill.npz", folder, TIME_LIMIT).answer.torque


def _teeth_row(
    program: Program, elements: float, positions: int, folder: Path, fast: float, exact: float, own: float
) -> GearRow:
    """Positions in the half of the pitch in which the three teeth touch."""
    costs, answers, dofs = [], [], 0
    for k in range(positions):
        task = three_teeth(elements, 0.5 * PITCH * k / positions)
        task.write(folder / "gear.npz")
        dofs = task.dofs
        try:
            found = solve(program, folder / "gear.npz", folder, TIME_LIMIT)
        except RunFailed as failure:
            note = str(failure).rsplit(": ", 1)[-1][:160]
            return GearRow(program.name, "three teeth", 1, elements, dofs, k, note=note)
        costs.append(found.cost)
        answers.append(found.answer)
    return _row_of(program, elements, dofs, costs, answers, fast, exact, own)


def _row_of(
    program: Program, elements: float, dofs: int, costs: list[Cost], answers: list[Answer], fast: float, exact: float,
    own: float,
) -> GearRow:  # fmt: skip
    seconds = float(np.mean([cost.cpu for cost in costs]))
    return GearRow(
        program.name, "three teeth", 1, elements, dofs, len(costs), seconds, seconds / fast,
        max(cost.memory_MB for cost in costs), float(np.mean([a.iterations for a in answers])),
        1e-6 * answers[0].torque / ROTATION, answers[0].torque / exact - 1.0, own,
    )  # fmt: skip


def pitch(folder: Path, elements: float, positions: int, *settings: str, level: str = "quick") -> PitchFacts:
    """A pitch at one friction coefficient. Raises RunFailed."""
    return pitch_cost(folder, elements, positions, *settings, level=level)[1]


def pitch_cost(
    folder: Path, elements: float, positions: int, *settings: str, level: str = "quick",
    frictions: str = str(FRICTION), ranks: int = 1, cache_folder: Path | None = None,
) -> tuple[Cost, PitchFacts]:  # fmt: skip
    """A pitch in a process of its own, and what it took. cache_folder: for compiled forms, where it's not the usual
    one. Raises RunFailed."""
    out = folder / "pitch.json"
    environment = {"PYTHONPATH": PYTHONPATH, **({"XDG_CACHE_HOME": str(cache_folder)} if cache_folder else {})}
    words = (sys.executable, "-m", "evidence.benchmark.pitch", str(out), str(elements), level, str(positions))
    command = Command(
        (*words, frictions, *settings), folder, folder / "pitch.log", environment, ranks, 3600.0
    )
    return run(command), read_facts(out)
