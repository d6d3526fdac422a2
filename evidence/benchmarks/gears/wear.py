"""The cost of wear studies: twenty blocks over one sweep of the unworn pair, and run time against error.

CPU seconds in one process. The error of a study is the volume by which its depths differ from those of a study with
blocks a tenth as long as the smallest tolerance asks for, over the whole volume; both on the same mesh.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evidence.scenes import HELICAL, QUIET, SPUR, model_dofs
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import study_states
from evolvent.wear.gears.gear_wear import GearWear
from evolvent_meshes.arrays import Floats

BLOCKS, ANY = 20, 0.99  # an error that no block has
SWEEPS = 3  # of which the median counts: one of a second may be off by a third
K = 1.3832e-10  # mm²/N: He et al. 2022, Table 3


@dataclass(frozen=True)
class WearCase:
    """A frictionless scene and a study of it."""

    name: str
    scene: Path
    level: str
    positions: int
    """A pitch."""
    cycles: float
    studies: int = 1
    """How often it is made: the median of the seconds counts, a single one may be a fifth off."""

    def load(self) -> Scene:
        """The scene."""
        return load_scene(self.scene, [*QUIET, "contact.friction=0", f"mesh.level={self.level}"])


CASES = (
    WearCase("spur, plane", SPUR, "fine", 40, 1.6e6, 5),
    WearCase("helical", HELICAL, "quick", 10, 4e5),
)
SMALL_CASES = (WearCase("spur, plane", SPUR, "quick", 6, 4e5),)
PRECISION = WearCase("spur, plane", SPUR, "standard", 20, 1.6e6)
TOLERANCES = 0.2, 0.1, 0.05, 0.02, 0.01


@dataclass(frozen=True)
class WearCostRow:
    """CPU seconds of a sweep and of a study."""

    case: str
    dofs: int
    prepare: float
    """Of meshing and condensing both gears."""
    sweep: float
    """Of the unworn pair, median of SWEEPS."""
    study: float
    """Of BLOCKS blocks with their own first sweep."""

    @property
    def whole(self) -> float:
        """The study over the sweep, each with its preparation."""
        return (self.prepare + self.study) / (self.prepare + self.sweep)

    @property
    def bare(self) -> float:
        """The same without preparing."""
        return self.study / self.sweep


@dataclass(frozen=True)
class WearPrecisionRow:
    """A study at one tolerance."""

    method: str
    """Of the blocks: implicit or explicit."""
    tolerance: float
    blocks: int
    refused: int
    seconds: float
    """CPU time without preparing."""
    error: float
    """Of the depths, relative; `volume_error` of their volume."""
    volume_error: float


def cost_rows(cases: Sequence[WearCase] = CASES) -> Iterator[WearCostRow]:
    """One a case."""
    dolfinx_compat.silence_logs()
    for case in cases:
        begin = time.process_time()
        model = prepare_model(gear_problem(case.load()), MPI.COMM_SELF).model
        ready = time.process_time()
        sweep = float(np.median([_sweep_seconds(model, case) for _ in range(SWEEPS)]))
        study = float(np.median([_study_seconds(model, case) for _ in range(case.studies)]))
        yield WearCostRow(case.name, model_dofs(model), ready - begin, sweep, study)


def precision_rows(case: WearCase = PRECISION, tolerances: Sequence[float] = TOLERANCES) -> Iterator[WearPrecisionRow]:
    """Implicit and explicit blocks at each tolerance."""
    dolfinx_compat.silence_logs()
    gears = _gears(prepare_model(gear_problem(case.load()), MPI.COMM_SELF).model, case)
    known = _study(gears, case, 0.1 * min(tolerances), True)[0]
    for implicit in (True, False):
        for tolerance in tolerances:
            depth, blocks, refused, seconds = _study(gears, case, tolerance, implicit)
            volume = float(gears.areas @ known)
            error = float(gears.areas @ np.abs(depth - known)) / volume
            name = "implicit" if implicit else "explicit"
            whole = float(gears.areas @ depth) / volume - 1.0
            yield WearPrecisionRow(name, tolerance, blocks, refused, seconds, error, whole)


def _sweep_seconds(model: GearModel, case: WearCase) -> float:
    begin = time.process_time()
    list(sweep_pitch(model, uniform_pitch(model.pair.pinion.z, case.positions), [0.0], initial_state([0.0])))
    return time.process_time() - begin


def _study_seconds(model: GearModel, case: WearCase) -> float:
    begin, ends = time.process_time(), tuple(case.cycles * k / BLOCKS for k in range(1, BLOCKS + 1))
    count = len(list(study_states(_gears(model, case), ends, BlockSettings(ends[0], ANY))))
    assert count == BLOCKS + 1
    return time.process_time() - begin


def _gears(model: GearModel, case: WearCase) -> GearWear:
    return GearWear(model, uniform_pitch(model.pair.pinion.z, case.positions), 0.0, Archard(K, K))


def _study(gears: GearWear, case: WearCase, tolerance: float, implicit: bool) -> tuple[Floats, int, int, float]:
    """Depths at the end, blocks made and refused, seconds."""
    begin = time.process_time()
    settings = BlockSettings(case.cycles * tolerance / 10.0, tolerance, implicit)
    last = list(study_states(gears, (case.cycles,), settings))[-1]
    refused = sum(row.refused for row in last.rows)
    return last.state.depth, len(last.rows), refused, time.process_time() - begin
