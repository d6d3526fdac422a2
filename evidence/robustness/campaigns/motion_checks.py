"""Whether what a sweep calls a steady state is one: by another integrator, and by the energy of a period."""

from __future__ import annotations

import numpy as np

from evidence.verification.references.time_integration import integrate
from evolvent.dynamics.oscillator.mesh_law import MeshSide
from evolvent.dynamics.oscillator.steady_state import Scales
from evolvent.dynamics.oscillator.torsional_model import History, TorsionalModel, history, period_map
from evolvent_meshes.arrays import Bools, Floats, Ints

RELATIVE = 1e-10
"""Tolerance of SciPy's integrator."""
ANGLE = 0.2
"""Of the stiffest oscillation [rad], in which motions are looked at for parting, touching and knots of F(x, φ)."""
PARTS, ROUNDS = 30, 4
"""Into which the time around one of them is divided, and how often."""
SMALLEST = 1e-6
"""Of the work of the load back and forth: an error of energy is not taken over less."""


def return_errors(model: TorsionalModel, period: float, state: Floats, repeats: int = 1) -> tuple[float, float]:
    """|P(y) − y| of a state (2,) that repeats after some mesh periods [s], by SciPy's integrator, over the static
    deflection, or the state's own size where that is larger; and this over the norm of ∂P/∂y where that is above 1,
    by which every integrator's errors grow in that time."""
    scale, change, y = Scales.of(model).array, np.eye(2), state
    for _ in range(repeats):
        y, derivatives = period_map(model, period, y)
        change = derivatives[:, :2] @ change
    error = np.abs((integrate(model, period, state, repeats, RELATIVE) - state) / scale).max()
    error /= max(1.0, float(np.abs(state / scale).max()))
    return float(error), float(error / max(1.0, np.linalg.norm(change * scale / scale[:, None], 2)))


def energy_error(model: TorsionalModel, period: float, state: Floats, repeats: int = 1) -> float:
    """∮ [F v + c(v − ė)v + c_g v²] dt − F_0 Δs + Δ(½mv²) over the work of the dampers, ∮ [c(v − ė)² + c_g v²] dt: what
    they take out is what the excitation has put in. By Gauss' rule between the instants at which the force is not
    smooth, with F as the mesh law has it at the path."""
    balance = damped = loaded = 0.0
    for _ in range(repeats):
        works, state = _works(model, period, state)
        balance, damped, loaded = balance + works[0], damped + works[1], loaded + works[2]
    return abs(balance) / max(damped, SMALLEST * loaded)


def _works(model: TorsionalModel, period: float, state: Floats) -> tuple[tuple[float, float, float], Floats]:
    """What is missing in the balance of a mesh period, the dampers' work, and that of the load back and forth; and the
    state (2,) after it."""
    ends = _smooth_parts(model, period, state)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    phases = (0.5 * (ends[:-1] + ends[1:])[:, None] + 0.5 * np.diff(ends)[:, None] * nodes).ravel()
    rule = (0.5 * period * np.diff(ends)[:, None] * weights).ravel()
    path = history(model, period, state, phases)
    at = np.searchsorted(path.phases, phases - 1e-14)
    s, v = path.displacement[at], path.velocity[at]
    force, rate, touching = _mesh(model, period, phases, s)
    acting = model.damping * np.logical_or(touching, model.damping_in_separation)
    after = np.array([path.displacement[-1], path.velocity[-1]])
    taken = rule @ (force * v + acting * (v - rate) * v + model.ground_damping * v**2)
    change = 0.5 * model.mass * (after[1] ** 2 - state[1] ** 2) - model.load * (after[0] - state[0])
    damped = rule @ (acting * (v - rate) ** 2 + model.ground_damping * v**2)
    return (float(taken + change), float(damped), float(rule @ np.abs(model.load * v))), after


def _smooth_parts(model: TorsionalModel, period: float, state: Floats) -> Floats:
    """Phases (k,) from 0 to 1 between which the force on the path is smooth."""
    count = int(np.ceil(model.fastest * period / ANGLE))
    path = history(model, period, state, np.linspace(0.0, 1.0, max(count, 200)))
    ends, brackets = path.phases, _changes(model, path)
    for _ in range(ROUNDS):
        finer = [np.linspace(low, high, PARTS + 1) for low, high in brackets]
        path = history(model, period, state, np.unique(np.concatenate([np.array([0.0, 1.0]), *finer])))
        found = _changes(model, path)
        brackets = [(low, high) for low, high in found if high - low < 1.5 * _width(brackets, low) / PARTS]
    return np.unique(np.concatenate([ends, np.array(brackets).ravel()]))


def _width(brackets: list[tuple[float, float]], phase: float) -> float:
    """Of the bracket with a phase in it; 0 in none."""
    return max((high - low for low, high in brackets if low <= phase <= high), default=0.0)


def _changes(model: TorsionalModel, path: History) -> list[tuple[float, float]]:
    """Phases of a path between which it comes into another interval of F(x, φ), or of contact."""
    where = _interval(model.law.front, path.phases, path.displacement)
    where = where - _interval(model.law.back, path.phases, path.displacement)
    return [(float(path.phases[i]), float(path.phases[i + 1])) for i in np.flatnonzero(np.diff(where))]


def _interval(side: MeshSide, phases: Floats, s: Floats) -> Ints:
    """Of x (n,): 0 where the side does not touch."""
    return np.asarray(np.searchsorted(side.depths, side.sign * s - _offset(side, phases)[0]))


def _offset(side: MeshSide, phases: Floats) -> tuple[Floats, Floats, Ints]:
    """e (n,) [mm], de/dτ (n,), and the phase intervals (n,)."""
    cells = np.clip(np.searchsorted(side.phases, phases) - 1, 0, len(side.offset) - 1)
    t, c = (phases - side.phases[cells])[:, None], side.offset[cells]
    return (c * t ** np.arange(4)).sum(axis=1), (c[:, 1:] * np.arange(1, 4) * t ** np.arange(3)).sum(axis=1), cells


def _mesh(model: TorsionalModel, period: float, phases: Floats, s: Floats) -> tuple[Floats, Floats, Bools]:
    """Of both sides (n,): force against s [N], rate ė that the damper sees [mm/s], and whether a side touches."""
    force, touching = np.zeros(len(s)), np.zeros(len(s), dtype=bool)
    rate = _offset(model.law.front, phases)[1] / period
    for side in (model.law.front, model.law.back):
        e, slope, cells = _offset(side, phases)
        x = side.sign * s - e
        inside = x > 0.0
        b = np.clip(np.searchsorted(side.depths, x) - 1, 0, len(side.depths) - 2)
        t = (phases - side.phases[cells])[:, None, None]
        c = (side.force[cells, b] * t ** np.arange(4)).sum(axis=2)
        d = np.minimum(x, side.depths[-1]) - side.depths[b]
        pressed = (c * d[:, None] ** np.arange(4)).sum(axis=1)
        stiffness = (c[:, 1:] * np.arange(1, 4) * d[:, None] ** np.arange(3)).sum(axis=1)
        pressed += stiffness * np.maximum(x - side.depths[-1], 0.0)
        force[inside] += side.sign * pressed[inside]
        touching |= inside
        if not model.damping_in_separation:
            rate[inside] = side.sign * slope[inside] / period
    return force, rate, touching
