"""How the pressures of a frictionless state follow when gaps open a little: what wear asks of a position, many times.

With R(f, δ; g) = f − Nᵀ w λ and λ = γ(N J − g) where it presses, an opening ∂g moves the state by T y = −Nᵀ w γ ∂g, and
∂λ = γ (N ∂J − ∂g). The tangent is factored once.
"""

from __future__ import annotations

import numpy as np

from meshes.data import Floats
from solver.equilibrium import CondensedSystem, Equilibrium
from solver.friction import Law
from solver.kept_columns import KeptColumns
from solver.tangent import Tangent


class PressureResponse:
    """About a state of a frictionless system (k = 1). Raises NotConverged where nothing touches."""

    def __init__(self, system: CondensedSystem, state: Equilibrium) -> None:
        operator, pressure = system.operator, state.traction[:, :1]
        touching = pressure > 0.0
        self._system = system
        self._slope = operator.stabiliser[:, 0] * touching[:, 0]
        law = Law(pressure, touching[:, :, None].astype(float))
        tangent = Tangent.of(operator, law, system.compliance, system.motion)
        self._inverse = KeptColumns.of(tangent.M, tangent.A, tangent.H, tangent.kept)

    def __call__(self, opening: Floats) -> Floats:
        """∂λ (q,) [MPa] of ∂g (q,) [mm]."""
        operator, n = self._system.operator, len(self._system.jump)
        pushed = operator.shape.T @ (operator.weights * self._slope * opening)
        found = self._inverse.solve(np.concatenate([-pushed, np.zeros(self._system.motion.shape[1])]))
        force, motion = found[:n], found[n:]
        jump = self._system.motion @ motion - self._system.compliance @ force
        return np.asarray(self._slope * (operator.shape @ jump - opening))
