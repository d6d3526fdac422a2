"""Branches of steady states over the speed, through folds: stable, unstable and stable again.

Pseudo-arclength continuation (Keller 1977; Seydel, Practical Bifurcation and Stability Analysis, 2010, chapter 4): the
next point is sought in the plane normal to the branch's tangent, a step ahead. So folds, where the speed has an
extremum along the branch and a motion that follows the speed has to jump, are points like all others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from evolvent.dynamics.oscillator.steady_state import (
    NoSteadyState,
    Scales,
    SteadyState,
    residual,
    steady_state,
    unscaled,
)
from evolvent.dynamics.oscillator.torsional_model import BEYOND_MEASURE, TorsionalModel
from evolvent_meshes.arrays import Bools, Floats, Ints

SPEED_SCALE = 0.1
"""Change of ln(speed) that counts as much as one static deflection."""
LONGEST, SHORTEST = 0.1, 1e-9
"""Steps along a branch, in static deflections; of the state over its size where that is above 1."""
STEEP, SHORT = 0.1, 0.02
"""Share of ln(speed) in the tangent below which a fold may be near, and the longest step then: the branch may turn back
and forth again within a step of the usual length, with almost the same tangent at both ends."""
SHARPEST = 1e-3
"""Damping ratio of the narrowest resonance that is not stepped over: each point is as near in ln(speed)."""
TURN = 0.97
"""Least cosine of the angle between the tangents of two points."""
CORNER = 1e-6
"""Steps below which the branch may have a corner: where flanks touch or part at phase 0 the damper sets in or ends."""
NEWTON_STEPS = 6
ACCURACY = 1e-11
FARTHEST, ROUND_A_CORNER = 0.25, 2.0
"""Distances from where the tangent leads, in steps, at which Newton's method is given up: it may come to another part
of the branch."""
MOST_POINTS = 20000
FOLD_ACCURACY = 1e-10
"""Accuracy of the position of a fold along a branch, over the step in which it lies."""


@dataclass(frozen=True, eq=False)
class Branch:
    """Steady states along a branch, in the order in which they follow each other."""

    points: tuple[SteadyState, ...]
    """Steady states from the first speed to the last."""
    folds: tuple[int, ...]
    """Indices of the points that are folds."""
    gaps: tuple[int, ...] = ()
    """Indices i of points that are not connected to point i + 1: the branch could not be followed further, from either
    side."""
    lost: tuple[str, ...] = ()
    """Reasons why the branch could not be followed further, as sentences."""

    @cached_property
    def periods(self) -> Floats:
        """Mesh periods (k,) [s] of the points."""
        return np.array([point.period for point in self.points])

    @cached_property
    def stable(self) -> Bools:
        """(k,) whether each point is stable."""
        return np.array([point.stable for point in self.points])

    def crossings(self, period: float) -> Ints:
        """Points i (n,) after which the branch passes a mesh period: between i and i + 1."""
        beyond = self.periods > period
        return np.setdiff1d(np.flatnonzero(beyond[1:] != beyond[:-1]), self.gaps)

    def backwards(self) -> Branch:
        """The branch from its last point to the first."""
        last = len(self.points) - 1
        folds, gaps = (last - i for i in reversed(self.folds)), (last - 1 - i for i in reversed(self.gaps))
        return Branch(self.points[::-1], tuple(folds), tuple(gaps), self.lost)

    def and_then(self, other: Branch) -> Branch:
        """This branch and another one, with a gap between them."""
        here = len(self.points)
        folds = self.folds + tuple(here + i for i in other.folds)
        gaps = (*self.gaps, here - 1, *(here + i for i in other.gaps))
        return Branch(self.points + other.points, folds, gaps, self.lost + other.lost)

    def go_on(self, other: Branch) -> Branch:
        """This branch, continued by another one that begins with its last point."""
        here = len(self.points) - 1
        folds, gaps = (here + i for i in other.folds), (here + i for i in other.gaps)
        return Branch(
            self.points + other.points[1:], (*self.folds, *folds), (*self.gaps, *gaps), self.lost + other.lost
        )


@dataclass(frozen=True, eq=False)
class _Point:
    """A point z = (s, ṡ, ln(speed)) in scaled units, on the branch."""

    z: Floats
    """(3,) s, ṡ and ln(speed) in scaled units."""
    tangent: Floats
    """(3,) unit tangent vector of the branch."""
    state: SteadyState


@dataclass(frozen=True, eq=False)
class _Track:
    """Oscillator in scaled units, in which a branch is followed."""

    model: TorsionalModel
    scales: Scales

    @cached_property
    def narrow(self) -> float:
        """Longest step of ln(speed), in scaled units: half the width of a resonance."""
        model = self.model
        ratio = (model.damping + model.ground_damping) / (2.0 * model.mass * model.fastest)
        return min(LONGEST, max(ratio, SHARPEST) / SPEED_SCALE)

    def longest(self, here: _Point) -> float:
        """Longest step along the branch from a point."""
        size, along = max(1.0, float(np.linalg.norm(here.z[:2]))), np.abs(here.tangent)
        far = size * (SHORT if along[2] < STEEP else LONGEST)
        return float(1.0 / max(np.linalg.norm(along[:2]) / far, along[2] / self.narrow))

    def steady(self, z: Floats) -> tuple[Floats, Floats, SteadyState]:
        """Residual (2,), derivatives (2, 3) by z, and the state at z (3,)."""
        period, state = float(np.exp(-SPEED_SCALE * z[2])), z[:2] * self.scales.array
        found, change = residual(self.model, self.scales, period, state)
        known = SteadyState(period, state, unscaled(change, self.scales))
        change[:, 2] *= -SPEED_SCALE
        return found, change, known

    def scaled(self, state: SteadyState) -> Floats:
        """Scaled coordinates z (3,) of a steady state."""
        return np.append(state.state / self.scales.array, -np.log(state.period) / SPEED_SCALE)

    def is_near(self, here: _Point, there: _Point, length: float) -> bool:
        """Whether a point is so near to another one that the branch is simple between them."""
        return bool(there.tangent @ here.tangent > TURN) and length <= 2.0 * self.longest(there)

    def onto(self, start: _Point, length: float) -> tuple[_Point, int] | None:
        """The point a length ahead of another one, and the steps of Newton's method; None where it does not come
        there."""
        ahead = start.z + length * start.tangent
        z = ahead
        for count in range(NEWTON_STEPS):
            found, change, state = self.steady(z)
            if np.abs(found).max() <= ACCURACY * max(1.0, float(np.abs(z[:2]).max())):
                return _Point(z, _tangent(change, start.tangent), state), count
            if not np.isfinite(change).all():
                break
            plane = np.append(found, start.tangent @ (z - start.z) - length)
            z = z - np.linalg.lstsq(np.vstack([change, start.tangent]), plane, rcond=None)[0]
            if not np.linalg.norm(z - ahead) < (FARTHEST if length > CORNER else ROUND_A_CORNER) * length:
                break
        return None


def follow(model: TorsionalModel, start: SteadyState, last_period: float) -> Branch:
    """The branch from a steady state until the mesh period is `last_period` [s] or the first one again, or until it
    cannot be followed further: then `lost` says why."""
    track = _Track(model, Scales.of(model))
    points, folds = [start], list[int]()
    lost: tuple[str, ...] = ()
    try:
        for point, fold in _points(track, start, last_period):
            if fold:
                folds.append(len(points))
            points.append(point)
    except NoSteadyState as error:
        lost = (str(error),)
    return Branch(tuple(points), tuple(folds), lost=lost)


def _points(track: _Track, start: SteadyState, last_period: float) -> Iterator[tuple[SteadyState, bool]]:
    """The points after the first one, and whether each is a fold."""
    rising = start.period > last_period
    z = track.scaled(start)
    ends = sorted((z[2], -np.log(last_period) / SPEED_SCALE))
    heading = np.array([0.0, 0.0, 1.0 if rising else -1.0])
    here, length = _Point(z, _tangent(track.steady(z)[1], heading), start), LONGEST
    for _ in range(MOST_POINTS):
        following, length = _next(track, here, length)
        if here.tangent[2] * following.tangent[2] < 0.0:
            fold = _between(track, here, following, lambda point: point.tangent[2])
            if ends[0] <= fold.z[2] <= ends[1]:
                yield fold.state, True
        if not ends[0] <= following.z[2] <= ends[1]:
            last = _at_speed(track, here, following, ends[int(following.z[2] > ends[1])])
            end = last_period if (following.z[2] > ends[1]) == rising else start.period
            yield steady_state(track.model, end, last.state.state), False
            return
        yield following.state, False
        if track.model.escaped(following.state.state):
            raise NoSteadyState(
                f"branch of steady states at {track.model.place(following.state.period)}: wanted motions of a gear "
                f"pair, found one whose mesh deflects by {BEYOND_MEASURE:g} times the static deflection and its "
                "unloaded error, and growing; give more damping"
            )
        here = following
    raise NoSteadyState(
        f"branch of steady states at {track.model.place(here.state.period)}: wanted its end within {MOST_POINTS} "
        "points, found none; ask for a narrower range of speeds, or give more damping"
    )


def _next(track: _Track, here: _Point, length: float) -> tuple[_Point, float]:
    """The next point of the branch, and the step to take from it."""
    length = min(length, track.longest(here))
    while length > SHORTEST:
        found = track.onto(here, length)
        if found is not None and (length <= CORNER or track.is_near(here, found[0], length)):
            return found[0], length * (2.0 if found[1] <= 3 else 1.0)
        length *= 0.5
    raise NoSteadyState(
        f"branch of steady states at {track.model.place(here.state.period)}: wanted a next one, found none however "
        "near; ask for speeds on one side of it, or give more damping"
    )


def _at_speed(track: _Track, before: _Point, after: _Point, z: float) -> _Point:
    """Point between two others at which ln(speed) in scaled units is z."""
    return _between(track, before, after, lambda point: point.z[2] - z)


def _between(track: _Track, before: _Point, after: _Point, value: Callable[[_Point], float]) -> _Point:
    """Point between two others at which a value is 0 that has different signs at both."""

    def at(length: float) -> _Point:
        found = track.onto(before, length)
        if found is None:
            raise NoSteadyState(
                f"branch of steady states at {track.model.place(before.state.period)}: wanted the points around a "
                "fold or the last speed, found none; ask for other speeds, or give more damping"
            )
        return found[0]

    whole = float(before.tangent @ (after.z - before.z))
    return at(brentq(lambda length: value(at(length)), 0.0, whole, xtol=FOLD_ACCURACY * whole))


def _tangent(change: Floats, along: Floats) -> Floats:
    """Unit vector (3,) that derivatives (2, 3) map to 0, on the side of another one."""
    vector = np.cross(change[0], change[1])
    vector /= np.linalg.norm(vector)
    return np.asarray(vector if vector @ along >= 0.0 else -vector)


def between(one: SteadyState, other: SteadyState, period: float) -> Floats:
    """State (2,) on a straight line between two, at a period."""
    share = (period - one.period) / (other.period - one.period)
    return np.asarray(one.state + share * (other.state - one.state))
