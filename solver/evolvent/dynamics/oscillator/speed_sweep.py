"""Steady states at given speeds, and which of them a gear pair takes that runs up, and down.

The branch of steady states is followed from the lowest speed to the highest, through its folds. At each of the speeds
all points of it are refined. A pair that runs up follows the branch as long as that is stable; from its end, a fold or
a doubled period, the motion is integrated in time until it repeats, and the branch taken up where it ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.dynamics.oscillator.continuation import Branch, between, follow
from evolvent.dynamics.oscillator.settling import Settled, settled, static_state
from evolvent.dynamics.oscillator.steady_state import NoSteadyState, Scales, SteadyState, damped_less, steady_state
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats

SAME = 1e-6
"""Distance of two states that are one, in static deflections."""


@dataclass(frozen=True, eq=False)
class OnBranch:
    """A steady state at one of the speeds."""

    place: float
    """Between which points of the branch: i + share of the way from point i to i + 1."""
    state: SteadyState
    """Stable or not."""


@dataclass(frozen=True, eq=False)
class Running:
    """The motion of a pair that has come to a speed."""

    motion: SteadyState | Settled
    """A steady state, or a motion that does not repeat with every mesh."""
    place: float | None
    """On the branch; None where it is not on it."""
    jumped: bool
    """Whether it did not get there along the branch."""

    @property
    def repeats(self) -> int:
        """Mesh periods after which it repeats; 0 where it does not, see `Settled`."""
        return self.motion.repeats if isinstance(self.motion, Settled) else 1


@dataclass(frozen=True, eq=False)
class SpeedSweep:
    """Motions at speeds in ascending order."""

    periods: Floats
    """Mesh periods (n,) [s], descending."""
    branch: Branch
    """All steady states, with the folds between them."""
    coexisting: tuple[tuple[OnBranch, ...], ...]
    """At each speed, in their order along the branch; stable or not."""
    up: tuple[Running, ...]
    """Of a pair that runs up slowly, at each speed."""
    down: tuple[Running, ...]
    """Of one that runs down slowly, at each speed; in ascending order, too."""


def sweep_speeds(model: TorsionalModel, periods: Floats, beyond: tuple[float, float] | None = None) -> SpeedSweep:
    """Steady states at mesh periods (n,) [s], two at least, descending.

    beyond: longest and shortest mesh period from and to which the branch is followed, where those of the speeds lie
    within: a branch that turns back within the speeds may leave them on its way.

    Raises NoSteadyState where there is none to begin with, neither at the longest nor at the shortest of them.
    """
    longest, shortest = beyond or (0.0, np.inf)
    begin, end = max(longest, float(periods[0])), min(shortest, float(periods[-1]))
    branch = _branch(model, begin, end)
    coexisting = [tuple(_refined(model, branch, float(period))) for period in periods]
    up = _run(model, branch, periods, coexisting)
    down = _run(model, branch, periods[::-1], coexisting[::-1])[::-1]
    return SpeedSweep(np.asarray(periods), branch, tuple(coexisting), tuple(up), tuple(down))


def speeds_to_periods(speeds: Floats, teeth: int) -> Floats:
    """Mesh periods (n,) [s] at speeds (n,) [r/min] of a gear with so many teeth."""
    return 60.0 / (np.asarray(speeds, dtype=float) * teeth)


def _branch(model: TorsionalModel, begin: float, end: float) -> Branch:
    """From one mesh period to another, followed from both of them where it cannot be from one."""
    try:
        first = follow(model, _some_steady_state(model, begin), end)
    except NoSteadyState as error:
        second = follow(model, _some_steady_state(model, end), begin)
        return Branch((), ()).and_then(replace(second, lost=(str(error), *second.lost)))
    if first.points[-1].period == end:
        return first
    try:
        second = follow(model, _some_steady_state(model, end), begin)
    except NoSteadyState as error:
        return replace(first, lost=(*first.lost, str(error)))
    return first.and_then(second)


def _some_steady_state(model: TorsionalModel, period: float) -> SteadyState:
    """The one that a pair settles to from rest, or one near that where it settles to none. Raises NoSteadyState."""
    motion = settled(model, period, static_state(model))
    if motion.repeats == 1:
        return steady_state(model, period, motion.state)
    return damped_less(model, period, static_state(model))


def _refined(model: TorsionalModel, branch: Branch, period: float) -> Iterator[OnBranch]:
    """The branch's steady states at a mesh period, in their order along it."""
    periods, last = branch.periods, len(branch.points) - 1
    if period == periods[0]:
        yield OnBranch(0.0, branch.points[0])
    for i in branch.crossings(period):
        share = float((period - periods[i]) / (periods[i + 1] - periods[i]))
        if 0.0 < i + share < last:
            start = between(branch.points[i], branch.points[i + 1], period)
            yield OnBranch(float(i) + share, steady_state(model, period, start))
    if period == periods[last]:
        yield OnBranch(float(last), branch.points[last])


def _run(
    model: TorsionalModel, branch: Branch, periods: Floats, coexisting: Sequence[Sequence[OnBranch]]
) -> list[Running]:
    """The motions of a pair that takes the speeds one after the other."""
    stable = [each for each in coexisting[0] if each.state.stable]
    rising = periods[0] > periods[-1]
    found = [_start(model, float(periods[0]), stable if rising else stable[::-1])]
    for period, states in zip(periods[1:], coexisting[1:]):
        before = found[-1]
        along = None if before.place is None else _along(branch, before.place, states)
        if along is not None:
            found.append(Running(along.state, along.place, False))
            continue
        motion = settled(model, float(period), before.motion.state)
        found.append(_landed(model, motion, states, before.place is not None))
    return found


def _start(model: TorsionalModel, period: float, stable: Sequence[OnBranch]) -> Running:
    """At the first speed. stable: the state that the pair would have come from outside in first."""
    if stable:
        return Running(stable[0].state, stable[0].place, False)
    return Running(settled(model, period, static_state(model)), None, False)


def _along(branch: Branch, place: float, states: Sequence[OnBranch]) -> OnBranch | None:
    """The state that the branch leads to without a fold, stable all the way; None where there is none."""
    for each in states:
        low, high = sorted((place, each.place))
        between = slice(int(np.ceil(low)), int(np.floor(high)) + 1)
        if each.state.stable and branch.stable[between].all() and not any(low <= fold <= high for fold in branch.folds):
            return each
    return None


def _landed(model: TorsionalModel, motion: Settled, states: Sequence[OnBranch], left: bool) -> Running:
    """Where a motion ended. left: whether it left the branch just now."""
    scale = Scales.of(model).array
    for each in states:
        if motion.repeats == 1 and each.state.stable and np.abs((each.state.state - motion.state) / scale).max() < SAME:
            return Running(each.state, each.place, left)
    return Running(motion, None, left)
