"""The same equation by SciPy's integrator, split where a side of the teeth is touched or left: the check of everything
else in this room. It shares the data of the mesh force with it, not the code."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from evolvent.dynamics.oscillator.mesh_law import MeshSide
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Floats

RELATIVE = 1e-12
"""Tolerance, relative; that of s and ṡ themselves is this times the static deflection and its velocity."""
Motion = Callable[[float, Floats], list[float]]


def integrate(model: TorsionalModel, period: float, state: Floats, periods: int = 1) -> Floats:
    """State (2,) [mm, mm/s] after some mesh periods of so many seconds, from (2,) at phase 0."""
    y, (stops, _) = np.asarray(state, dtype=float), model.intervals
    for _ in range(periods):
        for begin, end in pairwise(stops):
            y = _smooth_interval(model, period, y, begin * period, end * period)
    return y


def _smooth_interval(model: TorsionalModel, period: float, y: Floats, begin: float, end: float) -> Floats:
    """From one time [s] to another, between which e and the stiffness are smooth."""
    middle, t = 0.5 * (begin + end) / period, begin
    sides = {1: model.law.front, -1: model.law.back}
    tolerance = RELATIVE * abs(model.load) / model.law.stiffest() * np.array([1.0, model.fastest])
    region = next((r for r, side in sides.items() if _depth(side, middle, t / period, y[0]) > 0.0), 0)
    while t < end:
        borders = [_border(sides[r], middle, period, leaving=r == region) for r in sides if region in (0, r)]
        found = solve_ivp(
            _motion(model, region, middle, period), (t, end), y, "DOP853", events=borders, rtol=RELATIVE,
            atol=tolerance, max_step=0.2 / model.fastest,
        )  # fmt: skip
        if found.status < 0:
            raise RuntimeError(f"time integration at {t:.6g} s: {found.message}")
        t, y = float(found.t[-1]), found.y[:, -1]
        if found.status == 1:
            which = next(i for i, times in enumerate(found.t_events) if len(times))
            region = 0 if region else (1, -1)[which]
    return y


def _motion(model: TorsionalModel, region: int, middle: float, period: float) -> Motion:
    """Right side of the equation while a side touches, 1 or −1, or none, 0; e and F of the phase interval around
    `middle`."""
    side = model.law.back if region < 0 else model.law.front

    def motion(t: float, y: Floats) -> list[float]:
        s, v = y
        force = model.load - model.ground_damping * v
        if region:
            force -= side.sign * _force(side, middle, t / period, _depth(side, middle, t / period, s))
        if region or model.damped_apart:
            force -= model.damping * (v - side.sign * _error(side, middle, t / period, 1) / period)
        return [v, force / model.mass]

    return motion


def _border(side: MeshSide, middle: float, period: float, leaving: bool) -> Callable[[float, Floats], float]:
    """Event: a side is touched, or left."""

    def border(t: float, y: Floats) -> float:
        return _depth(side, middle, t / period, y[0])

    border.terminal, border.direction = True, -1.0 if leaving else 1.0  # type: ignore[attr-defined]
    return border


def _depth(side: MeshSide, middle: float, τ: float, s: float) -> float:
    """x [mm]."""
    return side.sign * s - _error(side, middle, τ, 0)


def _error(side: MeshSide, middle: float, τ: float, order: int) -> float:
    """e [mm] or its derivative by τ, in the phase interval around `middle`."""
    cell = int(np.searchsorted(side.phases, middle)) - 1
    return float(np.polynomial.Polynomial(side.offset[cell]).deriv(order)(τ - side.phases[cell]))


def _force(side: MeshSide, middle: float, τ: float, x: float) -> float:
    """F [N]; beyond the last depth it goes on straight."""
    cell, last = int(np.searchsorted(side.phases, middle)) - 1, side.depths[-1]
    b = int(np.clip(np.searchsorted(side.depths, x) - 1, 0, len(side.depths) - 2))
    powers = side.force[cell, b] @ (τ - side.phases[cell]) ** np.arange(4)
    along = np.polynomial.Polynomial(powers)
    within = min(x, last) - side.depths[b]
    return float(along(within) + along.deriv()(within) * max(x - last, 0.0))
