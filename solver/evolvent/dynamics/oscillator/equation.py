"""The equation of the oscillator and a step of its integration, in compiled code.

    s' = T v,   v' = T a,   a = [F_0 − F(s, τ) − c(v − ė) − c_g v] / m          (τ: phase in mesh periods of T seconds)

With s and v their derivatives by s_0, v_0 and ln T are integrated. A step is taken within one *region*: an interval of
x of one side of the teeth, or free flight, with one phase interval of each side, so that all is smooth in it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853

from evolvent.dynamics.oscillator.compiled import compiled
from evolvent.dynamics.oscillator.mesh_law import MeshSide
from evolvent_meshes.arrays import Floats

A, B, C = np.ascontiguousarray(DOP853.A), np.ascontiguousarray(DOP853.B), np.ascontiguousarray(DOP853.C)
"""Runge-Kutta method of order 8, the tableau of SciPy's DOP853."""
STAGES = len(B)
SIZE = 8
"""Size of an integration state: s [mm], v [mm/s], and the derivatives of s and of v by s_0, v_0 and ln T."""
FREE = 0
"""Number of the region of free flight. In region b + 1 the loaded flanks touch with x in interval b, in −b − 1 the back
flanks. Beyond the last interval there is one more without end, in which F is linear."""


class Oscillator(NamedTuple):
    """Parameters of the equation of motion for compiled code."""

    mass: float
    """Equivalent mass m [t]."""
    damping: float
    """Damping c of the mesh [N·s/mm]."""
    always: bool
    """Whether the damping of the mesh acts in free flight, too, then with ė of the loaded flanks wherever flanks
    touch."""
    ground: float
    """Damping c_g of the shafts against the ground [N·s/mm]."""
    load: float
    """Static load F_0 along the line of action [N]."""
    front: MeshSide
    """Force of the loaded flanks."""
    back: MeshSide
    """Force of the back flanks."""


@compiled
def offset_at(side: MeshSide, cell: int, τ: float) -> tuple[float, float]:
    """Offset e(τ) [mm] of a side and de/dτ, in a phase interval."""
    t, c = τ - side.phases[cell], side.offset[cell]
    return c[0] + t * (c[1] + t * (c[2] + t * c[3])), c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])


@compiled
def interval_at(side: MeshSide, x: float) -> int:
    """Index of the interval in which a depth x > 0 lies."""
    return max(int(np.searchsorted(side.depths, x)) - 1, 0)


@compiled
def force_at(side: MeshSide, cell: int, b: int, τ: float, x: float) -> tuple[float, float]:
    """F(x, τ) [N] and ∂F/∂x [N/mm] in a phase interval and an interval b of x, continued beyond both."""
    last = len(side.depths) - 2
    t, own = τ - side.phases[cell], min(b, last)
    d, force, slope = (side.depths[-1] if b > last else x) - side.depths[own], 0.0, 0.0
    for j in range(3, -1, -1):
        c = side.force[cell, own, j]
        slope = slope * d + force
        force = force * d + (c[0] + t * (c[1] + t * (c[2] + t * c[3])))
    if b > last:
        force += slope * (x - side.depths[-1])
    return force, slope


@compiled
def depth_at(side: MeshSide, cell: int, τ: float, T: float, s: float, v: float) -> tuple[float, float]:
    """Depth x = ±s − e [mm] of a side, and dx/dτ."""
    e, slope = offset_at(side, cell, τ)
    return side.sign * s - e, side.sign * T * v - slope


@compiled
def acceleration(
    o: Oscillator, region: int, front: int, back: int, τ: float, T: float, s: float, v: float
) -> tuple[float, float, float, float]:
    """Acceleration a [mm/s²] and its derivatives by s, v and ln T. front, back: phase intervals of both sides."""
    force, by_s, by_v, by_T = o.load - o.ground * v, 0.0, -o.ground, 0.0
    if region < FREE:
        side, cell = o.back, back
    else:
        side, cell = o.front, front
    e, slope = offset_at(side, cell, τ)
    if region != FREE:
        pressed, stiffness = force_at(side, cell, abs(region) - 1, τ, side.sign * s - e)
        force -= side.sign * pressed
        by_s -= stiffness
    # always acting, with ė of the loaded flanks on both sides: with that of the others it would jump where they touch
    rate = offset_at(o.front, front, τ)[1] / T if o.always else side.sign * slope / T
    if region != FREE or o.always:
        force -= o.damping * (v - rate)
        by_v -= o.damping
        by_T -= o.damping * rate
    return force / o.mass, by_s / o.mass, by_v / o.mass, by_T / o.mass


@compiled
def step(
    o: Oscillator, region: int, front: int, back: int, τ: float, h: float, T: float, y: Floats, stages: Floats,
    out: Floats,
) -> None:
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
