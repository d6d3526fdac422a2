"""The natural frequency of a pair on its mesh, with the natural modes of both bodies.

In a static position under the mesh force F let s be the forces on the modes by a unit of F, k the tangent stiffness of
the mesh, and k_r that of what answers at once, 1/k_r = 1/k − Σ s²/ω². With F = k_r (ℓψ − s·q), ℓ the lever of ψ, small
motions of modes and ψ have the mass matrix of the pair and

    K = [ Ω² + k_r s sᵀ   −k_r ℓ s ]
        [   −k_r ℓ sᵀ       k_r ℓ² ] .

Without modes this is ω² = k/m. s are the forces by the whole contact force, not by a small change of it: the same where
contact only grows, another one where a tooth pair just begins to bear. Positions at which the modes would give way more
than the mesh, k Σ s²/ω² >= 1, are left out.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import eigh

from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError


def own_frequency(pair: MovingPair, static: Sequence[PositionResult]) -> float:
    """Natural frequency [Hz] of the mode that carries most of the transmission error under a change of the mesh force:
    the root of the mean square of all positions of a pitch. Raises ResultError where modes give way more than the mesh
    at all of them."""
    known = [square for square in (_square(pair, position) for position in static) if square is not None]
    if not known:
        raise ResultError(
            "natural frequency of the pair: wanted modes that give way less than the whole mesh at some position, "
            "found none; lower transient.modes_per_harmonic"
        )
    return float(np.sqrt(np.mean(known))) / (2.0 * np.pi)


def _square(pair: MovingPair, position: PositionResult) -> float | None:
    """ω² at a position, None where modes give way more than the mesh."""
    s, Ω2 = _modal_forces(pair, position), pair.frequencies**2
    left = 1.0 / position.stiffness - float(np.sum(s**2 / Ω2))
    if left <= 0.0:
        return None
    rest = 1.0 / left
    jump = np.append(-s, pair.lever)
    stiffness = np.diag(np.append(Ω2, 0.0)) + rest * np.outer(jump, jump)
    squares, shapes = eigh(stiffness, pair.system.mass)
    return float(squares[np.argmax((jump @ shapes) * shapes[-1] / squares)])


def _modal_forces(pair: MovingPair, position: PositionResult) -> Floats:
    """Forces s (m,) on the modes of both gears by a unit mesh force."""
    torque = sum(share * taken for share, taken in zip(pair.drive.shares, position.torques))
    return pair.modal_forces(position) * (pair.lever / torque)
