"""Integration of the oscillator between the kinks of its force, in compiled code.

    s' = T v,   v' = T a,   a = [F_0 − F(s, τ) − c(v − ė) − c_g v] / m          (τ: phase in mesh periods of T seconds)

Runge-Kutta steps of order 8 (the tableau of SciPy's DOP853) end at every phase where the force is not smooth, and where
a side of the teeth is touched or left: that phase is found by a root search over the length of the last step, not by
interpolation. With s and v their derivatives by s_0, v_0 and ln T are integrated. Where the force jumps, because
damping acts in contact only, they jump along (di Bernardo et al., Piecewise-smooth Dynamical Systems, 2008, chapter 2:
saltation matrix).

SciPy's own integrators take milliseconds for a mesh period, this one 0.1 ms; they are the check of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.integrate import DOP853

from evolvent.dynamics.oscillator.mesh_law import MeshSide
from evolvent_meshes.arrays import Floats, Ints

A, B, C = np.ascontiguousarray(DOP853.A), np.ascontiguousarray(DOP853.B), np.ascontiguousarray(DOP853.C)
STAGES = len(B)
STEP = 0.12
"""Length of a step, over the time in which the stiffest oscillation turns by 1 rad: its error is then near rounding
where the force is smooth, and 1e-8 of the deflection where a step passes from one interval of x to the next."""
SIZE = 8
"""Of a state: s [mm], v [mm/s], and the derivatives of s and of v by s_0, v_0 and ln T."""
BACK, FREE, FRONT = -1, 0, 1
"""Which side of the teeth touches."""
ROOT_STEPS = 60
CLOSE = 1e-15
"""Accuracy of the length of a step that ends where a side is touched or left, over the step."""
HALVINGS = 40
"""Of a step within which a side is touched and left again."""


class Oscillator(NamedTuple):
    """What compiled code needs of the model."""

    mass: float
    """m [t]."""
    damping: float
    """c of the mesh [N·s/mm]."""
    always: bool
    """Whether it acts in free flight, too."""
    ground: float
    """c_g [N·s/mm]."""
    load: float
    """F_0 [N]."""
    front: MeshSide
    """The loaded flanks."""
    back: MeshSide
    """The others."""


@njit(cache=True, error_model="numpy")
def offset_at(side: MeshSide, cell: int, τ: float) -> tuple[float, float]:
    """e(τ) [mm] and de/dτ in a phase interval."""
    t, c = τ - side.phases[cell], side.offset[cell]
    return c[0] + t * (c[1] + t * (c[2] + t * c[3])), c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])


@njit(cache=True, error_model="numpy")
def force_at(side: MeshSide, cell: int, τ: float, x: float) -> tuple[float, float]:
    """F(x, τ) [N] and ∂F/∂x [N/mm] in a phase interval."""
    t, last = τ - side.phases[cell], side.depths[-1]
    within = min(x, last)
    b = min(max(np.searchsorted(side.depths, within) - 1, 0), len(side.depths) - 2)
    d, force, slope = within - side.depths[b], 0.0, 0.0
    for j in range(3, -1, -1):
        c = side.force[cell, b, j]
        slope = slope * d + force
        force = force * d + (c[0] + t * (c[1] + t * (c[2] + t * c[3])))
    return force + slope * max(x - last, 0.0), slope


@njit(cache=True, error_model="numpy")
def depth_at(side: MeshSide, cell: int, τ: float, T: float, s: float, v: float) -> tuple[float, float]:
    """x = ±s − e [mm] of a side, and dx/dτ."""
    e, slope = offset_at(side, cell, τ)
    return side.sign * s - e, side.sign * T * v - slope


@njit(cache=True, error_model="numpy")
def acceleration(
    o: Oscillator, region: int, front: int, back: int, τ: float, T: float, s: float, v: float
) -> tuple[float, float, float, float]:
    """a [mm/s²] and its derivatives by s, v and ln T. front, back: phase intervals of both sides."""
    force, by_s, by_v, by_T = o.load - o.ground * v, 0.0, -o.ground, 0.0
    if region == BACK:
        side, cell = o.back, back
    else:
        side, cell = o.front, front
    e, slope = offset_at(side, cell, τ)
    if region != FREE:
        pressed, stiffness = force_at(side, cell, τ, side.sign * s - e)
        force -= side.sign * pressed
        by_s -= stiffness
    if region != FREE or o.always:
        rate = side.sign * slope / T
        force -= o.damping * (v - rate)
        by_v -= o.damping
        by_T -= o.damping * rate
    return force / o.mass, by_s / o.mass, by_v / o.mass, by_T / o.mass


@njit(cache=True, error_model="numpy")
def step(
    o: Oscillator, region: int, front: int, back: int, τ: float, h: float, T: float, y: Floats, stages: Floats,
    out: Floats,
) -> None:  # fmt: skip
    """One step of length h of the state y (8,) at τ, into out (8,); stages (12, 8): room for the stages."""
    for i in range(STAGES):
        for n in range(SIZE):
            total = 0.0
            for j in range(i):
                total += A[i, j] * stages[j, n]
            out[n] = y[n] + h * total
        a, by_s, by_v, by_T = acceleration(o, region, front, back, τ + C[i] * h, T, out[0], out[1])
        stages[i, 0], stages[i, 1] = T * out[1], T * a
        for n in range(2, 5):
            stages[i, n] = T * out[n + 3]
            stages[i, n + 3] = T * (by_s * out[n] + by_v * out[n + 3])
        stages[i, 4] += T * out[1]
        stages[i, 7] += T * (a + by_T)
    for n in range(SIZE):
        total = 0.0
        for i in range(STAGES):
            total += B[i] * stages[i, n]
        out[n] = y[n] + h * total


@njit(cache=True, error_model="numpy")
def reserve(
    o: Oscillator, region: int, front: int, back: int, τ: float, T: float, y: Floats
) -> tuple[int, float, float]:
    """The region beyond the nearest border of the present one, the distance to it [mm], and its change by τ."""
    if region == FREE:
        ahead, ahead_rate = depth_at(o.front, front, τ, T, y[0], y[1])
        behind, behind_rate = depth_at(o.back, back, τ, T, y[0], y[1])
        return (FRONT, -ahead, -ahead_rate) if ahead > behind else (BACK, -behind, -behind_rate)
    if region == FRONT:
        x, rate = depth_at(o.front, front, τ, T, y[0], y[1])
    else:
        x, rate = depth_at(o.back, back, τ, T, y[0], y[1])
    return FREE, x, rate


@njit(cache=True, error_model="numpy")
def region_at(o: Oscillator, front: int, back: int, τ: float, T: float, y: Floats) -> int:
    """Which side touches at a state."""
    if depth_at(o.front, front, τ, T, y[0], y[1])[0] > 0.0:
        return FRONT
    return BACK if depth_at(o.back, back, τ, T, y[0], y[1])[0] > 0.0 else FREE


@njit(cache=True, error_model="numpy")
def length_to_border(
    o: Oscillator, region: int, front: int, back: int, τ: float, h: float, T: float, y: Floats, stages: Floats,
    out: Floats,
) -> float:  # fmt: skip
    """Length of the step from y whose end, in out, lies on the border of the region; h is one that goes beyond it."""
    low, high, length = 0.0, h, h
    for _ in range(ROOT_STEPS):
        step(o, region, front, back, τ, length, T, y, stages, out)
        _, left, rate = reserve(o, region, front, back, τ + length, T, out)
        if abs(left) <= -rate * CLOSE * h or high - low <= CLOSE * h:
            break
        if left > 0.0:
            low = length
        else:
            high = length
        newton = length - left / rate if rate < 0.0 else low
        length = newton if low < newton < high else 0.5 * (low + high)
    return length


@njit(cache=True, error_model="numpy")
def cross(o: Oscillator, region: int, y: Floats) -> None:
    """The jump of the derivatives in y (8,) where `region` is left: only the damping force c ẋ jumps there, and of a
    start that comes later by dt the velocity has another c ẋ dt/m, with ẋ dt = ds."""
    if o.always:
        return
    for n in range(2, 5):
        y[n + 3] += o.damping / o.mass * (-y[n] if region == FREE else y[n])


@njit(cache=True, error_model="numpy")
def advance(
    o: Oscillator, stops: Floats, cells: Ints, T: float, longest: float, y: Floats, path: Floats
) -> float:
    """Integrates the state y (8,) from the first to the last of the phases stops (k + 1,), in place.

    cells: (k, 2) phase intervals of both sides.
    longest: step [mesh periods].
    path: (k + 1, 5) takes s, v, the region, the mesh force and e of the loaded flanks at all stops; of length 0 where
    they are not wanted.

    Returns the phase [mesh periods] spent out of contact.
    """
    stages, out = np.empty((STAGES, SIZE)), np.empty(SIZE)
    region, apart = region_at(o, cells[0, 0], cells[0, 1], stops[0], T, y), 0.0
    for k in range(len(cells)):
        front, back = cells[k, 0], cells[k, 1]
        if len(path):
            record(o, region, front, back, stops[k], T, y, path[k])
        τ, end = stops[k], stops[k + 1]
        while end - τ > 0.0:
            count = np.ceil((end - τ) / longest)
            h, ends = (end - τ) / count, count == 1.0
            for _ in range(HALVINGS):
                step(o, region, front, back, τ, h, T, y, stages, out)
                _, left, rate = reserve(o, region, front, back, τ, T, y)
                beyond, left_then, rate_then = reserve(o, region, front, back, τ + h, T, out)
                if left_then < 0.0 or not dips(h, left, rate, left_then, rate_then):
                    break
                h, ends = 0.5 * h, False
            if left_then < 0.0:
                h, ends = length_to_border(o, region, front, back, τ, h, T, y, stages, out), False
            if region == FREE:
                apart += h
            τ = end if ends else τ + h
            for n in range(SIZE):
                y[n] = out[n]
            if left_then < 0.0:
                cross(o, region, y)
                region = beyond
    if len(path):
        record(o, region, cells[-1, 0], cells[-1, 1], stops[-1], T, y, path[-1])
    return apart


@njit(cache=True, error_model="numpy")
def record(
    o: Oscillator, region: int, front: int, back: int, τ: float, T: float, y: Floats, row: Floats
) -> None:  # fmt: skip
    """A line of the path of `advance`."""
    a = acceleration(o, region, front, back, τ, T, y[0], y[1])[0]
    row[0], row[1], row[2] = y[0], y[1], region
    row[3] = o.load - o.ground * y[1] - o.mass * a
    row[4] = offset_at(o.front, front, τ)[0]


@njit(cache=True, error_model="numpy")
def dips(h: float, left: float, rate: float, left_then: float, rate_then: float) -> bool:
    """Whether a cubic with these values and slopes at both ends of a step falls below 0 between them."""
    if not (rate < 0.0 < rate_then) or left <= 0.0:
        return False
    for i in range(1, 16):
        t = i / 16.0
        u = 1.0 - t
        start, end = (1.0 + 2.0 * t) * left + t * h * rate, (3.0 - 2.0 * t) * left_then - u * h * rate_then
        if u * u * start + t * t * end < 0.0:
            return True
    return False
