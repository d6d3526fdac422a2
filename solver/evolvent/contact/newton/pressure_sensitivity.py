"""How the pressures of a frictionless state follow when gaps open a little: what wear asks of a position, many times.

With R(f, δ; g) = f − Nᵀ w λ and λ = γ(N J − g) where it presses, an opening ∂g moves the state by T y = −Nᵀ w γ ∂g, and
∂λ = γ (N ∂J − ∂g). The tangent is factored once.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.newton.equilibrium import CondensedSystem, Equilibrium
from evolvent.contact.newton.reduced_tangent import KeptColumns
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.coulomb import Law
from evolvent_meshes.arrays import Floats


class PressureResponse:
    """About a state of a frictionless system (k = 1). released: (q,) [MPa], how pressures follow that the points of
    `leaving` (q,) bool lose theirs. Raises NotConverged where nothing touches."""

    def __init__(self, system: CondensedSystem, state: Equilibrium, leaving: np.ndarray | None = None) -> None:
        operator, pressure = system.operator, state.traction[:, :1]
        gone = np.zeros(len(pressure), dtype=bool) if leaving is None else leaving & (pressure[:, 0] > 0.0)
        touching = (pressure[:, 0] > 0.0) & ~gone
        self._system = system
        self._slope = operator.stabiliser[:, 0] * touching
        law = Law(pressure, touching[:, None, None].astype(float))
        tangent = Tangent.of(operator, law, system.compliance, system.motion)
        self._inverse = KeptColumns.of(tangent.M, tangent.A, tangent.H, tangent.kept)
        lost = np.where(gone, pressure[:, 0], 0.0)
        self.released = self._slope * (operator.shape @ self._jump(operator.weights * lost)) - lost

    def __call__(self, opening: Floats) -> Floats:
        """∂λ (q,) or (q, c) [MPa] of ∂g (q,) or (q, c) [mm]."""
        operator, slope = self._system.operator, self._slope.reshape(-1, *[1] * (opening.ndim - 1))
        jump = self._jump(operator.weights.reshape(slope.shape) * slope * opening)
        return np.asarray(slope * (operator.shape @ jump - opening))

    def _jump(self, less: Floats) -> Floats:
        """∂J (n, ...) when the points push less (q, ...) [N] at the same jump."""
        n, r = self._system.motion.shape
        pushed = self._system.operator.shape.T @ less
        found = self._inverse.solve(np.concatenate([-pushed, np.zeros((r, *pushed.shape[1:]))]))
        return np.asarray(self._system.motion @ found[n:] - self._system.compliance @ found[:n])
