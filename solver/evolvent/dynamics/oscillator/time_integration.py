"""The same equation by SciPy's integrator, split where a side of the teeth is touched or left: the check of everything
else in this room. It shares the data of the mesh force with it, not the code."""

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
"""Tolerance, relative; that of s and ṡ themselves is this times the static deflection and its velocity."""
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
    while t < end:
        borders = [_border(sides[r], period, leaving=r == region) for r in sides if region in (0, r)]
        found = solve_ivp(
            _motion(model, region, sides, period), (t, end), y, "DOP853", events=borders,
            rtol=relative, atol=tolerance, max_step=0.2 / model.fastest,
        )  # fmt: skip
        if found.status < 0:
            raise RuntimeError(f"time integration at {t:.6g} s: {found.message}")
        t, y = float(found.t[-1]), found.y[:, -1]
        if found.status == 1:
            which = next(i for i, times in enumerate(found.t_events) if len(times))
            region = 0 if region else (1, -1)[which]
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


def _border(side: _SmoothSide, period: float, leaving: bool) -> Callable[[float, Floats], float]:
    """Event: a side is touched, or left."""

    def border(t: float, y: Floats) -> float:
        return side.depth(t / period, float(y[0]))

    border.terminal, border.direction = True, -1.0 if leaving else 1.0  # type: ignore[attr-defined]
    return border


def _cubic(c: list[float], t: float) -> float:
    """Of ascending powers."""
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]))


def _slope(c: list[float], t: float) -> float:
    """Its derivative."""
    return c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])
