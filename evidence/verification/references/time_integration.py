"""Reference integration of the oscillator by SciPy, split where a side of the teeth is touched or left. It checks the
compiled integration, with which it shares the data of the mesh force but no code."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from evolvent.dynamics.oscillator.mesh_law import MeshSide
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats

RELATIVE = 1e-12
"""Relative tolerance; that of s and ṡ themselves is this times the static deflection and its velocity."""
AFTER_BORDER = 1e-3
"""Phase of the stiffest oscillation [rad] after a contact border, or a turn near it, in which that border is
ignored."""
SAME_PLACE = 1e-12
"""Distance below which the contact borders of both sides coincide, over the static deflection."""
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
    """Phase at which the interval begins."""
    offset: list[float]
    depths: list[float]
    force: list[list[list[float]]]

    @staticmethod
    def around(side: MeshSide, middle: float) -> _SmoothSide:
        cell = int(np.searchsorted(side.phases, middle)) - 1
        return _SmoothSide(
            float(side.sign), float(side.phases[cell]), side.offset[cell].tolist(), side.depths.tolist(),
            side.force[cell].tolist(),
        )

    def depth(self, τ: float, s: float) -> float:
        """Depth x = ±s − e [mm]."""
        return self.sign * s - _cubic(self.offset, τ - self.start)

    def error_slope(self, τ: float) -> float:
        """Slope de/dτ [mm] of the unloaded error."""
        return _slope(self.offset, τ - self.start)

    def pressed(self, τ: float, x: float) -> float:
        """Force F [N]; linear beyond the last depth."""
        last = self.depths[-1]
        b = min(max(bisect_right(self.depths, x) - 1, 0), len(self.depths) - 2)
        along = [_cubic(powers, τ - self.start) for powers in self.force[b]]
        within = min(x, last) - self.depths[b]
        beyond = x - last
        return _cubic(along, within) + (_slope(along, within) * beyond if beyond > 0.0 else 0.0)


def _smooth_interval(
    model: TorsionalModel, period: float, y: Floats, begin: float, end: float, relative: float
) -> Floats:
    """State (2,) after integration from one time [s] to another, between which e and the stiffness are smooth."""
    middle, t = 0.5 * (begin + end) / period, begin
    sides = {r: _SmoothSide.around(side, middle) for r, side in ((1, model.law.front), (-1, model.law.back))}
    deflection = abs(model.load) / model.law.stiffest
    legs = _Legs(model, sides, period, relative, relative * deflection * np.array([1.0, model.fastest]))
    region, passed = legs.touching(t, y), 0
    while t < end:
        t, y, event = legs.next(region, passed, t, y, end)
        if event is None:
            region, passed = legs.touching(t, y), 0
        elif event.turn:
            passed = event.side
        elif region == 0 or sides[-region].depth(t / period, float(y[0])) >= -SAME_PLACE * deflection:
            region = passed = event.side if region == 0 else -region  # at once where there is no backlash
        else:
            region, passed = 0, region
    return y


@dataclass(frozen=True, eq=False)
class _Legs:
    """Parts of a smooth interval between borders of contact, and the turns before them: a contact or a flight that is
    shorter than a step is seen where its depth is greatest or least."""

    model: TorsionalModel
    sides: dict[int, _SmoothSide]
    period: float
    relative: float
    """Relative tolerance of the integration."""
    absolute: Floats
    """(2,) absolute tolerances of s [mm] and ṡ [mm/s]."""

    def touching(self, t: float, y: Floats) -> int:
        """The side that touches, 1 or −1; 0 where none does."""
        return next((r for r, side in self.sides.items() if side.depth(t / self.period, float(y[0])) > 0.0), 0)

    def next(
        self, region: int, passed: int, t: float, y: Floats, end: float
    ) -> tuple[float, Floats, _Event | None]:
        """Time [s] and state (2,) at the end of the next leg, and what ends it. passed: the side at whose border, or
        turn before it, the leg begins: it is short then, and does not end there; 0 for none."""
        watched = [r for r in self.sides if region in (0, r) and r != passed]
        borders = [self._event(r, leaving=region != 0) for r in watched]
        turns = [self._event(r, leaving=region != 0, turn=True) for r in watched]
        if passed:
            return self._until(borders, region, t, y, min(end, t + AFTER_BORDER / self.model.fastest))
        after, state, event = self._until([*borders, *turns], region, t, y, end)
        if event is not None and event.turn and any(each(after, state) * each.direction > 0.0 for each in borders):
            return self._until(borders, region, t, y, after)
        return after, state, event

    def _until(
        self, events: list[_Event], region: int, t: float, y: Floats, end: float
    ) -> tuple[float, Floats, _Event | None]:
        """Integrates to the first of the events, or to the end [s]."""
        found = solve_ivp(
            _motion(self.model, region, self.sides, self.period), (t, end), y, "DOP853", events=events,
            rtol=self.relative, atol=self.absolute, max_step=0.2 / self.model.fastest,
        )
        if found.status < 0:
            raise RuntimeError(f"time integration at {t:.6g} s: {found.message}")
        event = next((each for each, times in zip(events, found.t_events or ()) if len(times)), None)
        return float(found.t[-1]), found.y[:, -1], event

    def _event(self, r: int, leaving: bool, turn: bool = False) -> _Event:
        return _Event(self.sides[r], self.period, r, -1.0 if leaving != turn else 1.0, turn)


def _motion(model: TorsionalModel, region: int, sides: dict[int, _SmoothSide], period: float) -> Motion:
    """Right-hand side of the equation of motion while a side touches, 1 or −1, or none, 0."""
    side = sides.get(region, sides[1])
    damper = sides[1] if model.damping_in_separation else side

    def motion(t: float, y: Floats) -> list[float]:
        s, v = y.tolist()
        force = model.load - model.ground_damping * v
        if region:
            force -= side.sign * side.pressed(t / period, side.depth(t / period, s))
        if region or model.damping_in_separation:
            force -= model.damping * (v - damper.sign * damper.error_slope(t / period) / period)
        return [v, force / model.mass]

    return motion


@dataclass(frozen=True, eq=False)
class _Event:
    """Event at which SciPy's integrator stops: a border of contact, or a turn of the depth."""

    of: _SmoothSide
    period: float
    side: int
    """Side of the teeth: 1 or −1."""
    direction: float
    """Sign change at which the event stops the integration: 1 to positive, −1 to negative values."""
    turn: bool
    terminal: bool = True

    def __call__(self, t: float, y: Floats) -> float:
        """Depth [mm] at a time [s] and a state (2,), or its rate [mm/s] for a turn."""
        if self.turn:
            return self.of.sign * float(y[1]) - self.of.error_slope(t / self.period) / self.period
        return self.of.depth(t / self.period, float(y[0]))


def _cubic(c: list[float], t: float) -> float:
    """Cubic polynomial at t; c: its coefficients (4,) by ascending powers."""
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]))


def _slope(c: list[float], t: float) -> float:
    """Derivative by t of the cubic polynomial with the coefficients c (4,) by ascending powers."""
    return c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])
