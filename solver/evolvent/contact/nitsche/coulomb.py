"""The contact law at quadrature points: positive part, projection onto the friction disc, and their derivatives.

All components are local (normal, first tangential[, second tangential]). The law projects trial tractions: the
pressure p = γ(J_n − g) and the tangential traction q = γ_t(J_t + s), with J the jump of the extended trace, g the gap
and s the slip of earlier steps.

Source: Chouly, Fabre, Hild, Mlika, Pousin, Renard 2017, An overview of recent results on Nitsche's method for contact
problems; the form with Coulomb friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class LawValues:
    """Values of a contact law at q points with k local components; zero where there is no contact.

    traction: (q, k) [MPa].
    derivative: (q, k, k), by the trial tractions.
    """

    traction: Floats
    derivative: Floats


def coulomb(trial: Floats, friction: Floats | float) -> LawValues:
    """Coulomb's law: λ = [p]_+ and τ = q, or its projection onto the disc |τ| <= μλ.

    trial: (p, q) as (n, k), k = 1 (no tangential part) or d [MPa].
    friction: μ ≥ 0, a number or (n,).
    """
    law = _pressure(trial)
    if trial.shape[1] > 1:
        _project(trial, np.broadcast_to(friction, len(trial)), law)
    return law


def starting_guess(trial: Floats, friction: Floats | float, heading: Floats) -> LawValues:
    """A law that is smooth in the tangential part, for the first iteration of Newton's method.

    trial, friction: as in `coulomb`. heading: (n, k−1) direction of slip where it is known (τ = μλ·heading), zero where
    it is not (sticking, τ = q).
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


def _pressure(trial: Floats) -> LawValues:
    """Contact pressure λ = [p]_+, without tangential traction."""
    n, d = trial.shape
    law = LawValues(np.zeros((n, d)), np.zeros((n, d, d)))
    law.traction[:, 0] = np.maximum(trial[:, 0], 0.0)
    law.derivative[:, 0, 0] = trial[:, 0] > 0.0
    return law


def _project(trial: Floats, μ: Floats, law: LawValues) -> None:
    """Adds the tangential traction and its derivatives to values that have the pressure."""
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
