"""The vibration of a random drive over the speed, as `evolvent dynamics` computes it, and what became of it."""

from __future__ import annotations

import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum
from math import nan

import numpy as np

from evidence.robustness.campaigns.motion_checks import energy_error, return_errors
from evidence.robustness.campaigns.random_drives import RandomDrive
from evidence.robustness.campaigns.scene_outcomes import last_line
from evolvent.dynamics.oscillator.continuation import Branch, follow
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep, sweep_speeds
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError

RETURNS, ENERGY, FOLDS = 1e-6, 1e-6, 1e-6
"""Allowed errors: of a motion after its period, times the norm of ∂P/∂y where that is above 1; of the energy; of the
mesh periods of folds."""


class DriveVerdict(Enum):
    """What became of a drive."""

    VERIFIED = "verified"
    REFUSED = "refused, with a message"
    WRONG = "wrong"
    CRASHED = "crashed"
    HUNG = "hung"


@dataclass(frozen=True)
class DriveOutcome:
    """The outcome of a seed."""

    seed: int
    verdict: DriveVerdict
    message: str = ""
    kind: str = ""
    """Of the excitation, and the model of the mesh force."""
    damping_ratio: float = nan
    backlash: float = nan
    """Over the static deflection."""
    speeds: int = 0
    states: int = 0
    """Motions that were verified: steady states, stable or not, and those that repeat after several meshes."""
    unstable: int = 0
    """Of them."""
    folds: int = 0
    jumps: int = 0
    """Up and down."""
    subharmonic: int = 0
    """Speeds, up and down, at which the motion repeats after several meshes."""
    unrepeated: int = 0
    """At which it does not repeat, `escaped` left out."""
    escaped: int = 0
    """At which it grows beyond measure."""
    lost: str = ""
    """Why the branch of steady states could not be followed from end to end; empty where it was."""
    returned: float = nan
    """Largest error after a period, see `return_errors`."""
    scaled: float = nan
    """The same over the norm of ∂P/∂y where that is above 1."""
    energy: float = nan
    """Largest error of the energy of a period."""
    cpu: float = 0.0
    """CPU time of the sweep [s]."""

    @property
    def line(self) -> str:
        """The last line of the message, or why a branch was lost."""
        return last_line(self.message or self.lost)


def drive_outcome_of(drawn: RandomDrive, seed: int) -> DriveOutcome:
    """Sweeps the speeds and checks every motion. Raises nothing but what ends Python."""
    known = DriveOutcome(
        seed, DriveVerdict.VERIFIED, "", drawn.kind, drawn.damping_ratio, drawn.backlash, len(drawn.periods)
    )
    begin = time.process_time()
    try:
        swept = sweep_speeds(drawn.drive.model, drawn.periods)
        return _checked(replace(known, cpu=time.process_time() - begin), drawn.drive.model, swept)
    except EvolventError as error:
        verdict, message = DriveVerdict.REFUSED, f"{type(error).__name__}: {error}"
    except Exception:
        verdict, message = DriveVerdict.CRASHED, traceback.format_exc(limit=-3)
    return replace(known, verdict=verdict, message=message, cpu=time.process_time() - begin)


def _checked(known: DriveOutcome, model: TorsionalModel, swept: SpeedSweep) -> DriveOutcome:
    """With the figures of a sweep, and what is wrong with it."""
    motions = list(_motions(swept))
    returns = [return_errors(model, *motion) for motion in motions]
    returned, scaled = np.max(returns, axis=0)
    energy = max(energy_error(model, *motion) for motion in motions)
    runs = [*swept.up, *swept.down]
    gone = sum(run.escaped for run in runs)
    wrong = [
        f"{name}: wanted at most {allowed:g}, found {found:.2g}"
        for name, found, allowed in (
            ("motion after its period", scaled, RETURNS), ("energy of a period", energy, ENERGY),
            ("mesh period of a fold, from the other end", _fold_error(model, swept.branch), FOLDS),
        )
        if not found <= allowed
    ]
    return replace(
        known, verdict=DriveVerdict.WRONG if wrong else DriveVerdict.VERIFIED, message="; ".join(wrong),
        states=len(motions), unstable=sum(not each.state.stable for states in swept.coexisting for each in states),
        folds=len(swept.branch.folds), jumps=sum(run.jumped for run in runs),
        subharmonic=sum(run.repeats > 1 for run in runs), unrepeated=sum(run.repeats == 0 for run in runs) - gone,
        escaped=gone, lost=" | ".join(swept.branch.lost), returned=float(returned), scaled=float(scaled), energy=energy,
    )


def _motions(swept: SpeedSweep) -> Iterator[tuple[float, Floats, int]]:
    """Mesh period [s], state (2,) and number of meshes of each motion that repeats, each once."""
    for period, states, *runs in zip(swept.periods, swept.coexisting, swept.up, swept.down):
        for each in states:
            yield float(period), each.state.state, 1
        for run in runs:
            if run.place is None and run.repeats:
                yield float(period), run.motion.state, run.repeats


def _fold_error(model: TorsionalModel, branch: Branch) -> float:
    """Of a branch in one piece, and of the same followed from its other end: the largest distance of a fold of one to
    the nearest fold of the other, in ln T; infinite where only one has folds."""
    if branch.gaps or branch.lost or branch.points[-1].period == branch.points[0].period:
        return 0.0
    again = follow(model, branch.points[-1], branch.points[0].period)
    one, other = (np.log(each.periods[list(each.folds)]) for each in (branch, again))
    if not len(one) or not len(other):
        return 0.0 if len(one) == len(other) else np.inf
    apart = np.abs(one[:, None] - other)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))
