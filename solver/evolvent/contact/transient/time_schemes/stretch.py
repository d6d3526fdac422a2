"""The stretch s at which a step of the midpoint rule keeps the energy (midpoint_step.py).

With ε(s) the energy too much after a step with stretch s, there is such a one where ε(1) > 0: for s → 0 ε < 0, as the
inertia forces on Δz outweigh V's change, which is of second order in Δz. Where ε(1) < 0, Δz grows with s as far as
contacts let it. They may hold a body from both sides within one step, if it is longer than a blow; then there may be no
such stretch. As Δz → 0 so does what is to be corrected, and faster: ε is of its second order.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import root_scalar

AIM = 1e-11
"""Accepted excess of the energy after a step, over the largest energy."""
OVERSHOOT = 1.25
"""Factor on the first guess of ln s, so that the root usually lies between it and 0."""
FARTHEST = 20.0
"""Largest |ln s| of the stretches that are tried."""
ROUNDING = 1e-14
"""Difference of ln s below which stretches are equal."""


def try_stretches(excess: Callable[[float], float], first: float, slope: float) -> None:
    """Evaluates ε, 0 where it is as small as wanted, at ln s until it is, or none is left.

    first: ε at s = 1. slope: of ε there over ln s, without what V changes, > 0.
    """
    near, x = 0.0, float(np.clip(-OVERSHOOT * first / slope, -1.0, 1.0))
    while excess(x) * first > 0.0:
        if abs(x) >= FARTHEST:
            return
        near, x = x, float(np.clip(2.0 * x, -FARTHEST, FARTHEST))
    root_scalar(excess, method="brentq", bracket=(near, x), xtol=ROUNDING)
