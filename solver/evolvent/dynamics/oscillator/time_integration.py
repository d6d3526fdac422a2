"""The same equation by SciPy's integrator, split where a side of the teeth is touched or left: the check of everything
else in this room. It shares the data of the mesh force with it, not the code."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import OptimizeResult

from evolvent.dynamics.oscillator.mesh_law import MeshSide
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats

RELATIVE = 1e-12
"""Tolerance, relative; that of s and ṡ themselves is this times the static deflection and its velocity."""
AFTER_TURN = 0.02
"""Of the stiffest oscillation [rad], in which a motion that has turned does not turn again."""
Motion = Callable[[float, Floats], list[float]]


def integrate(
    model: TorsionalModel, period: float, state: Floats, periods: int = 1, relative: float = RELATIVE
) -> Floats:
    """State (2,) [mm, mm/s] after some mesh periods of so many seconds, from (2,) at phase 0."""
    y, (stops, _) = np.asarray(state, dtype=float), model.intervals
    for _ in range(periods):
        for begin, end in pairwise(stops):
            y = _smooth_interval(model, period, y, begin * period, end * period, relative)
    return y


@dataclass(frozen=True, eq=False)
class _SmoothSide:
    """A side of the teeth in one of its phase intervals, in plain numbers: SciPy calls for one state at a time."""

    sign: float
    start: float
    """Phase at which it begins."""
    offset: list[float]
    depths: list[float]
    force: list[list[list[float]]]

    @staticmethod
    def around(side: MeshSide, middle: float) -> _SmoothSide:
        cell = int(np.searchsorted(side.phases, middle)) - 1
        return _SmoothSide(
            float(side.sign), float(side.phases[cell]), side.offset[cell].tolist(), side.depths.tolist(),
            side.force[cell].tolist(),
        )  # fmt: skip

    def depth(self, τ: float, s: float) -> float:
        """x [mm]."""
        return self.sign * s - _cubic(self.offset, τ - self.start)

    def error_slope(self, τ: float) -> float:
        """de/dτ [mm]."""
        return _slope(self.offset, τ - self.start)

    def pressed(self, τ: float, x: float) -> float:
        """F [N]; beyond the last depth it goes on straight."""
        last = self.depths[-1]
        b = min(max(bisect_right(self.depths, x) - 1, 0), len(self.depths) - 2)
        along = [_cubic(powers, τ - self.start) for powers in self.force[b]]
        within = min(x, last) - self.depths[b]
        beyond = x - last
        return _cubic(along, within) + (_slope(along, within) * beyond if beyond > 0.0 else 0.0)


def _smooth_interval(
    model: TorsionalModel, period: float, y: Floats, begin: float, end: float, relative: float
) -> Floats:
    """From one time [s] to another, between which e and the stiffness are smooth."""
    middle, t = 0.5 * (begin + end) / period, begin
    sides = {r: _SmoothSide.around(side, middle) for r, side in ((1, model.law.front), (-1, model.law.back))}
    tolerance = relative * abs(model.load) / model.law.stiffest() * np.array([1.0, model.fastest])
    region = next((r for r, side in sides.items() if side.depth(t / period, float(y[0])) > 0.0), 0)
    motions = {r: _motion(model, r, sides, period) for r in (-1, 0, 1)}

    def solved(y: Floats, begin: float, end: float, events: list[Event]) -> OptimizeResult:
        found = solve_ivp(
            motions[region], (begin, end), y, "DOP853", events=events, rtol=relative, atol=tolerance,
            max_step=0.2 / model.fastest,
        )  # fmt: skip
        if found.status < 0:
            raise RuntimeError(f"time integration at {begin:.6g} s: {found.message}")
        return found

    turned = False
    while t < end:
        watched = [sides[r] for r in sides if region in (0, r)]
        borders = [_border(side, period, leaving=region != 0) for side in watched]
        turns = [_turn(side, period, leaving=region != 0) for side in watched]
        if turned:
            found = solved(y, t, min(end, t + AFTER_TURN / model.fastest), borders)
        else:
            found = solved(y, t, end, [*borders, *turns])
        turned = found.status == 1 and not any(map(len, found.t_events[: len(borders)]))
        if turned and any(border(found.t[-1], found.y[:, -1]) * border.direction > 0.0 for border in borders):
            found, turned = solved(y, t, float(found.t[-1]), borders), False
        t, y = float(found.t[-1]), found.y[:, -1]
        if found.status == 1 and not turned:
            which = next(i for i, times in enumerate(found.t_events) if len(times))
            other = -region if region else (1, -1)[which]
            reached = sides[other].depth(t / period, float(y[0])) >= 0.0  # at once where there is no backlash
            region = other if reached or not region else 0
    return y


def _motion(model: TorsionalModel, region: int, sides: dict[int, _SmoothSide], period: float) -> Motion:
    """Right side of the equation while a side touches, 1 or −1, or none, 0."""
    side = sides.get(region, sides[1])
    damper = sides[1] if model.damped_apart else side

    def motion(t: float, y: Floats) -> list[float]:
        s, v = y.tolist()
        force = model.load - model.ground_damping * v
        if region:
            force -= side.sign * side.pressed(t / period, side.depth(t / period, s))
        if region or model.damped_apart:
            force -= model.damping * (v - damper.sign * damper.error_slope(t / period) / period)
        return [v, force / model.mass]

    return motion


class Event:
    """What SciPy's integrator stops at: where a value changes its sign in one direction."""

    terminal = True

    def __init__(self, value: Callable[[float, Floats], float], direction: float) -> None:
        self.value, self.direction = value, direction

    def __call__(self, t: float, y: Floats) -> float:
        """The value at a time [s] and a state (2,)."""
        return self.value(t, y)


def _border(side: _SmoothSide, period: float, leaving: bool) -> Event:
    """A side is left, or touched."""
    return Event(lambda t, y: side.depth(t / period, float(y[0])), -1.0 if leaving else 1.0)


def _turn(side: _SmoothSide, period: float, leaving: bool) -> Event:
    """The depth is least, or greatest: a border that is crossed for less than a step is seen there."""

    def rate(t: float, y: Floats) -> float:
        return side.sign * float(y[1]) - side.error_slope(t / period) / period

    return Event(rate, 1.0 if leaving else -1.0)


def _cubic(c: list[float], t: float) -> float:
    """Of ascending powers."""
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]))


def _slope(c: list[float], t: float) -> float:
    """Its derivative."""
    return c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])
