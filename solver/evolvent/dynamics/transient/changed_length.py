"""Conversion of a state to time steps of another length, and the error of a step.

Between two steps the scheme keeps a state, the acceleration a_n in it, and that of the step before, a_{n−1}. Their
difference is in proportion to the length of the step, and a_n lags behind the motion by α (a_n − a_{n−1}). A step that
is s times as long as the one before begins with

    a'_n = a_n + (s − 1) α (a_n − a_{n−1}) ,    a'_{n−1} = a'_n − s (a_n − a_{n−1}) ,

as if all steps before had been as long. Position, velocity and the equation of motion stay as they are:
(1 − α) a'_n + α a'_{n−1} = (1 − α) a_n + α a_{n−1}. The energy of the scheme
(contact/transient/time_schemes/scheme_energy.py) needs
no more of the past than that equation. So its balance is exact of the next step, too, with the energy that the same
state has in steps of the new length.

The error of a step is that of contact/transient/adaptive_steps.py, over the energy of the vibration, the modes, the
residual static compliance of both gears and the contact together: under a load at rest, the speed at which they would
swing back without it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem, TimeScheme, TimeStep
from evolvent_meshes.arrays import Floats


def stretched(
    scheme: TimeScheme, state: KinematicState, before: Floats, stretch: float
) -> tuple[KinematicState, Floats]:
    """The state and the acceleration one step before it, for a step `stretch` times as long as the one before.

    before: a_{n−1} (m,).
    """
    if stretch == 1.0:
        return state, before
    change = state.acceleration - before
    lagging = state.acceleration + (stretch - 1.0) * scheme.alpha * change
    return replace(state, acceleration=lagging), lagging - stretch * change


def motion_energy(system: LinearSystem, state: KinematicState) -> float:
    """Kinetic and elastic energy of a state [N·mm; N in 2D]."""
    kinetic = 0.5 * float(state.velocity @ (system.mass @ state.velocity))
    return kinetic + 0.5 * float(state.position @ (system.stiffness * state.position))


def step_error(step: TimeStep, end: KinematicState, energy: float) -> float:
    """Error √(eᵀM e)/h over √2E of a step, e = c h² (a_{n+1} − a_n). energy: E > 0, the largest so far."""
    e = step.scheme.error_constant * step.length * (end.acceleration - step.state.acceleration)
    return float(np.sqrt(e @ (step.system.mass @ e) / (2.0 * energy)))
