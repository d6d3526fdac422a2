"""Derivative of the pressures of a frictionless equilibrium by the gaps, which implicit wear steps need many times.

With R(f, δ; g) = f − Nᵀ w λ and λ = γ(N J − g) where it presses, a change ∂g of the gaps changes the state by
T y = −Nᵀ w γ ∂g, and the pressures by ∂λ = γ (N ∂J − ∂g). The tangent is factored once.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.newton.reduced_tangent import FreeMotions, ReducedTangent
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.coulomb import LawValues
from evolvent_meshes.arrays import Bools, Floats


class PressureSensitivity:
    """Changes of the pressure with the gap about an equilibrium `state` of a frictionless system (k = 1).

    leaving: (q,) bool, points that lose their pressure; by default none.
    released: (q,) changes of all pressures by that loss [MPa].
    Raises NotConverged where nothing touches.
    """

    def __init__(self, system: CondensedSystem, state: Equilibrium, leaving: Bools | None = None) -> None:
        operator, pressure = system.operator, state.traction[:, :1]
        gone = np.zeros(len(pressure), dtype=bool) if leaving is None else leaving & (pressure[:, 0] > 0.0)
        touching = (pressure[:, 0] > 0.0) & ~gone
        self._system = system
        self._slope = operator.stabiliser[:, 0] * touching
        law = LawValues(pressure, touching[:, None, None].astype(float))
        motions = FreeMotions(system.motion, system.resistance)
        tangent = Tangent.of(operator, law, system.compliance, motions)
        A = system.compliance.matrix
        assert A is not None, "sensitivity of pressures: wanted a compliance that is a matrix"
        self._compliance, self._inverse = A, ReducedTangent.of(tangent.M, A, motions, tangent.kept)
        lost = np.where(gone, pressure[:, 0], 0.0)
        self.released = self._slope * (operator.shape @ self._jump(operator.weights * lost)) - lost

    def __call__(self, opening: Floats) -> Floats:
        """Changes ∂λ (q,) or (q, c) [MPa] of the pressure for changes ∂g (q,) or (q, c) [mm] of the gap."""
        operator, slope = self._system.operator, self._slope.reshape(-1, *[1] * (opening.ndim - 1))
        jump = self._jump(operator.weights.reshape(slope.shape) * slope * opening)
        return np.asarray(slope * (operator.shape @ jump - opening))

    def _jump(self, less: Floats) -> Floats:
        """Change of the jump ∂J (n, ...) [mm] if the forces of the points decrease by `less` (q, ...) [N] at constant
        jump."""
        n, r = self._system.motion.shape
        nodal = self._system.operator.shape.T @ less
        y = self._inverse.solve(np.concatenate([-nodal, np.zeros((r, *nodal.shape[1:]))]))
        return np.asarray(self._system.motion @ y[n:] - self._compliance @ y[:n])
