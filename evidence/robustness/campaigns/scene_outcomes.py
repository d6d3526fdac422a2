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
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.solution.certificates import BalanceError, PitchImbalance, certify, certify_pitch, pitch_imbalance
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state
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
    """Balance error of the pitch, at the worst friction coefficient."""
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
    """Again on deflected flanks where the pitch alone is out of balance."""
    problem = gear_problem(scene)
    if in_levels:
        problem = replace(problem, mesh=replace(problem.mesh, order=2, shape="hexahedron", two_level=True))
    model = prepare_model(problem, MPI.COMM_SELF).model
    outcome, pitch_refused = _swept(model, scene, seed)
    return _swept(replace(model, deflected=True), scene, seed)[0] if pitch_refused else outcome


def _swept(model: GearModel, scene: Scene, seed: int) -> tuple[Outcome, bool]:
    """And whether only the pitch was refused."""
    pitch, frictions = some_positions(scene, seed), scene.contact.friction
    swept = one_pitch(list(sweep_until_periodic(model, pitch, frictions, initial_state(frictions), MPI.COMM_SELF)))
    results = [result for position in swept for result in position.results]
    counted = [r for r in results if r.friction > 0.0] or results
    refusal = _out_of_balance(swept)
    outcome = Outcome(
        seed,
        Verdict.UNBALANCED if refusal else Verdict.CONVERGED,
        str(refusal or ""),
        max(map(pitch_imbalance, zip(*(position.results for position in swept), strict=True))),
        float(np.mean([r.iterations for r in counted])),
        max(r.iterations for r in counted),
        model_dofs(model),
    )
    return outcome, isinstance(refusal, PitchImbalance)


def _out_of_balance(swept: list[SweptPosition]) -> BalanceError | None:
    """Why a run would refuse these positions of a pitch; None where it would not."""
    try:
        for position in swept:
            certify(position.results)
        certify_pitch(position.results for position in swept)
    except BalanceError as error:
        return error
    return None
