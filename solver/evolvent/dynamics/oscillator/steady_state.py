"""Steady states: motions that repeat with the mesh, stable or not.

A steady state is a root of P(y) − y, with P(y) the state a mesh period after y. It is found by Newton's method with the
exact derivatives of P. The eigenvalues of ∂P/∂y, Floquet's multipliers, say whether it is stable.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.dynamics.oscillator.torsional_model import Derivatives, TorsionalModel, period_map
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError

TOLERANCE = 1e-11
"""Largest residual of a steady state, over the static deflection."""
ITERATIONS = 30
GROUND_HALVINGS = 14
"""Halvings of the additional ground damping from critical damping on, before it is removed."""


class NoSteadyState(ResultError):
    """No motion that repeats with the mesh was found."""


@dataclass(frozen=True, eq=False)
class SteadyState:
    """A motion that repeats with the mesh."""

    period: float
    """Mesh period T [s]."""
    state: Floats
    """State (2,) at phase 0: s [mm] and ṡ [mm/s]."""
    derivatives: Derivatives
    """(2, 3) derivatives of the state after a mesh period, by s and ṡ before it and by ln T."""

    @property
    def multipliers(self) -> Floats:
        """Floquet's multipliers (2,), complex."""
        return np.linalg.eigvals(self.derivatives[:, :2])

    @property
    def stable(self) -> bool:
        """Whether the steady state is stable: small disturbances die out."""
        return bool(np.abs(self.multipliers).max() < 1.0)


@dataclass(frozen=True)
class Scales:
    """Units in which s, ṡ and ln T are alike in size."""

    length: float
    """Scale of s [mm]."""
    velocity: float
    """Scale of ṡ [mm/s]."""

    @staticmethod
    def of(model: TorsionalModel) -> Scales:
        """Scales from the static deflection on the stiffest mesh."""
        length = abs(model.load) / model.law.stiffest or 1e-3
        return Scales(length, length * model.fastest)

    @property
    def array(self) -> Floats:
        """(2,) scales of s [mm] and ṡ [mm/s]."""
        return np.array([self.length, self.velocity])


def residual(model: TorsionalModel, scales: Scales, period: float, state: Floats) -> tuple[Floats, Derivatives]:
    """Residual (P(y) − y)/scales (2,) of a steady state, and its derivatives (2, 3) by y/scales and ln T."""
    after, derivatives = period_map(model, period, state)
    size = scales.array
    wide = np.append(size, 1.0)
    change = derivatives * wide / size[:, None]
    change[:, :2] -= np.eye(2)
    return (after - state) / size, change


def steady_state(model: TorsionalModel, period: float, start: Floats) -> SteadyState:
    """The steady state near a state (2,), by Newton's method with halved steps where the residual grows.

    Raises NoSteadyState.
    """
    scales, state = Scales.of(model), np.asarray(start, dtype=float)
    found, change = residual(model, scales, period, state)
    for _ in range(ITERATIONS):
        size = float(np.abs(found).max())
        if size <= TOLERANCE * max(1.0, float(np.abs(state / scales.array).max())):
            return SteadyState(period, state, unscaled(change, scales))
        if not np.isfinite(change).all():
            break
        move = np.linalg.lstsq(change[:, :2], -found, rcond=None)[0] * scales.array
        for _ in range(12):
            trial = state + move
            then, change_then = residual(model, scales, period, trial)
            if np.abs(then).max() < size:
                break
            move = 0.5 * move
        else:
            break
        state, found, change = trial, then, change_then
    raise NoSteadyState(
        f"steady state at {model.place(period)}: wanted a residual of {TOLERANCE}, found "
        f"{np.abs(found).max():.2e}; start nearer, or follow a branch of steady states from another speed"
    )


def damped_less(model: TorsionalModel, period: float, start: Floats) -> SteadyState:
    """Steady state for which no start is nearby: continued from that with strong damping against the ground, which is
    halved step by step and then removed. start: (2,), for the first of these.

    Raises NoSteadyState.
    """
    damping = 2.0 * model.mass * model.fastest
    for part in (*(0.5 ** np.arange(GROUND_HALVINGS)), 0.0):
        helped = replace(model, ground_damping=model.ground_damping + part * damping)
        start = steady_state(helped, period, start).state
    return steady_state(model, period, start)


def unscaled(change: Derivatives, scales: Scales) -> Derivatives:
    """∂P/∂(y, ln T) (2, 3) from the derivatives of the scaled residual."""
    size = scales.array
    scaled = change.copy()
    scaled[:, :2] += np.eye(2)
    return scaled * size[:, None] / np.append(size, 1.0)
