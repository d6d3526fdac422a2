"""Response of a moving body to contact forces at one instant, with fixed modes and rigid motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.transient.moving_body import MovingBody
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class HeldResponse:
    """Response to contact forces of a body with m fixed modes and r fixed rigid motions: static, without the modes."""

    body: MovingBody
    """Moving body."""
    modes: Floats
    """Amplitudes q of the modes (m,)."""
    factor: float
    """Factor on the loads of the body."""
    resultant: Floats
    """Resultant (s,) of all loads on the rigid motions that are free in time [N, N·mm]."""

    @property
    def compliance(self) -> Floats:
        """Compliance (k, k) of the functionals without the modes [mm/N]."""
        return self.body.rest

    @property
    def displacement(self) -> Floats:
        """Values (k,) of the functionals without contact forces and rigid motions [mm]."""
        return self.body.load_response(self.factor, self.resultant) + self.body.functionals @ self.modes

    @property
    def resistance(self) -> Floats:
        """Empty matrix (0, 0), as no rigid motion is free."""
        return np.zeros((0, 0))

    @property
    def load(self) -> Floats:
        """Empty vector (0,), as no rigid motion is free."""
        return np.zeros(0)

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under forces on the functionals (k,) [N] at amplitudes of all rigid
        motions (r,)."""
        return self.body.field(self.factor, self.resultant, forces, self.modes, motion)
