"""What `evolvent run` takes from the scene file to its last output, on two ranks.

Each run is a process of its own, as a user starts it. *Plain* runs leave out error bars and pictures.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isnan, nan
from pathlib import Path
from typing import Any

from evidence.benchmarks.gears.scaling import RatioRow
from evidence.checkout import ROOT
from evidence.processes import Command, RunFailed, module_run, run, run_arguments
from evidence.scenes import PLAIN

RANKS = 2
TIME_LIMIT = 2400.0  # s
HELICAL, FIRST = "demos/yang2022.toml", "demos/first_pair.toml"
ONE = "contact.friction=0.11"
SLENDER = (
    'title="23/81"', "pair.normal_module_mm=2", "pair.helix_angle_deg=20", "pinion.teeth=23", "wheel.teeth=81",
    *(f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("face_width_mm=20", "tip_relief_um=0")),
    "pinion.bore_diameter_mm=25", "wheel.bore_diameter_mm=60",
)
"""An ordinary pair that changes demos/first_pair.toml: 23 and 81 teeth, m_n = 2 mm, β = 20°, b = 20 mm."""


@dataclass(frozen=True)
class RunCase:
    """A scene to run, and what the run may take."""

    name: str
    scene: str
    level: str
    settings: tuple[str, ...]
    options: tuple[str, ...] = ()
    seconds_bar: float = nan
    """NaN where there is none, as for memory."""
    memory_bar_MB: float = nan
    iterations_bar: float = nan


@dataclass(frozen=True)
class RunRow:
    """What a run took, by its summary.json."""

    case: str
    level: str
    frictions: int
    dofs: int
    """Of one sector of each gear."""
    flank_dofs: int
    """Of the finest flanks; 0 in one mesh with the body."""
    prepare: float
    """Meshing, assembling, condensing [s]: wall time, as of the parts below."""
    positions: float
    error_bars: float
    output: float
    seconds: float
    """Of the whole run."""
    seconds_bar: float
    memory_MB: float
    """Of all ranks at once; what they share counts once."""
    memory_bar_MB: float
    iterations: float
    """Of Newton's method, mean of all positions and friction coefficients."""
    iterations_bar: float = nan
    note: str = ""

    @property
    def met(self) -> bool:
        """Whether time, memory and iterations are within their bars."""
        found = (self.seconds, self.seconds_bar), (self.memory_MB, self.memory_bar_MB)
        return not any(value > bar for value, bar in (*found, (self.iterations, self.iterations_bar)))

    @property
    def has_bar(self) -> bool:
        """Whether there is one."""
        return not all(map(isnan, (self.seconds_bar, self.memory_bar_MB, self.iterations_bar)))


YANG = "Yang, 20 positions"
LIGHT = "23/81, 20 positions"
FULL = (
    RunCase(f"{YANG}, plain", HELICAL, "quick", (*PLAIN, ONE)),
    RunCase(f"{YANG}, plain", HELICAL, "standard", (*PLAIN, ONE), memory_bar_MB=3e3, iterations_bar=8.0),
    RunCase(f"{YANG}, plain", HELICAL, "fine", (*PLAIN, ONE), (), 240.0, 6e3),
    RunCase(f"{YANG}, error bars, pictures", HELICAL, "quick", (), (), 300.0),
    RunCase(f"{YANG}, error bars, pictures", HELICAL, "standard", (), (), 300.0),
    RunCase(f"{LIGHT}, 50 N·m, plain", FIRST, "standard", (*PLAIN, ONE, *SLENDER, "load.torque_Nm=50"), (), 180.0, 4e3),
    RunCase(f"{LIGHT}, 10 N·m, plain", FIRST, "standard", (*PLAIN, ONE, *SLENDER, "load.torque_Nm=10"), (), 360.0, 6e3),
)
BESIDE = FULL[1], RunCase(f"{YANG}, plain, one mesh", HELICAL, "standard", (*PLAIN, ONE), ("--exact=two-level",))
"""The same scene with flanks in levels, and in one mesh with their body."""
BESIDE_BAR = 0.2
"""At most, of the seconds of the first over those of the second."""
SMALL = (RunCase("He, plain", "demos/he2022.toml", "quick", (*PLAIN, "contact.friction=0", "sweep.positions=4")),)


def rows(cases: Sequence[RunCase], folder: Path) -> Iterator[RunRow]:
    """Runs each case on gears condensed anew; the row of one that fails says why."""
    for number, case in enumerate(cases):
        out = folder / f"run_{number}"
        arguments = run_arguments(
            case.scene, out, (f"mesh.level={case.level}", *case.settings), "--no-cache", *case.options
        )
        words = module_run("evolvent", "run", *arguments)
        try:
            cost = run(Command(words, ROOT, folder / f"run_{number}.log", ranks=RANKS, time_limit=TIME_LIMIT))
        except RunFailed as failure:
            yield failed(case, failure.reason)
            continue
        yield row_of(case, json.loads((out / "summary.json").read_text(encoding="utf-8")), cost.memory_MB)


def beside_rows(cases: tuple[RunCase, RunCase], folder: Path) -> Iterator[RatioRow]:
    """Flanks in levels over one mesh, one run after the other. Raises ValueError where one came to no end."""
    levels, one_mesh = rows(cases, folder)
    if levels.note or one_mesh.note:
        raise ValueError(f"levels beside one mesh: wanted both runs to end, found {levels.note or one_mesh.note}")
    yield beside(levels, one_mesh)


def beside(levels: RunRow, one_mesh: RunRow) -> RatioRow:
    """The ratio of two runs of the same scene."""
    what = f"{levels.case}, `{levels.level}`: a run with flanks in levels over one with one mesh a sector"
    above, below = levels.seconds, one_mesh.seconds
    return RatioRow(what, one_mesh.dofs, above, below, above / below, BESIDE_BAR, nan)


def row_of(case: RunCase, summary: dict[str, Any], memory_MB: float) -> RunRow:
    """From a run's summary.json. memory_MB: of all ranks at once."""
    spent, positions = summary["timings_s"], summary["positions"]
    later = spent["positions"], spent["error_bars"], spent["output"]
    return RunRow(
        case.name, case.level, len(summary["frictions"]), summary["dofs"], summary["flank_dofs"],
        spent["total"] - sum(later), *later, spent["total"], case.seconds_bar, memory_MB,
        case.memory_bar_MB, sum(position["newton_iterations"] for position in positions) / len(positions),
        case.iterations_bar,
    )


def failed(case: RunCase, reason: str) -> RunRow:
    """Of a run that came to no end."""
    return RunRow(
        case.name, case.level, 0, 0, 0, nan, nan, nan, nan, nan, case.seconds_bar, nan, case.memory_bar_MB, nan,
        case.iterations_bar, reason,
    )
