"""Motion of one body of a transient at one time."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class BodyMotion:
    """Motion of a body with m modes, r rigid motions and k functionals at one time."""

    state: KinematicState
    """Position, velocity and acceleration of modes and rigid motions (m + r)."""
    lag: Floats
    """Difference (m + r,) between the acceleration of the state and z̈: α (a_{n+1} − a_n), in proportion to the
    step."""
    response: MovingResponse
    """Response of the body to contact forces, with its loads and prescribed motions."""
    forces: Floats
    """Contact forces on the functionals of the body (k,)."""

    def state_for(self, stretch: float) -> KinematicState:
        """The state, for a step that is `stretch` times as long as the one before: its acceleration has the lag of such
        a step. With that of another length the method would be of first order."""
        if stretch == 1.0:
            return self.state
        return replace(self.state, acceleration=self.state.acceleration + (stretch - 1.0) * self.lag)

    @property
    def contact_force(self) -> Floats:
        """Contact force on modes and rigid motions (m + r,)."""
        body = self.response.body
        return np.concatenate([body.functionals.T @ self.forces, body.condensed.motion_shapes.T @ self.forces])

    @property
    def driving(self) -> Floats:
        """Forces (h,) that drive the h prescribed rigid motions, reactions and loads: M z̈ less the contact force."""
        needed = self.response.body.system.mass @ (self.state.acceleration - self.lag) - self.contact_force
        return needed[self.response.held]
