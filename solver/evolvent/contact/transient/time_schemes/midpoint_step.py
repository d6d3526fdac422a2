"""The midpoint rule with a discrete gradient, which keeps the energy of M z̈ + D ż + K z = p exactly, p = −∇V + loads.

With z̄ = (z_n + z_{n+1})/2, v̄ = (v_n + v_{n+1})/2 and Δz = z_{n+1} − z_n,

    M (v_{n+1} − v_n)/h + D v̄ + K z̄ = p(z̄) + κ M d ,    Δz = h v̄ ,

the energy ½ vᵀM v + ½ zᵀK z changes in a step by p(z̄)·Δz + κ dᵀM Δz − h v̄ᵀD v̄, whatever p is. κ is such that this is
the work of the loads less the change of V (Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467, with d = Δz). Here d is Δz
without its part e along motions that change V not: momentum along them is kept as by the midpoint rule, exactly. κ is
of second order in h, so that the method is, too.

With the stretch s = 1/(1 − ½κh²), a step reads, at the midpoint,

    A z̄ = p(z̄) + b ,    A = 4/(sh²) M + 2/h D + K ,    b = 4/(sh²) M z_n + 2/h (M v_n + D z_n) − κ M e :

the inertia against which V acts is divided by s. A free flight goes s times as far; with s → 0 the bodies stay.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class MidpointStep:
    """Equations of a step of the midpoint rule; the unknown is the position at the midpoint."""

    system: LinearSystem
    """Mass, damping and stiffness."""
    state: KinematicState
    """State at the beginning of the step. The acceleration is not used."""
    length: float
    """Step length h [s]."""
    stretch: float
    """Stretch s > 0."""
    unstretched: Floats
    """Part e (m,) of Δz along motions that V does not depend on."""

    @cached_property
    def matrix(self) -> Floats:
        """Matrix A (m, m) of the step."""
        return self._inertia * self.system.mass + np.diag(self._rate * self.system.damping + self.system.stiffness)

    @cached_property
    def known(self) -> Floats:
        """Known forces b (m,) of the step."""
        n = self.state
        inertia = self._inertia * n.position + self._rate * n.velocity - self.correction * self.unstretched
        return self.system.mass @ inertia + self._rate * self.system.damping * n.position

    @property
    def correction(self) -> float:
        """Correction κ of the energy [1/s²]."""
        return 2.0 * (1.0 - 1.0 / self.stretch) / self.length**2

    def after(self, position: Floats) -> KinematicState:
        """State at the end of the step from the position z̄ (m,) at its midpoint."""
        return self.ended(2.0 * position - self.state.position)

    def ended(self, position: Floats) -> KinematicState:
        """State at the end of the step from the position z_{n+1} (m,); the acceleration is the mean one."""
        n = self.state
        velocity = self._rate * (position - n.position) - n.velocity
        return KinematicState(position, velocity, (velocity - n.velocity) / self.length)

    def damped(self, after: KinematicState) -> float:
        """Energy h v̄ᵀD v̄ that damping dissipates in the step."""
        mean = 0.5 * (self.state.velocity + after.velocity)
        return self.length * float(mean @ (self.system.damping * mean))

    @property
    def _inertia(self) -> float:
        """Factor 4/(sh²) of the mass."""
        return 4.0 / (self.stretch * self.length**2)

    @property
    def _rate(self) -> float:
        """Factor 2/h of the damping."""
        return 2.0 / self.length
