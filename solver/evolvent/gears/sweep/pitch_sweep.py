"""A pitch of gear positions, one after the other; a generator of converged results.

All teeth of a gear are alike, so one base pitch holds every tooth's whole engagement: at pinion rotation φ + 2π/z_1
tooth pair i stands where pair i + 1 stood at φ. Later pitches are never computed, they are put together by shifting.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import compress, cycle

import numpy as np

from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.deflected_flanks import settled
from evolvent.gears.sweep.friction_history import Footprint, Memory, Past, recalled, remembered
from evolvent.gears.sweep.position import (
    PositionResult,
    SharedPosition,
    Solved,
    position_result,
    shared_position,
    solve_position,
)

HALVINGS = 4
LOG = logging.getLogger("evolvent")


@dataclass(frozen=True)
class SweepState:
    """Where a sweep stands: everything that the next position needs.

    extra: rotations [rad] to start the next search from. memories: of each friction coefficient that was solved with
    (None: no past).
    footprint: where the flanks were pressed. Without extra and footprint the next position is the same, but takes more
    searches and iterations.
    """

    extra: tuple[float, float]
    memories: tuple[Memory | None, ...]
    footprint: Footprint | None = None

    def of(self, coefficients: np.ndarray) -> SweepState:
        """The same for some of its friction coefficients, (frictions,) bool."""
        return replace(self, memories=tuple(compress(self.memories, coefficients)))

    def earlier(self, pitches: int) -> SweepState:
        """The same so many base pitches earlier."""
        memories = tuple(None if memory is None else memory.earlier(pitches) for memory in self.memories)
        return replace(self, memories=memories)


@dataclass(frozen=True)
class SweptPosition:
    """One angle's results, one per friction coefficient that was solved with, and the state to go on from. again: the
    angle was solved before; closes: with it the sweep is complete."""

    angle: float
    results: tuple[PositionResult, ...]
    state: SweepState
    again: bool = False
    closes: bool = False

    def of(self, coefficients: np.ndarray) -> SweptPosition:
        """The same for some of its friction coefficients, (frictions,) bool."""
        return replace(self, results=tuple(compress(self.results, coefficients)), state=self.state.of(coefficients))


def joined(parts: Sequence[SweptPosition]) -> SweptPosition:
    """A position of which each part has some friction coefficients."""
    results = tuple(result for part in parts for result in part.results)
    memories = tuple(memory for part in parts for memory in part.state.memories)
    return replace(parts[0], results=results, state=replace(parts[0].state, memories=memories))


@dataclass(frozen=True)
class Pitch:
    """Which pinion rotations [rad] to solve. pitches: how many base pitches they are, where they are equal steps of
    some."""

    angles: tuple[float, ...]
    pitches: int = 1


def uniform_pitch(z1: int, positions: int, pitches: int = 1) -> Pitch:
    """`positions` equal steps over each base pitch 2π/z_1."""
    step = 2.0 * np.pi / z1 / positions
    return Pitch(tuple(float(step * k) for k in range(pitches * positions)), pitches)


def initial_state(frictions: Sequence[float]) -> SweepState:
    """The state before the first position."""
    return SweepState((0.0, 0.0), tuple(None for _ in frictions))


def sweep_pitch(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, begin: int = 0,
    common: SharedPosition | None = None,
) -> Iterator[SweptPosition]:  # fmt: skip
    """Solves pitch.angles[begin:] in turn. A position that fails is approached by up to four halvings of the step.

    common: what the coefficients share of the first position, if it is there already.

    Raises NotConverged, with the angle and the friction coefficient.
    """
    span = float(np.diff(pitch.angles).mean()) if len(pitch.angles) > 1 else 2.0 * np.pi / model.pair.pinion.z / 20
    for k in range(begin, len(pitch.angles)):
        position = _advance(model, frictions, state, pitch.angles[k], span, HALVINGS, common)
        state, common = position.state, None
        yield position


def _advance(
    model: GearModel, frictions: Sequence[float], state: SweepState, angle: float, span: float, halvings: int,
    common: SharedPosition | None = None,
) -> SweptPosition:  # fmt: skip
    try:
        return _position(model, frictions, state, angle, span, common)
    except NotConverged as failure:
        last = next((m.stand.angle for m in state.memories if m is not None), angle - span)
        if halvings == 0:
            raise NotConverged(
                f"pinion at {np.degrees(angle):.3f}°, also after {HALVINGS} halvings of the step: {failure}"
            ) from failure
        LOG.info("the step to %.4f° is halved: %s", np.degrees(angle), failure)
        middle = _advance(model, frictions, state, 0.5 * (last + angle), 0.5 * span, halvings - 1)
        return _advance(model, frictions, middle.state, angle, 0.5 * span, halvings - 1)


def _position(
    model: GearModel, frictions: Sequence[float], state: SweepState, angle: float, span: float,
    shared: SharedPosition | None,
) -> SweptPosition:  # fmt: skip
    begin = time.perf_counter()
    if shared is None:
        shared = shared_position(model, angle, state.extra, frictions, state.footprint)
    before, span = _remembered(model, shared, frictions, state, span)
    pasts = iter(_pasts(shared, before))
    spent = time.perf_counter() - begin
    results: list[PositionResult] = []
    memories: list[Memory | None] = []
    solved: list[Solved] = []
    for μ, memory in zip(frictions, before):
        begin = time.perf_counter()
        result, found = solve_position(model, shared, μ, next(pasts) if memory is not None else None, span, solved)
        solved.append(found)
        contact, equilibrium = shared.contact, found.state
        if model.deflected:
            bent = settled(model, contact, equilibrium, μ, memory, span)
            contact, equilibrium = bent.contact, bent.found
            result = position_result(model, contact, equilibrium, μ, bent.stiffness, shared.smooth.iterations)
        memories.append(remembered(model, contact, equilibrium) if memory is not None else None)
        seconds = spent / len(frictions) + time.perf_counter() - begin
        results.append(replace(result, seconds=seconds))
    after = SweepState(shared.contact.stand.extra, tuple(memories), shared.footprint)
    return SweptPosition(angle, tuple(results), after)


def _remembered(
    model: GearModel, shared: SharedPosition, frictions: Sequence[float], state: SweepState, span: float
) -> tuple[tuple[Memory | None, ...], float]:
    """The memory of each friction coefficient (None for μ = 0) and the step [rad] since then. Where nothing is
    remembered, the flanks are taken to have moved by `span` in the state without friction."""
    kept = next((memory for memory in state.memories if memory is not None), None)
    if kept is not None:
        return state.memories, shared.contact.stand.angle - kept.stand.angle
    rough = [model.has_friction_terms(μ) for μ in frictions]
    fresh = remembered(model, shared.contact, shared.smooth) if any(rough) else None
    return tuple(fresh if slips else None for slips in rough), span


def _pasts(shared: SharedPosition, memories: Sequence[Memory | None]) -> Iterator[Past]:
    """What each memory tells; the same one is asked once."""
    known = [memory for memory in memories if memory is not None]
    if len(known) > 1 and all(memory is known[0] for memory in known):
        return cycle(recalled(shared.contact, known[:1]))
    return iter(recalled(shared.contact, known))
