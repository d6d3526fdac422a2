"""Adaptive integration of the wear equation dh/dN = r(h) in blocks of cycles.

Explicit blocks: an Adams-Bashforth predictor from the rates at the start of this block and of the last one, and a
trapezoid corrector; their difference is the error estimate. One evaluation of the rate a block, but ripples grow where
a block is longer than STABLE_SHARE of their decay time. Implicit blocks: backward Euler, stable for any length; the
error estimate is the difference from the trapezoid rule. States are immutable: a rejected block changes nothing.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.wear.archard import StepsTooLong
from evolvent.wear.mesh_motion import MeshInverted, MeshVolumeLost
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError, ResultError

LOG = logging.getLogger("evolvent")
SAFETY = 0.8  # of the length at which the error would equal the tolerance
MAX_GROWTH, MAX_CUT = 2.0, 0.2  # of the next block's length over this one's
SHORTEST = 2.0**-12  # of the first block, or of the stability limit: shorter blocks are not tried
STABLE_SHARE = 0.5
"""Largest stable length of an explicit block over a ripple's decay time. The amplification factors of a ripple are the
roots r of r³ + (2z − 1) r² − 1.5 z r + z/2, z this ratio; at z = 0.5 one of them is −1."""
RETRIED_ERRORS = (NotConverged, SearchError, StepsTooLong, MeshInverted, MeshVolumeLost)
"""Errors after which a shorter block is tried."""
NEGATIVE_DEPTH = 1e-6  # of a block's largest depth: how negative a depth may be by rounding


class WearStopped(ResultError):
    """No block, however short, was accepted; the message gives the number of cycles and the reason."""


@dataclass(frozen=True)
class BlockSettings:
    """Settings of the block stepping.

    first: length of the first block [cycles]; the error estimate shortens no block below it.
    tolerance: largest error of a block: misplaced volume over its whole volume.
    implicit: implicit blocks (backward Euler) instead of explicit ones.
    deformation_share: largest depth of an explicit block over the contact's elastic deformation; without effect on
        gear pairs, whose deformation is infinite by definition.

    Raises InputError unless all numbers are above zero.

    >>> BlockSettings(first=100.0, tolerance=0.02)
    BlockSettings(first=100.0, tolerance=0.02, implicit=True, deformation_share=inf)
    """

    first: float
    tolerance: float = 0.05
    implicit: bool = True
    deformation_share: float = np.inf

    def __post_init__(self) -> None:
        for name in ("first", "tolerance", "deformation_share"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"wear blocks: wanted {name} above zero, found {getattr(self, name)}")


@dataclass(frozen=True)
class CycleEvaluation:
    """Wear rate of one cycle at given depths.

    rate: (n,) depth per cycle at all worn nodes [mm].
    areas: (n,) of these nodes [mm²; mm in 2D].
    deformation: elastic deformation of the contact [mm]; infinite where it is not computed.
    ripple_decay: cycles in which the shortest ripple of the mesh decays to 1/e.
    """

    rate: Floats
    areas: Floats
    deformation: float
    ripple_decay: float


E = TypeVar("E", bound=CycleEvaluation, covariant=True)


class WearModel(Protocol[E]):
    """Interface of a wear model to block stepping: wear rates, implicit blocks and mesh updates."""

    def evaluate(self, depth: Floats, previous: Any = None) -> E:
        """Evaluates one cycle at depths (n,) [mm].

        previous: an evaluation at nearby depths, of which anything may be reused. Raises NotConverged, SearchError.
        """
        ...

    def implicit_block(self, depth: Floats, start: Any, length: float) -> tuple[Floats, E]:
        """Depths (n,) [mm] worn off in `length` cycles from depths (n,), at the rate of the block's end, and the
        evaluation there.

        start: the evaluation at the block's start. Raises NotConverged, SearchError.
        """
        ...

    def accept(self, depth: Floats, end: Any) -> E:
        """The evaluation at depths (n,) of a block about to be accepted, after any mesh update.

        end: the evaluation before the mesh update. Raises one of RETRIED_ERRORS, and then changes nothing.
        """
        ...


@dataclass(frozen=True)
class PreviousBlock:
    """The block before, for the predictor.

    rate: (n,) at its start [mm per cycle].
    length: cycles in it.
    """

    rate: Floats
    length: float


@dataclass(frozen=True)
class WearState(Generic[E]):
    """State of a study between two blocks.

    cycles: number of cycles done.
    depth: (n,) worn depths [mm].
    evaluation: the cycle evaluated at these depths.
    previous: the block before; None at the beginning.
    next_length: length of the next block [cycles].
    """

    cycles: float
    depth: Floats
    evaluation: E
    previous: PreviousBlock | None
    next_length: float


@dataclass(frozen=True)
class Block(Generic[E]):
    """An accepted block.

    state: at its end.
    end: the evaluation at its end before the mesh update, which belongs to the block's volume; where there was no
        update, that of the state.
    length: cycles in it.
    error: misplaced volume over its whole volume.
    refused: number of longer blocks that were tried before.
    """

    state: WearState[E]
    end: E
    length: float
    error: float
    refused: int


def initial_wear_state(model: WearModel[E], depth: Floats, settings: BlockSettings) -> WearState[E]:
    """The state at depths (n,) [mm] from which a study starts. Raises NotConverged, SearchError."""
    return WearState(0.0, depth, model.evaluate(depth), None, settings.first)


def next_block(model: WearModel[E], state: WearState[E], end: float, settings: BlockSettings) -> Block[E]:
    """The next block, which ends at `end` cycles at the latest.

    Raises WearStopped where no block is accepted; `state` is unchanged.
    """
    limit = _length_limit(state, settings)
    length, refused = min(state.next_length, end - state.cycles, limit), 0
    shortest, reason = SHORTEST * min(settings.first, end - state.cycles, limit), ""
    while length >= shortest:
        try:
            candidate, error = _attempt(model, state, length, settings)
            if error <= settings.tolerance or length <= settings.first:
                evaluation = model.accept(candidate.depth, candidate.evaluation)
                following = max(length * _length_factor(error, settings), min(length, settings.first))
                if refused == 0:  # a block shortened to `end` does not limit the next one
                    following = max(following, state.next_length if length < state.next_length else 0.0)
                accepted = replace(candidate, evaluation=evaluation, next_length=following)
                return Block(accepted, candidate.evaluation, length, error, refused)
        except RETRIED_ERRORS as failure:
            LOG.info("block of %.6g cycles after %.6g: %s", length, state.cycles, failure)
            length, refused, reason = 0.5 * length, refused + 1, str(failure)
            continue
        length, refused, reason = length * min(_length_factor(error, settings), 0.7), refused + 1, f"error {error:.2g}"
        length = max(length, settings.first)
    raise WearStopped(
        f"wear after {state.cycles:.6g} cycles: wanted a block with an error below {settings.tolerance:g}, found none "
        f"down to {length:.3g} cycles ({reason}); the last good state is kept: refine the mesh, allow more error, or "
        "wear off less"
    )


def _attempt(
    model: WearModel[E], state: WearState[E], length: float, settings: BlockSettings
) -> tuple[WearState[E], float]:
    """The state after a block of `length` cycles, and the block's error. Raises one of RETRIED_ERRORS."""
    start = state.evaluation.rate
    if settings.implicit:
        worn_off, end = model.implicit_block(state.depth, state.evaluation, length)
        difference = worn_off - 0.5 * length * (start + end.rate)
    else:
        slope = 0.0 if state.previous is None else (start - state.previous.rate) / state.previous.length
        predicted = length * np.maximum(start + 0.5 * length * slope, 0.0)
        end = model.evaluate(state.depth + predicted, state.evaluation)
        worn_off = 0.5 * length * (start + end.rate)
        difference = worn_off - predicted
    if not (np.isfinite(worn_off).all() and worn_off.min(initial=0.0) >= -NEGATIVE_DEPTH * worn_off.max(initial=0.0)):
        raise NotConverged(
            f"wear: wanted no negative depth from a block of {length:.6g} cycles, found {worn_off.min():.2g} mm; take "
            "a shorter block"
        )
    areas, volume = state.evaluation.areas, float(state.evaluation.areas @ worn_off)
    error = float(areas @ np.abs(difference)) / volume if volume > 0.0 else 0.0
    after = WearState(
        state.cycles + length, state.depth + worn_off, end, PreviousBlock(start, length), length
    )
    return after, error


def _length_limit(state: WearState[E], settings: BlockSettings) -> float:
    """Largest length [cycles] of an explicit block: stable, and with an allowed depth over the deformation."""
    if settings.implicit:
        return np.inf
    rate = float(state.evaluation.rate.max(initial=0.0))
    by_depth = settings.deformation_share * state.evaluation.deformation / rate if rate > 0.0 else np.inf
    return min(by_depth, STABLE_SHARE * state.evaluation.ripple_decay)


def _length_factor(error: float, settings: BlockSettings) -> float:
    """Factor on the length for an error at the tolerance: the relative error grows linearly with the length."""
    return float(np.clip(SAFETY * settings.tolerance / max(error, 1e-12), MAX_CUT, MAX_GROWTH))
