"""A moving body's answer to contact forces at one instant: its modes and rigid motions stay where they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.transient.moving_body import MovingBody
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class HeldResponse:
    """See `BodyResponse`; m modes, r rigid motions, none of them free. What answers is the static rest."""

    body: MovingBody
    """The body."""
    modes: Floats
    """Amplitudes q (m,)."""
    factor: float
    """Of its loads."""
    resultant: Floats
    """(s,) of all loads on the rigid motions that are free in time [N, N·mm]."""

    @property
    def compliance(self) -> Floats:
        """See `BodyResponse.compliance`."""
        return self.body.rest

    @property
    def displacement(self) -> Floats:
        """See `BodyResponse.displacement`."""
        return self.body.load_response(self.factor, self.resultant) + self.body.functionals @ self.modes

    @property
    def resistance(self) -> Floats:
        """See `BodyResponse.resistance`."""
        return np.zeros((0, 0))

    @property
    def load(self) -> Floats:
        """See `BodyResponse.load`."""
        return np.zeros(0)

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """See `BodyResponse.field`."""
        return self.body.field(self.factor, self.resultant, forces, self.modes, motion)
