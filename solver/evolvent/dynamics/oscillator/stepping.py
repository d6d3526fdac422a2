"""Integration of the oscillator over a mesh period, in compiled code: steps that end wherever the force is not smooth.

That is at its phases, where a side of the teeth is touched or left, and where one interval of x follows another. The
last two are found by a root search over the length of the step, not by interpolation. Where damping sets in or ends,
because it acts in contact only, the derivatives of the state jump (di Bernardo et al., Piecewise-smooth Dynamical
Systems, 2008, chapter 2: saltation matrix).

SciPy's own integrators take a hundred times as long, as they call the force from Python; they are the check of this
one.
"""

from __future__ import annotations

import numpy as np

from evolvent.dynamics.oscillator.compiled import compiled
from evolvent.dynamics.oscillator.equation import (
    FREE,
    SIZE,
    STAGES,
    Oscillator,
    acceleration,
    depth_at,
    interval_at,
    offset_at,
    step,
)
from evolvent_meshes.arrays import Floats, Ints

STEP = 0.12
"""Length of a step, over the time in which the stiffest oscillation turns by 1 rad: its error is then near rounding."""
FAR = 1e300
"""Distance [mm] of a border that does not exist."""
ROOT_STEPS = 60
CLOSE = 1e-15
"""Accuracy of the length of a step that ends at a border, over the step."""
TURN = 1e-9
"""Accuracy of the length of a step that ends where the distance to a border is least, over the step: the distance is
then right to its square."""
TRIES = 8
"""Most tries to find a step in which no border is crossed before its end: each of both borders may be touched on the
way."""
NOWHERE = -1
"""Border number that stands for no border."""


@compiled
def reserves(
    o: Oscillator, region: int, front: int, back: int, τ: float, T: float, y: Floats, left: Floats
) -> None:
    """Distances [mm] to both borders of the region, and their changes by τ, into left (2, 2): first to the border
    towards free flight, or in free flight to the loaded flanks, then to the other one."""
    if region == FREE:
        x, rate = depth_at(o.front, front, τ, T, y[0], y[1])
        left[0, 0], left[0, 1] = -x, -rate
        x, rate = depth_at(o.back, back, τ, T, y[0], y[1])
        left[1, 0], left[1, 1] = -x, -rate
        return
    if region > FREE:
        side, cell = o.front, front
    else:
        side, cell = o.back, back
    x, rate = depth_at(side, cell, τ, T, y[0], y[1])
    b = abs(region) - 1
    left[0, 0], left[0, 1] = x - side.depths[b], rate
    left[1, 0], left[1, 1] = FAR, 0.0
    if b < len(side.depths) - 1:
        left[1, 0], left[1, 1] = side.depths[b + 1] - x, -rate


@compiled
def beyond(region: int, border: int) -> int:
    """The region behind a border, 0 or 1 as in `reserves`."""
    if region == FREE:
        return 1 if border == 0 else -1
    outwards = -1 if border == 0 else 1
    return region + outwards if region > FREE else region - outwards


@compiled
def region_at(o: Oscillator, front: int, back: int, τ: float, T: float, y: Floats) -> int:
    """Region of the force in which a state y lies, as by `FREE`."""
    x = depth_at(o.front, front, τ, T, y[0], y[1])[0]
    if x > 0.0:
        return 1 + interval_at(o.front, x)
    x = depth_at(o.back, back, τ, T, y[0], y[1])[0]
    return -1 - interval_at(o.back, x) if x > 0.0 else FREE


@compiled
def length_to_border(
    o: Oscillator, region: int, border: int, front: int, back: int, τ: float, h: float, T: float, y: Floats,
    stages: Floats, out: Floats, left: Floats,
) -> float:
    """Length of the step from y whose end, in out, lies on a border of the region; h is one that goes beyond it, with
    its end in out and the distances there in left."""
    low, high, length = 0.0, h, h
    for _ in range(ROOT_STEPS):
        if left[border, 0] > 0.0:
            low = length
        else:
            high = length
        newton = length - left[border, 0] / left[border, 1] if left[border, 1] < 0.0 else low
        length = newton if low < newton < high else 0.5 * (low + high)
        step(o, region, front, back, τ, length, T, y, stages, out)
        reserves(o, region, front, back, τ + length, T, out, left)
        if abs(left[border, 0]) <= -left[border, 1] * CLOSE * h or high - low <= CLOSE * h:
            break
    return length


@compiled
def may_dip(h: float, begin: Floats, end: Floats) -> bool:
    """Whether a distance above 0 at both ends of a step, with these values and slopes (2,), may fall below 0 between
    them: a convex one stays above both tangents, so above the point where they meet."""
    if not (begin[1] < 0.0 < end[1]):
        return False
    return begin[0] + begin[1] * (begin[0] - end[0] + end[1] * h) / (end[1] - begin[1]) < 0.0


@compiled
def length_to_turn(
    o: Oscillator, region: int, border: int, front: int, back: int, τ: float, h: float, T: float, y: Floats,
    stages: Floats, begin: Floats, out: Floats, left: Floats,
) -> float:
    """Length of the step from y at whose end the distance to a border, in left, is least, a last bit late, or already
    below 0; h is one after it. By regula falsi on its slope, in the Illinois form."""
    low, high, slope_low, slope_high, ahead = 0.0, h, begin[border, 1], left[border, 1], 0
    for _ in range(ROOT_STEPS):
        length = (low * slope_high - high * slope_low) / (slope_high - slope_low)
        if high - low <= TURN * h or not low < length < high:
            break
        step(o, region, front, back, τ, length, T, y, stages, out)
        reserves(o, region, front, back, τ + length, T, out, left)
        if left[border, 0] < 0.0:
            return length
        if left[border, 1] < 0.0:
            low, slope_low = length, left[border, 1]
            slope_high *= 0.5 if ahead > 0 else 1.0
            ahead = 1
        else:
            high, slope_high = length, left[border, 1]
            slope_low *= 0.5 if ahead < 0 else 1.0
            ahead = -1
    step(o, region, front, back, τ, high, T, y, stages, out)
    reserves(o, region, front, back, τ + high, T, out, left)
    return high


@compiled
def step_in_region(
    o: Oscillator, region: int, front: int, back: int, τ: float, h: float, T: float, y: Floats, stages: Floats,
    begin: Floats, out: Floats, left: Floats,
) -> tuple[float, int]:
    """One step of length h from y at the most, into out, that ends where the region does. Its length, and the border
    that it ends at, or NOWHERE. begin, left: room for the distances at its ends."""
    reserves(o, region, front, back, τ, T, y, begin)
    step(o, region, front, back, τ, h, T, y, stages, out)
    reserves(o, region, front, back, τ + h, T, out, left)
    border = NOWHERE
    for _ in range(TRIES):
        nearer = 0 if left[0, 0] < left[1, 0] else 1
        if border == NOWHERE and left[nearer, 0] < 0.0:
            border = nearer
            h = length_to_border(o, region, border, front, back, τ, h, T, y, stages, out, left)
        touched = NOWHERE
        for other in range(2):
            if other != border and may_dip(h, begin[other], left[other]):
                touched = other
        if touched == NOWHERE:
            break
        h, border = length_to_turn(o, region, touched, front, back, τ, h, T, y, stages, begin, out, left), NOWHERE
    return h, border


@compiled
def cross(o: Oscillator, leaving: bool, y: Floats) -> None:
    """The jump of the derivatives in y (8,) where flanks part, or touch: only the damping force c ẋ jumps there, and of
    a start that comes later by dt the velocity has another c ẋ dt/m, with ẋ dt = ds."""
    if o.always:
        return
    for n in range(2, 5):
        y[n + 3] += o.damping / o.mass * (y[n] if leaving else -y[n])


@compiled
def mesh_force(o: Oscillator, region: int, front: int, back: int, τ: float, T: float, y: Floats) -> float:
    """Mesh force with the damping force [N] in a region."""
    return o.load - o.ground * y[1] - o.mass * acceleration(o, region, front, back, τ, T, y[0], y[1])[0]


@compiled
def record(
    o: Oscillator, region: int, front: int, back: int, τ: float, T: float, y: Floats, row: Floats
) -> None:
    """Writes a state into a row (5,) of the path of `advance`."""
    row[0], row[1], row[2] = y[0], y[1], np.sign(region)
    row[3] = mesh_force(o, region, front, back, τ, T, y)
    row[4] = offset_at(o.front, front, τ)[0]


@compiled
def advance(
    o: Oscillator, stops: Floats, cells: Ints, T: float, longest: float, y: Floats, path: Floats
) -> tuple[float, float, float, float]:
    """Integrates the state y (8,) from the first to the last of the phases stops (k + 1,), in place.

    cells: (k, 2) phase intervals of both sides.
    longest: step [mesh periods].
    path: (k + 1, 5) takes s, v, the side that touches, the mesh force and e of the loaded flanks at all stops; of
    length 0 where they are not wanted.

    Returns the phases [mesh periods] spent out of contact and on the back flanks, and the smallest and the largest
    mesh force [N] just before and just after contact begins or ends, where the damping force jumps; ∞ and −∞ where it
    does neither.
    """
    stages, out = np.empty((STAGES, SIZE)), np.empty(SIZE)
    begin, left = np.empty((2, 2)), np.empty((2, 2))
    region, separated, back_contact = region_at(o, cells[0, 0], cells[0, 1], stops[0], T, y), 0.0, 0.0
    smallest, largest = np.inf, -np.inf
    for k in range(len(cells)):
        front, back = cells[k, 0], cells[k, 1]
        if len(path):
            record(o, region, front, back, stops[k], T, y, path[k])
        τ, end = stops[k], stops[k + 1]
        while end - τ > 0.0:
            count = np.ceil((end - τ) / longest)
            whole = (end - τ) / count
            h, border = step_in_region(o, region, front, back, τ, whole, T, y, stages, begin, out, left)
            if region == FREE:
                separated += h
            elif region < FREE:
                back_contact += h
            τ = end if count == 1.0 and border == NOWHERE and h == whole else τ + h
            for n in range(SIZE):
                y[n] = out[n]
            if border != NOWHERE:
                following = beyond(region, border)
                if region == FREE or following == FREE:
                    cross(o, following == FREE, y)
                    before = mesh_force(o, region, front, back, τ, T, y)
                    after = mesh_force(o, following, front, back, τ, T, y)
                    smallest, largest = min(smallest, before, after), max(largest, before, after)
                region = following
    if len(path):
        record(o, region, cells[-1, 0], cells[-1, 1], stops[-1], T, y, path[-1])
    return separated, back_contact, smallest, largest
