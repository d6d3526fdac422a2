"""A scene solved as `evolvent run` does, and what became of it."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass, replace
from enum import Enum
from math import nan

import numpy as np
from mpi4py import MPI

from evidence.scenes import model_dofs
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.solution.certificates import BalanceError, pitch_imbalance
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.errors import EvolventError

POSITIONS = 6


class Verdict(Enum):
    """What became of a scene: a result, two kinds of refusal with a message, two that must not be."""

    CONVERGED = "converged"
    REFUSED = "refused, with a message"
    UNBALANCED = "out of balance, refused"
    CRASHED = "crashed"
    HUNG = "hung"


@dataclass(frozen=True)
class Outcome:
    """The outcome of a scene."""

    seed: int
    verdict: Verdict
    message: str = ""
    balance: float = nan
    """Balance error of a pitch that converged, at the worst friction coefficient."""
    iterations: float = nan
    """Mean a position and friction coefficient above 0, or without friction where all are 0; `most` the largest."""
    most: int = 0
    dofs: int = 0
    cpu: float = 0.0
    """CPU time [s]."""

    @property
    def line(self) -> str:
        """The last line of the message."""
        return last_line(self.message)


def some_positions(scene: Scene, seed: int) -> Pitch:
    """A whole pitch in a few equal steps, from a random position on."""
    step = 2.0 * np.pi / scene.pinion.teeth / POSITIONS
    begin = POSITIONS * float(np.random.default_rng([seed, 1]).random())
    return Pitch(tuple(step * (begin + k) for k in range(POSITIONS)))


def outcome_of(scene: Scene, seed: int, in_levels: bool = False) -> Outcome:
    """Prepares and sweeps the scene, and applies the balance certificate. Raises nothing but what ends Python.

    in_levels: on second-order hexahedra and on flanks in levels of their own, whatever the scene and its size say."""
    begin = time.process_time()
    try:
        outcome = _solved(scene, seed, in_levels)
    except EvolventError as error:
        outcome = Outcome(seed, Verdict.REFUSED, f"{type(error).__name__}: {error}")
    except Exception:
        outcome = Outcome(seed, Verdict.CRASHED, traceback.format_exc(limit=-3))
    return replace(outcome, cpu=time.process_time() - begin)


def last_line(message: str) -> str:
    """Of a message; empty for none."""
    return message.strip().rpartition("\n")[2]


def _solved(scene: Scene, seed: int, in_levels: bool) -> Outcome:
    """Again on deflected flanks where the pitch alone is out of balance, as `evolvent run` does."""
    problem = gear_problem(scene)
    if in_levels:
        problem = replace(problem, mesh=replace(problem.mesh, order=2, shape="hexahedron", two_level=True))
    model = prepare_model(problem, MPI.COMM_SELF).model
    try:
        solved = certified_pitch(model, some_positions(scene, seed), scene.contact.friction, MPI.COMM_SELF)
    except BalanceError as error:
        return Outcome(seed, Verdict.UNBALANCED, str(error), dofs=model_dofs(model))
    results = [result for position in solved.positions for result in position.results]
    counted = [r for r in results if r.friction > 0.0] or results
    return Outcome(
        seed,
        Verdict.CONVERGED,
        balance=max(map(pitch_imbalance, solved.by_friction)),
        iterations=float(np.mean([r.iterations for r in counted])),
        most=max(r.iterations for r in counted),
        dofs=model_dofs(model),
    )
