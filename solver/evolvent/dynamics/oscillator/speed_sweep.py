"""Steady states at given speeds, and which of them a gear pair takes that runs up, and down.

The branch of steady states is followed from the lowest speed to the highest, through its folds. At each of the speeds
all points of it are refined. A pair that runs up follows the branch as long as that is stable; from its end, a fold or
a doubled period, the motion is integrated in time until it repeats, and the branch taken up where it ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from evolvent.dynamics.oscillator.continuation import Branch, between, follow
from evolvent.dynamics.oscillator.settling import MOST_PERIODS, Settled, decay_periods, settled, static_state
from evolvent.dynamics.oscillator.steady_state import NoSteadyState, Scales, SteadyState, damped_less, steady_state
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats

SAME = 1e-6
"""Distance below which two states are the same, in static deflections."""
STABILITY_ACCURACY = 1e-9
"""Relative accuracy of the mesh period at which a branch loses its stability."""
MOST_PIECES = 20
"""Most gaps between pieces of the branch that are not connected; further pieces are not sought."""


@dataclass(frozen=True, eq=False)
class OnBranch:
    """A steady state at one of the speeds."""

    place: float
    """Position on the branch: i + share of the way from point i to i + 1."""
    state: SteadyState
    """Steady state, stable or not."""


@dataclass(frozen=True, eq=False)
class Running:
    """Motion at one speed of a pair that runs up or down slowly."""

    motion: SteadyState | Settled
    """A steady state, or a motion that does not repeat with every mesh."""
    place: float | None
    """Position on the branch, as in `OnBranch`; None for a motion that is not on it."""
    left_at: float | None
    """Mesh period [s] at which the pair has left the branch since the preceding speed: that of the fold, or where
    stability is lost otherwise. None where it has not left it."""

    @property
    def jumped(self) -> bool:
        """Whether the pair has left the branch since the preceding speed."""
        return self.left_at is not None

    @property
    def repeats(self) -> int:
        """Mesh periods after which the motion repeats; 0 where it does not (`Settled`)."""
        return self.motion.repeats if isinstance(self.motion, Settled) else 1

    @property
    def escaped(self) -> bool:
        """Whether the motion grows beyond measure (`TorsionalModel.escaped`)."""
        return isinstance(self.motion, Settled) and self.motion.escaped


@dataclass(frozen=True, eq=False)
class SpeedSweep:
    """Motions at speeds in ascending order."""

    periods: Floats
    """Mesh periods (n,) [s], descending."""
    branch: Branch
    """All steady states, with the folds between them."""
    coexisting: tuple[tuple[OnBranch, ...], ...]
    """Steady states at each speed, in their order along the branch; stable or not."""
    up: tuple[Running, ...]
    """Motions at the speeds (n,) of a pair that runs up slowly."""
    down: tuple[Running, ...]
    """Motions at the speeds (n,) of a pair that runs down slowly, in ascending order of the speed."""


def sweep_speeds(
    model: TorsionalModel, periods: Floats, beyond: tuple[float, float] | None = None,
    computed: Callable[[], None] = lambda: None,
) -> SpeedSweep:
    """Steady states at mesh periods (n,) [s], two at least, descending.

    beyond: longest and shortest mesh period from and to which the branch is followed, where those of the speeds lie
    within: a branch that turns back within the speeds may leave them on its way.
    computed: called twice a speed, once its motion running up and once that running down are known.

    Raises NoSteadyState where there is none to begin with, neither at the longest nor at the shortest of them.
    """
    longest, shortest = beyond or (0.0, np.inf)
    begin, end = max(longest, float(periods[0])), min(shortest, float(periods[-1]))
    known = _Steady(model, np.asarray(periods, dtype=float), (begin, end), _branch(model, begin, end))
    numbers = range(len(periods))
    up, down = _run(known, numbers, computed), _run(known, numbers[::-1], computed)[::-1]
    return SpeedSweep(known.periods, known.branch, tuple(map(tuple, known.coexisting)), tuple(up), tuple(down))


def _branch(model: TorsionalModel, begin: float, end: float) -> Branch:
    """Branch of steady states from one mesh period to another, followed from both ends where one does not suffice."""
    try:
        first = follow(model, _some_steady_state(model, begin), end)
    except NoSteadyState as error:
        second = follow(model, _some_steady_state(model, end), begin).backwards()
        return replace(second, lost=(str(error), *second.lost))
    if first.points[-1].period == end:
        return first
    try:
        second = follow(model, _some_steady_state(model, end), begin).backwards()
    except NoSteadyState as error:
        return replace(first, lost=(*first.lost, str(error)))
    return first.and_then(second)


def _some_steady_state(model: TorsionalModel, period: float) -> SteadyState:
    """Steady state to which a pair settles from rest; one near that by `damped_less` where it settles to none. Raises
    NoSteadyState."""
    motion = settled(model, period, static_state(model))
    if motion.repeats == 1:
        return steady_state(model, period, motion.state)
    return damped_less(model, period, static_state(model))


class _Steady:
    """Steady states known so far. Pieces of the branch are added at its end, so that positions on it stay."""

    def __init__(self, model: TorsionalModel, periods: Floats, ends: tuple[float, float], branch: Branch) -> None:
        """Finds the steady states of a branch at mesh periods. ends: mesh periods between which branches are
        followed."""
        self.model, self.periods, self.ends, self.branch = model, periods, ends, branch
        self.coexisting = [list(self._refined(float(period), 0)) for period in periods]

    def add(self, state: SteadyState) -> None:
        """Adds the branch through a steady state that is not on the known one."""
        both = [follow(self.model, state, end) for end in self.ends]
        piece = both[0].backwards().go_on(both[1])
        first = len(self.branch.points)
        self.branch = self.branch.and_then(piece)
        for period, states in zip(self.periods, self.coexisting):
            states += self._refined(float(period), first)

    def _refined(self, period: float, first: int) -> Iterator[OnBranch]:
        """The steady states at a mesh period from the point `first` on, in their order along the branch."""
        points, periods = self.branch.points, self.branch.periods
        crossings = {int(i) for i in self.branch.crossings(period)}
        begins, ends = {0, *(i + 1 for i in self.branch.gaps)}, {*self.branch.gaps, len(points) - 1}
        alone = {i for i in begins - crossings if periods[i] == period}
        alone |= {i for i in ends if periods[i] == period and i - 1 not in crossings}
        for i in sorted(i for i in crossings | alone if i >= first):
            if i in alone:
                yield OnBranch(float(i), points[i])
                continue
            share = float((period - periods[i]) / (periods[i + 1] - periods[i]))
            start = between(points[i], points[i + 1], period)
            yield OnBranch(float(i) + share, steady_state(self.model, period, start))


def _run(known: _Steady, order: range, computed: Callable[[], None]) -> list[Running]:
    """The motions of a pair that takes the speeds one after the other, in this order of their numbers. computed: called
    after each."""
    stable = [each for each in known.coexisting[order[0]] if each.state.stable]
    first = float(known.periods[order[0]])
    found = [_start(known.model, first, stable if order.step > 0 else stable[::-1])]
    for number in order[1:]:
        computed()
        before, period = found[-1], float(known.periods[number])
        along = None if before.place is None else _along(known.branch, before.place, known.coexisting[number])
        if along is not None:
            found.append(Running(along.state, along.place, None))
            continue
        left_at = _left_at(known, before, number, rising=order.step > 0)
        most = decay_periods(known.model, period) if before.place is None else MOST_PERIODS
        motion = settled(known.model, period, _left_with(known.model, before), most)
        found.append(_landed(known, motion, number, left_at))
    computed()
    return found


def _left_with(model: TorsionalModel, before: Running) -> Floats:
    """Initial state (2,) at a speed, from the motion at the preceding one: from rest where that grew beyond measure."""
    return static_state(model) if before.escaped else before.motion.state


def _start(model: TorsionalModel, period: float, stable: Sequence[OnBranch]) -> Running:
    """Motion at the first speed. stable: stable steady states there, of which a pair that comes from outside has the
    first."""
    if stable:
        return Running(stable[0].state, stable[0].place, None)
    return Running(settled(model, period, static_state(model)), None, None)


def _along(branch: Branch, place: float, states: Sequence[OnBranch]) -> OnBranch | None:
    """The state that the branch leads to without a fold or a gap, stable all the way; None where there is none."""
    for each in states:
        low, high = sorted((place, each.place))
        between = slice(int(np.ceil(low)), int(np.floor(high)) + 1)
        turned = any(low <= fold <= high for fold in branch.folds) or any(low <= gap < high for gap in branch.gaps)
        if each.state.stable and branch.stable[between].all() and not turned:
            return each
    return None


def _left_at(known: _Steady, before: Running, number: int, rising: bool) -> float | None:
    """Mesh period [s] at which the branch ends for a pair that follows it to the speed of this number, beyond its end;
    None where the pair was not on it. Where no end is found before that speed, it is that."""
    model, branch, period = known.model, known.branch, float(known.periods[number])
    if before.place is None or not isinstance(before.motion, SteadyState):
        return None
    first, last = max(int(np.ceil(before.place)) - 1, 0), before.motion
    step = 1 if (branch.periods[first + 1] < branch.periods[first]) == rising else -1
    i = first + 1 if step > 0 else int(np.floor(before.place))
    while 0 <= i < len(branch.points):
        if min(i, i - step) in branch.gaps:
            return last.period
        if (branch.periods[i] > period) != rising:
            break
        if i in branch.folds:
            return float(branch.periods[i])
        if not branch.stable[i]:
            return _unstable_from(model, last, branch.points[i])
        last, i = branch.points[i], i + step
    low, high = sorted((i - step, i))
    beyond = [each.state for each in known.coexisting[number] if low <= each.place <= high and not each.state.stable]
    return _unstable_from(model, last, beyond[0]) if beyond else period


def _unstable_from(model: TorsionalModel, stable: SteadyState, unstable: SteadyState) -> float:
    """Mesh period [s] between those of two states of a branch without a fold between them, at which the larger of
    Floquet's multipliers is 1."""

    def excess(period: float) -> float:
        found = steady_state(model, period, between(stable, unstable, period))
        return float(np.abs(found.multipliers).max()) - 1.0

    return float(brentq(excess, stable.period, unstable.period, rtol=STABILITY_ACCURACY))


def _landed(known: _Steady, motion: Settled, number: int, left_at: float | None) -> Running:
    """Motion at a speed after the pair has left the branch, with its position where it has settled on the branch again.
    number: of the speed. left_at: as in `Running`."""
    if motion.repeats != 1:
        return Running(motion, None, left_at)
    same = _same(known, motion, number)
    if same is None and len(known.branch.gaps) < MOST_PIECES:
        try:
            known.add(steady_state(known.model, float(known.periods[number]), motion.state))
        except NoSteadyState:
            return Running(motion, None, left_at)
        same = _same(known, motion, number)
    return Running(motion, None, left_at) if same is None else Running(same.state, same.place, left_at)


def _same(known: _Steady, motion: Settled, number: int) -> OnBranch | None:
    """The stable state that a motion has settled to, of those known at the speed of this number."""
    scale = Scales.of(known.model).array
    for each in known.coexisting[number]:
        if each.state.stable and np.abs((each.state.state - motion.state) / scale).max() < SAME:
            return each
    return None
