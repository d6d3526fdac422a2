"""A variant solved as scenes are: its excitation and its friction loss, with error bars."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

import numpy as np

from evolvent.dynamics.excitation.loaded_mesh import EdgeContact
from evolvent.dynamics.results.curves import LOADED, TANGENT, pitch_curves
from evolvent.dynamics.results.line_facts import line_facts
from evolvent.gears.shared_gears import SharedGears
from evolvent.gears.solution.certificates import BalanceError
from evolvent.results.archive.run_cost import Timings
from evolvent.run.call import Call
from evolvent.run.companion import Attempt
from evolvent.run.dynamics.excitation import SolvedExcitation, solved_excitation
from evolvent.run.dynamics.scene_torques import SceneTorques
from evolvent.run.loss_figures import loss_warnings, pitch_figures
from evolvent.run.solved_pitches import SolvedPitches, solved_pitches
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.load_cases import under_torque
from evolvent.scene.scene import Scene
from evolvent_meshes.errors import ResultError

T = TypeVar("T")
Pairs = list[tuple[float, float]]
"""(m,) figure and its error under each torque; NaN where they are not known."""
LOST = "loss_"
"""Beginning of the names of files with positions under friction."""


@dataclass(frozen=True, eq=False)
class SolvedLoss:
    """Friction loss of a variant under each torque."""

    percent: Pairs
    """(m,) loss over the input of the pitch and its error [%]."""
    timings: Timings
    """Wall time of its solutions [s]."""
    warnings: tuple[str, ...]
    """Warnings on it, a sentence each."""
    reasons: tuple[str, ...]
    """Why it could not be solved under some torques."""


@dataclass(frozen=True, eq=False)
class SolvedVariant:
    """A variant under all torques, in line contact or with the contact resolved."""

    excitation: SolvedExcitation | None = None
    """Excitation without friction; None where edges bear under the lightest torque, and where it was not asked for."""
    loss: SolvedLoss | None = None
    """Friction loss; None where it was not asked for."""
    reason: str = ""
    """Why the excitation could not be solved."""

    @property
    def timings(self) -> Timings:
        """Wall time of all its solutions [s]."""
        return sum((each.timings for each in (self.excitation, self.loss) if each is not None), Timings())

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings on its solutions, a sentence each."""
        return tuple(said for each in (self.excitation, self.loss) if each is not None for said in each.warnings)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why a part of it could not be solved, a sentence each."""
        return *filter(None, [self.reason]), *(() if self.loss is None else self.loss.reasons)

    def figures(self, count: int) -> Mapping[str, Pairs]:
        """Figures with their errors under `count` torques, of which the heaviest ones may have none."""
        unknown: Pairs = [(math.nan, math.nan)] * count
        found = dict.fromkeys(("error", "harmonic", "stiffness", "face_load", "pressure"), unknown)
        if self.excitation is not None:
            found |= {name: [*own, *unknown[len(own) :]] for name, own in _of_excitation(self.excitation).items()}
        return {**found, "loss": unknown if self.loss is None else self.loss.percent}


NOT_SOLVED = SolvedVariant()
"""A variant of which neither was asked for."""


def solved_variant(call: Call, loads: SceneTorques, part: str, has_loss: bool) -> SolvedVariant:
    """Solves a variant. Collective.

    part: of the results, see `Archive`.
    has_loss: whether its loss is asked for.

    Raises BalanceError, ArchiveError, WriteError.
    """
    excitation = _attempted(lambda: solved_excitation(call, loads, f"{part}_"))
    loss = _solved_loss(call, loads, f"{LOST}{part}_") if has_loss else None
    return SolvedVariant(excitation.value, loss, excitation.reason)


def shared_gears(loads: SceneTorques) -> SharedGears:
    """Gears for the excitation and the loss of a scene under all torques, on the meshes of the excitation."""
    return SharedGears([loads.problem, *map(gear_problem, under_each(loads))])


def under_each(loads: SceneTorques) -> list[Scene]:
    """The scene under each torque, on the meshes of its excitation."""
    lightest, heaviest = loads.problem.lightest.torque, loads.problem.heaviest.torque
    served = 1e-3 * lightest, 1e-3 * heaviest
    return [under_torque(loads.scene, 1e-3 * torque, served) for torque in loads.torques]


def _solved_loss(call: Call, loads: SceneTorques, part: str) -> SolvedLoss:
    """Pitches under each torque, as `evolvent losses` solves them. Collective."""
    scenes = [(f"{part}{number}_", scene) for number, scene in enumerate(under_each(loads))]
    tried = [_attempted(partial(solved_pitches, call, scene, name)) for name, scene in scenes]
    solved = [each.value for each in tried if each.value is not None]
    pairs, said = call.on_first(lambda: _evaluated(loads.scene, solved))
    rest = iter(pairs)
    percent = [(math.nan, math.nan) if each.value is None else next(rest) for each in tried]
    reasons = tuple(dict.fromkeys(each.reason for each in tried if each.reason))
    return SolvedLoss(percent, sum((each.timings for each in solved), Timings()), said, reasons)


def _evaluated(scene: Scene, solved: Sequence[SolvedPitches]) -> tuple[Pairs, tuple[str, ...]]:
    """Losses with their errors, and warnings on them. On rank 0 alone."""
    figures = pitch_figures(solved)
    pairs = [(each.rows[0].loss_percent, each.run.errors.bar("loss_percent", 0)) for each in figures]
    return pairs, tuple(loss_warnings(scene, solved, figures))


def _of_excitation(solved: SolvedExcitation) -> Mapping[str, Pairs]:
    """Figures of an excitation with their errors, under the lightest torques."""
    excitation, companion = solved.excitation, solved.companion
    curves, facts = list(pitch_curves(excitation, companion)), line_facts(excitation, companion)
    return {
        "error": [(float(np.ptp(each[LOADED].values)), each[LOADED].peak_to_peak_error) for each in curves],
        "harmonic": [
            (float(each[LOADED].harmonics[0][0]), float(each[LOADED].amplitude_errors[0])) for each in curves
        ],
        "stiffness": [(float(np.mean(each[TANGENT].values)), each[TANGENT].mean_error) for each in curves],
        "face_load": list(zip(facts.face_load_factor.tolist(), facts.face_load_factor_error.tolist())),
        "pressure": list(zip(facts.largest_pressure_MPa.tolist(), facts.largest_pressure_MPa_error.tolist())),
    }


def _attempted(solve: Callable[[], T]) -> Attempt[T]:
    """A solution, or why there is none: others do without it. Edges that bear are no failure, its rows say so.
    Collective. Raises BalanceError: what is out of balance is an error, whichever variant it is."""
    try:
        return Attempt(solve())
    except EdgeContact:
        return Attempt()
    except BalanceError:
        raise
    except ResultError as error:
        return Attempt(reason=str(error))
