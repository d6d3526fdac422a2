"""Blocks of cycles: dh/dN = r(h) with a length of block that an error estimate chooses.

Explicit: the rates of this block's start and of the last one foretell the block's end, the rate there corrects it by
the trapezoid rule; their difference is the error. One rate a block, but ripples where a block is longer than the
contact takes to wear them off. Implicit: the rate is that of the block's end (Euler), stable for any length; the error
is the difference from the trapezoid rule. A state is a value: a block that is refused leaves nothing behind.
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
SAFETY, LONGER, SHORTER = 0.8, 2.0, 0.2  # of the next block's length over this one's
SHORTEST = 2.0**-12  # of the first block, or of a stable one: shorter ones are not tried
STABLE = 0.5
"""How long an explicit block may be over a ripple's decay: in longer ones ripples grow. (By how much a block multiplies
them are the roots r of r³ + (2z − 1) r² − 1.5 z r + z/2, z this ratio; at z = 0.5 one of them is −1.)"""
TOO_LONG = (NotConverged, SearchError, StepsTooLong, MeshInverted, MeshVolumeLost)
"""What a shorter block may do without."""
NEGATIVE = 1e-6  # of a block's largest depth: a depth below minus that is no rounding


class WearStopped(ResultError):
    """No block, however short, could be made; the message says from where on and why."""


@dataclass(frozen=True)
class BlockSettings:
    """How blocks are made.

    first: length of the first block [cycles]; none is made shorter because of its error. tolerance: the share of a
    block's volume that may be worn off in the wrong place. implicit: see above. deformation_share: largest depth of an
    explicit block over the contact's deformation, where the cycle tells it (that of a problem does, a pitch not).
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
class Evaluated:
    """One cycle on a worn state: rate (n,) [mm per cycle] of all nodes that wear, their areas (n,) [mm²; mm in 2D], the
    contact's deformation [mm], and the cycles in which the shortest ripple that the mesh can have decays to 1/e."""

    rate: Floats
    areas: Floats
    deformation: float
    decay: float


E = TypeVar("E", bound=Evaluated, covariant=True)


class Wearable(Protocol[E]):
    """What wears: the rate of a state."""

    def evaluate(self, depth: Floats, before: Any = None) -> E:
        """One cycle at depths (n,). before: what this returned at depths near by, of which it may use what it likes.
        Raises NotConverged, SearchError."""
        ...

    def implicit(self, depth: Floats, now: Any, length: float) -> tuple[Floats, E]:
        """What a block of so many cycles takes away from depths (n,), (n,) [mm], at the rate of its end; and the cycle
        there. now: the cycle at its start. Raises NotConverged, SearchError."""
        ...

    def accepted(self, depth: Floats, now: Any) -> E:
        """The cycle at depths (n,) of a block that is to be accepted, once the meshes have followed where they have to;
        now: before that. Raises what makes a block TOO_LONG, and leaves everything as it was."""
        ...


@dataclass(frozen=True)
class WearState(Generic[E]):
    """After so many cycles: depths (n,) [mm], the cycle there, the rate (n,) and length of the block before, and the
    length of the next one."""

    cycles: float
    depth: Floats
    now: E
    last: tuple[Floats, float] | None
    length: float


@dataclass(frozen=True)
class Block(Generic[E]):
    """A finished block.

    state: at its end. end: the cycle there before the meshes followed, which the block's own volume is of; where none
    did that of the state. length: cycles. error: its error over its volume. refused: how many longer ones were.
    """

    state: WearState[E]
    end: E
    length: float
    error: float
    refused: int


def unworn(wearable: Wearable[E], depth: Floats, settings: BlockSettings, cycles: float = 0.0) -> WearState[E]:
    """The state to begin with, at depths (n,)."""
    return WearState(cycles, depth, wearable.evaluate(depth), None, settings.first)


def next_block(wearable: Wearable[E], state: WearState[E], end: float, settings: BlockSettings) -> Block[E]:
    """The next block, which ends at `end` cycles at the latest. Raises WearStopped."""
    longest = _longest(state, settings)
    length, refused = min(state.length, end - state.cycles, longest), 0
    least, why = SHORTEST * min(settings.first, end - state.cycles, longest), ""
    while length >= least:
        try:
            tried, error = _tried(wearable, state, length, settings)
            if error <= settings.tolerance or length <= settings.first:
                now = wearable.accepted(tried.depth, tried.now)
                following = max(length * _change(error, settings), min(length, settings.first))
                if refused == 0:  # a block that was cut off by the end says nothing against its length
                    following = max(following, state.length if length < state.length else 0.0)
                return Block(replace(tried, now=now, length=following), tried.now, length, error, refused)
        except TOO_LONG as failure:
            LOG.info("block of %.6g cycles after %.6g: %s", length, state.cycles, failure)
            length, refused, why = 0.5 * length, refused + 1, str(failure)
            continue
        length, refused, why = length * min(_change(error, settings), 0.7), refused + 1, f"error {error:.2g}"
        length = max(length, settings.first)
    raise WearStopped(
        f"wear after {state.cycles:.6g} cycles: wanted a block with an error below {settings.tolerance:g}, found none "
        f"down to {length:.3g} cycles ({why}); the last good state is kept: refine the mesh, allow more error, or wear "
        "off less"
    )


def _tried(
    wearable: Wearable[E], state: WearState[E], length: float, settings: BlockSettings
) -> tuple[WearState[E], float]:
    """The state after a block, and its error over its volume."""
    begin = state.now.rate
    if settings.implicit:
        gained, end = wearable.implicit(state.depth, state.now, length)
        error = gained - 0.5 * length * (begin + end.rate)
    else:
        slope = 0.0 if state.last is None else (begin - state.last[0]) / state.last[1]
        foretold = length * np.maximum(begin + 0.5 * length * slope, 0.0)
        end = wearable.evaluate(state.depth + foretold, state.now)
        gained = 0.5 * length * (begin + end.rate)
        error = gained - foretold
    if not (np.isfinite(gained).all() and gained.min(initial=0.0) >= -NEGATIVE * gained.max(initial=0.0)):
        raise NotConverged(f"a block of {length:.6g} cycles would put {-gained.min():.2g} mm of material on")
    areas, volume = state.now.areas, float(state.now.areas @ gained)
    share = float(areas @ np.abs(error)) / volume if volume > 0.0 else 0.0
    return WearState(state.cycles + length, state.depth + gained, end, (begin, length), length), share


def _longest(state: WearState[E], settings: BlockSettings) -> float:
    """The length that is stable, and at which the depth at today's rate is the allowed share of the deformation;
    without a limit where the pressure follows the wear within the block."""
    if settings.implicit:
        return np.inf
    rate = float(state.now.rate.max(initial=0.0))
    share = settings.deformation_share * state.now.deformation / rate if rate > 0.0 else np.inf
    return min(share, STABLE * state.now.decay)


def _change(error: float, settings: BlockSettings) -> float:
    """Of the length: a block's relative error grows like its length."""
    return float(np.clip(SAFETY * settings.tolerance / max(error, 1e-12), SHORTER, LONGER))
