"""The contact law at one node: positive part, ball projection, and their derivatives.

Everything is in the node's frame (n, t1[, t2]) and vectorised over nodes. Trial values are what the law projects:
p = γ(J_n − G) for the pressure and q = γ_t(J_t + s) for the traction, with J the weighted jump of the extended trace.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class Law:
    """Tractions at n nodes: values (n, d) and derivatives by the trial values (n, d, d), zero where out of contact."""

    traction: Floats
    derivative: Floats


def coulomb(trial: Floats, friction: Floats | float) -> Law:
    """λ = [p]_+ and τ = P_B(μλ)(q) from trial values (n, d) = (p, q); friction μ ≥ 0, a number or (n,).

    With d = 1 there is no tangential part. Chouly, Fabre, Hild, Mlika, Pousin, Renard 2017, the frictional form.
    """
    law = _pressure(trial)
    if trial.shape[1] > 1:
        _project(trial, np.broadcast_to(friction, len(trial)), law)
    return law


def starting_guess(trial: Floats, friction: Floats | float, heading: Floats) -> Law:
    """A law without kinks in the tangential part, for the first iteration of Newton's method.

    heading (n, d−1): the direction of slip where it is known (τ = μλ·heading), zero where it is not (stuck, τ = q).
    """
    law = _pressure(trial)
    touching = trial[:, 0] > 0.0
    μ = np.broadcast_to(friction, len(trial))
    stuck = touching & ~heading.any(axis=1)
    law.traction[:, 1:] = (μ * law.traction[:, 0])[:, None] * heading
    law.derivative[:, 1:, 0] = (μ * touching)[:, None] * heading
    law.traction[stuck, 1:] = trial[stuck, 1:]
    law.derivative[stuck, 1:, 1:] = np.eye(trial.shape[1] - 1)
    return law


def _pressure(trial: Floats) -> Law:
    n, d = trial.shape
    law = Law(np.zeros((n, d)), np.zeros((n, d, d)))
    law.traction[:, 0] = np.maximum(trial[:, 0], 0.0)
    law.derivative[:, 0, 0] = trial[:, 0] > 0.0
    return law


def _project(trial: Floats, μ: Floats, law: Law) -> None:
    """Adds P_B(μλ)(q) and its derivatives to a law that has the pressure."""
    q, λ = trial[:, 1:], law.traction[:, 0]
    size = np.linalg.norm(q, axis=1)
    sticks = (λ > 0.0) & (size <= μ * λ)
    slides = (λ > 0.0) & ~sticks & (μ > 0.0)
    law.traction[sticks, 1:] = q[sticks]
    law.derivative[sticks, 1:, 1:] = np.eye(q.shape[1])
    heading = q[slides] / size[slides, None]
    bound = μ[slides] * λ[slides]
    law.traction[slides, 1:] = bound[:, None] * heading
    law.derivative[slides, 1:, 0] = μ[slides, None] * heading
    across = np.eye(q.shape[1]) - heading[:, :, None] * heading[:, None, :]
    law.derivative[slides, 1:, 1:] = (bound / size[slides])[:, None, None] * across
