"""The force of a gear mesh over displacement and phase, as piecewise polynomials.

s is the displacement of the pinion ahead of the wheel along the line of action, r_b1 θ_1 − r_b2 θ_2, and τ the phase in
mesh periods. Each side of the teeth touches where x = ±s − e(τ) is above 0, and presses with F(x, τ): the loaded flanks
with the upper sign, e their unloaded transmission error, the back flanks with the lower one, e their error and the
backlash.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PPoly
from scipy.special import comb

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import ResultError

NEVER = 1e6
"""Offset [mm] of a side that is never touched."""
ROUNDING = 1e-12
"""Rounding error of offsets [mm]: a smaller overlap of both flanks is ignored."""
LOOKED_AT = 9
"""Phases per interval at which both sides are tested for overlap."""
LAST_BIT = 1e-14
"""Difference below which two phases are the same."""


class Jammed(ResultError):
    """Error for flanks that touch on both sides of a tooth at once, by `overlap` [mm] at the most."""

    def __init__(self, overlap: float) -> None:
        super().__init__(
            "backlash: wanted room for the teeth, found flanks that overlap on both sides, unloaded errors included, "
            f"by {1e3 * overlap:.3g} µm; give so much more backlash (dynamics.backlash_um)"
        )
        self.overlap = overlap


class MeshSide(NamedTuple):
    """One side of the teeth, as arrays that compiled code takes."""

    sign: float
    """1 where it touches at large s, −1 where at small s."""
    phases: Floats
    """(n + 1,) ends of the phase intervals, from 0 to 1 [mesh periods]."""
    offset: Floats
    """(n, 4) coefficients of e(τ) [mm], by powers of the phase from the interval's start."""
    depths: Floats
    """(m + 1,) ends of the intervals of x, from 0 [mm]; beyond the last one F is linear."""
    force: Floats
    """(n, m, 4, 4) coefficients of F(x, τ) [N], by powers of x and of τ from the starts of the intervals."""


@dataclass(frozen=True, eq=False)
class MeshLaw:
    """Mesh force of both sides of the teeth."""

    front: MeshSide
    """Force of the loaded flanks."""
    back: MeshSide
    """Force of the back flanks."""

    def __post_init__(self) -> None:
        """Raises Jammed: the oscillator has at most one side in contact."""
        (stops, cells), sides = self.stops(), (self.front, self.back)
        phases = stops[:-1] + np.linspace(0.0, 1.0, LOOKED_AT)[:, None] * np.diff(stops)
        overlap = -float(sum((_offsets(side, cells[:, i], phases) for i, side in enumerate(sides)), 0.0 * phases).min())
        if overlap > ROUNDING:
            raise Jammed(overlap)

    def stops(self, more: Floats | tuple[float, ...] = ()) -> tuple[Floats, Ints]:
        """Phases (k + 1,) from 0 to 1 between which both sides are polynomials of τ, and the intervals (k, 2) of front
        and back there. more: further phases to stop at."""
        stops = _different(np.concatenate([self.front.phases, self.back.phases, np.asarray(more, dtype=float)]))
        middle = 0.5 * (stops[1:] + stops[:-1])
        sides = (self.front, self.back)
        cells = [np.searchsorted(side.phases, middle, side="right") - 1 for side in sides]
        return stops, np.column_stack(cells).astype(np.int64)

    @cached_property
    def stiffest(self) -> float:
        """The largest ∂F/∂x [N/mm] at the ends and middles of all intervals, from which steps in time are chosen."""
        return max(float(_slopes(side).max()) for side in (self.front, self.back))


def force_side(depths: Floats, force: Floats, error: Floats, last_slope: Floats | None = None) -> MeshSide:
    """The loaded side through values at k equidistant phases 0, 1/k, ...: cubic splines of x and, periodic, of τ.

    depths: (m + 1,) from 0 [mm].
    force: (k, m + 1) F there [N], 0 in the first column.
    error: (k,) e(τ) [mm].
    last_slope: (k,) ∂F/∂x at the last depth [N/mm], with which F goes on; None: as a natural spline has it.
    """
    phases = np.linspace(0.0, 1.0, len(error) + 1)
    depths, end = np.array(depths, dtype=float), "natural" if last_slope is None else (1, last_slope)
    along = CubicSpline(depths, force, axis=1, bc_type=("not-a-knot", end)).c  # (4, m, k), the highest power first
    periodic = np.concatenate([along, along[:, :, :1]], axis=2)
    both = CubicSpline(phases, periodic, axis=2, bc_type="periodic").c  # (4 of τ, k, 4 of x, m)
    coefficients = np.ascontiguousarray(both[::-1, :, ::-1].transpose(1, 3, 2, 0))
    return MeshSide(1.0, phases, _periodic(phases, error), depths, coefficients)


def linear_side(stiffness: Floats, error: Floats, sign: float = 1.0) -> MeshSide:
    """F = k(τ) x through values of k (n,) [N/mm] and of e (n,) [mm] at equidistant phases."""
    phases = np.linspace(0.0, 1.0, len(error) + 1)
    return _linear(phases, _periodic(phases, stiffness), _periodic(phases, error), sign)


def stepped_side(phases: Floats, stiffness: Floats) -> MeshSide:
    """F = k x with a constant k (n,) [N/mm] between phases (n + 1,), from 0 to 1; e is 0."""
    constant = np.zeros((len(stiffness), 4))
    constant[:, 0] = stiffness
    return _linear(np.asarray(phases, dtype=float), constant, np.zeros_like(constant), 1.0)


def no_side() -> MeshSide:
    """Back flanks that are never touched: unlimited backlash."""
    offset = np.array([[NEVER, 0.0, 0.0, 0.0]])
    return _linear(np.array([0.0, 1.0]), np.zeros((1, 4)), offset, -1.0)


def behind(side: MeshSide, backlash: float) -> MeshSide:
    """The back flanks with the force of `side` at the same phase, as by He et al. (Machines 2022, 10, 69, Eq. 6): they
    touch where s − e falls below −backlash [mm]."""
    offset = -side.offset
    offset[:, 0] += backlash
    return side._replace(sign=-side.sign, offset=offset)


def with_chords(side: MeshSide) -> MeshSide:
    """The side with e(τ) straight between the ends of its phase intervals, where a spline may ring."""
    starts = side.offset[:, 0]
    offset = np.zeros_like(side.offset)
    offset[:, 0], offset[:, 1] = starts, (np.roll(starts, -1) - starts) / np.diff(side.phases)
    return side._replace(offset=offset)


def mirrored(side: MeshSide, meeting: float, backlash: float) -> MeshSide:
    """The back flanks as mirror images of `side`: at phase τ they stand as those do at `meeting` − τ.

    meeting: phase at which the back flanks of a tooth pair meet where those of `side` do at phase 0.
    backlash: [mm] along the line of action, from flank to flank of unmodified teeth.
    """
    phases = _different(np.concatenate([[0.0, 1.0], (meeting - side.phases) % 1.0]))
    phases[-1] = 1.0
    middle, start = 0.5 * (phases[1:] + phases[:-1]), phases[:-1]
    cell = np.searchsorted(side.phases, (meeting - middle) % 1.0) - 1
    image = (meeting - middle) % 1.0 + (middle - start) - side.phases[cell]  # of the start, in the mirrored interval
    taylor = _taylor(image) * (-1.0) ** np.arange(4)[:, None]  # (n, new power, old power)
    offset = np.einsum("nkj,nj->nk", taylor, side.offset[cell])
    force = np.einsum("nkj,nmij->nmik", taylor, side.force[cell])
    offset[:, 0] += backlash
    return MeshSide(-side.sign, phases, offset, side.depths, np.ascontiguousarray(force))


def backwards(law: MeshLaw) -> MeshLaw:
    """The mesh force of gears that pass their positions in the opposite order: at phase τ they stand as those of `law`
    do at −τ."""
    front, back = (mirrored(side, 0.0, 0.0)._replace(sign=side.sign) for side in (law.front, law.back))
    return MeshLaw(front, back)


def _offsets(side: MeshSide, cells: Ints, phases: Floats) -> Floats:
    """Offsets e (..., n) [mm] of a side at phases (..., n) in phase intervals (n,)."""
    return np.asarray((side.offset[cells] * (phases - side.phases[cells])[..., None] ** np.arange(4)).sum(axis=-1))


def _different(phases: Floats) -> Floats:
    """Ascending phases, without those that differ by `LAST_BIT` or less from the one before."""
    every = np.unique(phases)
    return np.asarray(every[np.concatenate([[True], np.diff(every) > LAST_BIT])])


def _taylor(at: Floats) -> Floats:
    """(n, 4, 4): coefficients of powers of t − a from those of powers of t, at a (n,)."""
    old, new = np.arange(4)[None, :], np.arange(4)[:, None]
    return np.where(old >= new, comb(old, new) * at[:, None, None] ** np.maximum(old - new, 0), 0.0)


def _linear(phases: Floats, stiffness: Floats, offset: Floats, sign: float) -> MeshSide:
    force = np.zeros((len(phases) - 1, 1, 4, 4))
    force[:, 0, 1, :] = stiffness
    return MeshSide(sign, phases, offset, np.array([0.0, 1.0]), force)


def _periodic(phases: Floats, values: Floats) -> Floats:
    """Coefficients (n, 4) of the periodic cubic spline through values (n,), by powers from each interval's start."""
    spline: PPoly = CubicSpline(phases, np.append(values, values[0]), bc_type="periodic")
    return np.ascontiguousarray(spline.c[::-1].T)


def _slopes(side: MeshSide) -> Floats:
    """∂F/∂x [N/mm] at the ends and middles of all intervals of x and of τ."""
    width, length = np.diff(side.depths), np.diff(side.phases)
    powers = np.arange(4)
    found = []
    for x in (0.0 * width, 0.5 * width, width):
        slope = powers * np.where(powers > 0, x[:, None] ** np.maximum(powers - 1, 0), 0.0)  # (m, 4)
        for t in (0.0 * length, 0.5 * length, length):
            found.append(np.einsum("nmjk,mj,nk->nm", side.force, slope, t[:, None] ** powers))
    return np.array(found)
