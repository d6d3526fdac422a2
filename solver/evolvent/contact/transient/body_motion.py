"""One body of a transient at one time."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.time_schemes.time_scheme import MotionState
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class BodyMotion:
    """A body with m modes, r rigid motions and k functionals."""

    state: MotionState
    """Of modes and rigid motions (m + r)."""
    lag: Floats
    """(m + r,) by which the acceleration of the state differs from z̈: α (a_{n+1} − a_n), in proportion to the step."""
    response: MovingResponse
    """What it answers to contact forces, with its loads and prescribed motions."""
    forces: Floats
    """Contact forces on its functionals (k,)."""

    def state_for(self, stretch: float) -> MotionState:
        """The state, for a step that is `stretch` times as long as the one before: its acceleration has the lag of such
        a step. With that of another length the method would be of first order."""
        if stretch == 1.0:
            return self.state
        return replace(self.state, acceleration=self.state.acceleration + (stretch - 1.0) * self.lag)

    @property
    def contact_force(self) -> Floats:
        """Of the contact on modes and rigid motions (m + r,)."""
        body = self.response.body
        return np.concatenate([body.functionals.T @ self.forces, body.condensed.motion_shapes.T @ self.forces])

    @property
    def driving(self) -> Floats:
        """(h,) what moves the h prescribed rigid motions: their reactions and loads, M z̈ less the contact force."""
        needed = self.response.body.system.mass @ (self.state.acceleration - self.lag) - self.contact_force
        return needed[self.response.held]
