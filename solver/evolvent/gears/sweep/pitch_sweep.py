"""A pitch of gear positions, one after the other; a generator of converged results.

All teeth of a gear are alike, so one angular pitch holds every tooth's whole engagement: at pinion rotation φ + 2π/z_1
tooth pair i stands where pair i + 1 stood at φ. Later pitches are never computed, they are put together by shifting.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress
from types import MappingProxyType

import numpy as np

from evolvent.contact.newton.equilibrium import InitialGuess, sliding
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.deflected_flanks import deflected_equilibrium
from evolvent.gears.sweep.friction_history import FrictionHistory, PreviousJump, previous_jumps
from evolvent.gears.sweep.frictional_position import Solved, solve_position
from evolvent.gears.sweep.position_result import PositionResult, position_result
from evolvent.gears.sweep.position_search import (
    START,
    KnownSolution,
    SharedPosition,
    course_after,
    shared_position,
)
from evolvent.gears.sweep.rotation_course import RotationCourse
from evolvent.gears.sweep.slip import nominal_direction
from evolvent_meshes.arrays import Bools
from evolvent_meshes.gears.member import Member

HALVINGS = 4
LOG = logging.getLogger("evolvent")
Histories = tuple[FrictionHistory | None, ...]
"""Friction history of each friction coefficient; None before the first position, and without friction."""
NONE_KNOWN: Mapping[int, KnownSolution] = MappingProxyType({})


@dataclass(frozen=True)
class SweepState:
    """State of a sweep from which the next position starts.

    beyond_nominal: rotations of pinion and wheel beyond the nominal ones, where the last search was [rad].
    histories: friction history of each coefficient that was solved with.
    patch: the last contact patch, None where it is not known.
    course: of the free rotation, None where it is not known.

    Without beyond_nominal, patch and course the next position is the same, but takes more searches and iterations.
    """

    beyond_nominal: tuple[float, float]
    histories: Histories
    patch: ContactPatch | None = None
    course: RotationCourse | None = None

    def predicted(self, angle: float) -> tuple[float, float]:
        """Rotations beyond the nominal ones from which the search at a pinion angle starts [rad]."""
        return self.beyond_nominal if self.course is None else self.course.at(angle)

    def of(self, coefficients: Bools) -> SweepState:
        """Sweep state of some of its friction coefficients, (frictions,) bool."""
        return replace(self, histories=tuple(compress(self.histories, coefficients)))

    def earlier(self, pitches: int) -> SweepState:
        """Sweep state moved back by whole angular pitches; forward where their number is negative."""
        histories = tuple(None if history is None else history.earlier(pitches) for history in self.histories)
        return replace(self, histories=histories, course=None)  # the course ends a pitch later


@dataclass(frozen=True)
class SweptPosition:
    """One position of a sweep.

    angle: of the pinion [rad].
    results: one for each friction coefficient that was solved with.
    state: to go on from.
    again: whether the angle was solved before.
    closes: whether the sweep is complete with it.
    known: to start from where it is solved again; None where it was loaded from a file.
    """

    angle: float
    results: tuple[PositionResult, ...]
    state: SweepState
    again: bool = False
    closes: bool = False
    known: KnownSolution | None = None

    def of(self, coefficients: Bools) -> SweptPosition:
        """Position with some of its friction coefficients, (frictions,) bool."""
        return replace(self, results=tuple(compress(self.results, coefficients)), state=self.state.of(coefficients))


def joined(parts: Sequence[SweptPosition]) -> SweptPosition:
    """A position of which each part has some friction coefficients."""
    results = tuple(result for part in parts for result in part.results)
    histories = tuple(history for part in parts for history in part.state.histories)
    state = replace(parts[0].state, histories=histories)
    known = [part.known for part in parts if part.known is not None]
    frictional = {μ: guess for each in known for μ, guess in each.frictional.items()}
    return replace(
        parts[0], results=results, state=state, known=replace(known[0], frictional=frictional) if known else None
    )


@dataclass(frozen=True)
class Pitch:
    """The positions to solve.

    angles: pinion rotations [rad] in the order in which the gears pass them: descending where the wheel drives.
    pitches: number of angular pitches that they cover, where they are equal steps of some.
    """

    angles: tuple[float, ...]
    pitches: int = 1


def uniform_pitch(z1: int, positions: int, pitches: int = 1, driving: Member = Member.PINION) -> Pitch:
    """Pitch of `positions` equal steps over each angular pitch 2π/z_1, in the order in which the gears pass them."""
    step = 2.0 * np.pi / z1 / positions
    return Pitch(tuple(float(step * k) for k in range(pitches * positions))[:: driving.sign], pitches)


def initial_state(frictions: Sequence[float]) -> SweepState:
    """The state before the first position."""
    return SweepState((0.0, 0.0), tuple(None for _ in frictions))


def sweep_pitch(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, begin: int = 0,
    common: SharedPosition | None = None, known: Mapping[int, KnownSolution] = NONE_KNOWN,
) -> Iterator[SweptPosition]:
    """Solves pitch.angles[begin:] in turn. A position that fails is approached by up to four halvings of the step.

    common: search and frictionless equilibrium of the first position, None where it is to be searched.
    known: number of a position -> how it was solved before.

    Raises NotConverged, with the angle and the friction coefficient, and ValueError where the positions follow each
    other against the sense in which the gears turn.
    """
    sense = model.load.driving.sign
    span = sense * 2.0 * np.pi / model.pair.pinion.z / 20
    if len(pitch.angles) > 1:
        span = float(np.diff(pitch.angles).mean())
    if sense * span < 0.0:
        raise ValueError(f"pitch: wanted positions as they follow where the {model.load.driving.label} drives")
    for k in range(begin, len(pitch.angles)):
        position = _advanced(model, frictions, state, pitch.angles[k], span, HALVINGS, common, known.get(k))
        state, common = position.state, None
        yield position


def _advanced(
    model: GearModel, frictions: Sequence[float], state: SweepState, angle: float, span: float, halvings: int,
    common: SharedPosition | None = None, known: KnownSolution | None = None,
) -> SweptPosition:
    """The position at an angle, reached in up to 2^halvings steps. Raises NotConverged."""
    try:
        return _position(model, frictions, state, angle, span, common, known)
    except (NotConverged, SearchError) as failure:
        last = next((history.stand.angle for history in state.histories if history is not None), angle - span)
        if halvings == 0:
            raise NotConverged(
                f"pinion at {np.degrees(angle):.3f}°, also after {HALVINGS} halvings of the step: {failure}"
            ) from failure
        LOG.info("the step to %.4f° is halved: %s", np.degrees(angle), failure)
        middle = _advanced(model, frictions, state, 0.5 * (last + angle), 0.5 * span, halvings - 1)
        return _advanced(model, frictions, middle.state, angle, 0.5 * span, halvings - 1)


def _position(
    model: GearModel, frictions: Sequence[float], state: SweepState, angle: float, span: float,
    shared: SharedPosition | None, known: KnownSolution | None,
) -> SweptPosition:
    """Position at an angle, solved in one step. Raises NotConverged, SearchError."""
    begin = time.perf_counter()
    if shared is None:
        shared = shared_position(model, angle, state.predicted(angle), frictions, state.patch, known=known)
    histories, span = _histories(model, shared, frictions, state, span)
    jumps = _previous_jumps(shared, histories)
    spent = time.perf_counter() - begin
    results: list[PositionResult] = []
    updated: list[FrictionHistory | None] = []
    solved: list[Solved] = []
    for μ, history, jump in zip(frictions, histories, jumps, strict=True):
        begin = time.perf_counter()
        near = known.frictional.get(μ) if known is not None and shared.searched == known.searched else None
        result, state_at_μ = solve_position(model, shared, μ, jump, span, solved, near)
        solved.append(state_at_μ)
        contact, equilibrium = shared.contact, state_at_μ.equilibrium
        if model.deflected:
            deflected = deflected_equilibrium(model, contact, equilibrium, μ, history, span)
            contact, equilibrium = deflected.contact, deflected.equilibrium
            result = position_result(model, contact, equilibrium, μ, deflected.stiffness, shared.smooth.iterations)
        updated.append(FrictionHistory.of(model, contact, equilibrium) if history is not None else None)
        seconds = spent / len(frictions) + time.perf_counter() - begin
        results.append(replace(result, seconds=seconds))
    course = course_after(model, shared, state.course)
    after = SweepState(shared.contact.stand.beyond_nominal, tuple(updated), shared.patch, course)
    guesses = {each.friction: InitialGuess.of(each.equilibrium) for each in solved}
    return SweptPosition(
        angle, tuple(results), after, known=KnownSolution(shared.searched, InitialGuess.of(shared.smooth), guesses)
    )


def _histories(
    model: GearModel, shared: SharedPosition, frictions: Sequence[float], state: SweepState, span: float
) -> tuple[Histories, float]:
    """The history of each friction coefficient (None for μ = 0) and the step [rad] since then. Where there is none yet,
    the flanks are taken to have moved by `span` in the state in which they slide everywhere, as they nearly do."""
    kept = next((history for history in state.histories if history is not None), None)
    if kept is not None:
        return state.histories, shared.contact.stand.angle - kept.stand.angle
    rubs = [model.has_friction_terms(μ) for μ in frictions]
    return tuple(_first_history(model, shared, μ, span) if each else None for μ, each in zip(frictions, rubs)), span


def _first_history(model: GearModel, shared: SharedPosition, friction: float, span: float) -> FrictionHistory:
    """Flanks that slide everywhere, to `START` only: what is wrong of it decays with the first positions anyway."""
    heading, system = nominal_direction(shared.contact.geometry, span), replace(shared.system, tolerance=START)
    return FrictionHistory.of(model, shared.contact, sliding(system, friction, heading, shared.smooth))


def _previous_jumps(shared: SharedPosition, histories: Histories) -> list[PreviousJump | None]:
    """Interpolates each friction history, shared ones once; None where there is none."""
    different = list({id(history): history for history in histories if history is not None}.values())
    jumps = dict(zip(map(id, different), previous_jumps(shared.contact.geometry, different)))
    return [jumps.get(id(history)) for history in histories]
