"""A scene solved as `evolvent run` does, and what became of it."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.solution.certificates import BalanceError, PitchImbalance, certify, certify_pitch, pitch_imbalance
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_closed
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.mesh.mesh_data import MeshError

POSITIONS = 6
REFUSALS = (NotConverged, SearchError, MeshError, NotPositiveDefinite)
"""What a run ends with when it tells its user that it found no solution."""


class Verdict(Enum):
    """What became of a scene. Only the first is a result; the next two are said; the last two must not be."""

    CONVERGED = "converged"
    REFUSED = "refused, with a message"
    UNBALANCED = "out of balance, refused"
    CRASHED = "crashed"
    HUNG = "hung"


@dataclass(frozen=True)
class Outcome:
    """A scene's outcome. balance: of the pitch, the worst friction coefficient's. iterations: mean a position and
    friction coefficient above 0
    (frictionless where all are 0); most: their largest. cpu: processor seconds."""

    seed: int
    verdict: Verdict
    message: str = ""
    balance: float = float("nan")
    iterations: float = float("nan")
    most: int = 0
    dofs: int = 0
    cpu: float = 0.0


def some_positions(scene: Scene, seed: int) -> Pitch:
    """A whole pitch in a few equal steps, from a random position on."""
    step = 2.0 * np.pi / scene.pinion.teeth / POSITIONS
    begin = POSITIONS * float(np.random.default_rng([seed, 1]).random())
    return Pitch(tuple(step * (begin + k) for k in range(POSITIONS)))


def outcome_of(scene: Scene, seed: int) -> Outcome:
    """Prepares and sweeps the scene, and applies the balance certificate. Raises nothing but what ends Python."""
    begin = time.process_time()
    try:
        found = _solved(scene, seed)
    except REFUSALS as error:
        found = Outcome(seed, Verdict.REFUSED, f"{type(error).__name__}: {error}")
    except Exception:
        found = Outcome(seed, Verdict.CRASHED, traceback.format_exc(limit=-3))
    return Outcome(**{**vars(found), "cpu": time.process_time() - begin})


def _solved(scene: Scene, seed: int) -> Outcome:
    """Again on deflected flanks where the pitch alone is out of balance."""
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF).model
    found, pitch = _swept(model, scene, seed)
    return _swept(replace(model, deflected=True), scene, seed)[0] if pitch else found


def _swept(model: GearModel, scene: Scene, seed: int) -> tuple[Outcome, bool]:
    """And whether only the pitch was refused."""
    pitch, frictions = some_positions(scene, seed), scene.contact.friction
    swept = one_pitch(list(sweep_closed(model, pitch, frictions, initial_state(frictions), MPI.COMM_SELF)))
    results = [result for position in swept for result in position.results]
    rubbed = [r for r in results if r.friction > 0.0] or results
    refusal = _out_of_balance(swept)
    outcome = Outcome(
        seed,
        Verdict.UNBALANCED if refusal else Verdict.CONVERGED,
        str(refusal or ""),
        max(map(pitch_imbalance, zip(*(position.results for position in swept), strict=True))),
        float(np.mean([r.iterations for r in rubbed])),
        max(r.iterations for r in rubbed),
        sum(body.mesh.points.shape[0] * body.d for body in model.bodies),
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
