"""The error of a time step, and the length of the next one.

The acceleration that the scheme keeps is a_n = z̈(t_n + αh) to second order, so that a step from z_n, ż_n ends at

    z_{n+1} = z_n + h ż_n + h²/2 z̈_n + h³ (β + α/2) z⃛ ,

off by e = c h² (a_{n+1} − a_n), c = β + α/2 − 1/6 (Zienkiewicz and Xie, Earthquake Eng. Struct. Dyn. 20 (1991) 871-887,
for Newmark's method; Hulbert and Jang, Comput. Methods Appl. Mech. Eng. 126 (1995), for generalised-α). It is
measured in the kinetic energy of e/h, over the largest energy so far: √(eᵀM e)/h over √2E, a speed over a speed. Errors
of displacement then add up to at most the tolerance times the way at the largest speed, whatever way the bodies have
flown; steps of a sine with ωh = 0.1 have errors up to c/100. Modes too fast for the step count by what their amplitudes
change by in it, as a_{n+1} comes from that change.

It goes with h². A step with more than the tolerance is taken again with a shorter length, and the next one is longer
only where the error is less than a quarter of it, so that lengths stay for many steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.settings import TransientSettings
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme

SAFETY = 0.9
"""Factor on the step length at which the estimated error would equal the tolerance."""
GROWTH, SHRINKAGE = 1.5, 0.1
"""Limits of the ratio of a length to the one before."""
QUIET = 0.25
"""Error over the tolerance below which steps grow. After GROWTH the error is little more than half the tolerance."""
SLIVER = 1e-6
"""Fraction of a time step by which the last one may be longer than planned, so that rounding leaves no tiny step."""


@dataclass(frozen=True)
class StepLengths:
    """Rules for the lengths of time steps [s]."""

    longest: float
    """First and longest time step [s]."""
    shortest: float
    """Shortest time step, accepted with any error [s]."""
    tolerance: float
    """Largest accepted error of a step that is longer than the shortest."""

    @staticmethod
    def of(settings: TransientSettings) -> StepLengths:
        """Rules for step lengths from the settings of a transient. Without a tolerance all steps are equal."""
        longest = settings.time_step
        if settings.tolerance is None:
            return StepLengths(longest, longest, np.inf)
        return StepLengths(longest, settings.least_step, settings.tolerance)

    def left(self, time: float, end: float) -> float:
        """Remaining time until the end [s]; 0 where only a sliver remains."""
        return end - time if end - time > SLIVER * self.shortest else 0.0

    def planned(self, wanted: float) -> float:
        """Step length nearest to a wanted one, within the limits [s]."""
        return min(max(wanted, self.shortest), self.longest)

    def first(self, planned: float, left: float) -> float:
        """Step length to try first [s]: the planned one, or, near the end of the run, half or all of the remaining time
        `left`."""
        steps = np.ceil(left / planned - SLIVER)
        return float(left / max(steps, 1.0)) if steps <= 2.0 else planned

    def can_shrink(self, length: float) -> bool:
        """Whether a step of this length may be tried again with a shorter one."""
        return length > self.shortest

    def shorter(self, length: float, error: float | None) -> float:
        """Shorter length [s] after a step whose error is too large, or, with None, that could not be solved."""
        return max(length * (0.5 if error is None else self._ratio(error)), self.shortest)

    def after(self, length: float, error: float, planned: float | None) -> float:
        """Length of the next step [s] after an accepted one. planned: length without regard to the end of the run; None
        where the step had to be repeated, so that the next one does not grow."""
        if error > self.tolerance:
            return self.shortest
        if planned is None:
            return length
        grown = length * self._ratio(error) if error < QUIET * self.tolerance else length
        return min(max(grown, planned), self.longest)

    def _ratio(self, error: float) -> float:
        best = SAFETY * np.sqrt(self.tolerance / error) if error else GROWTH
        return SHRINKAGE if np.isnan(best) else float(np.clip(best, SHRINKAGE, GROWTH))


def step_error(scheme: TimeScheme, after: Sequence[BodyMotion], energy: float) -> float:
    """Error estimate √(eᵀM e)/h over √2E of a time step. after: the bodies at its end. energy: E, the largest so far.
    Prescribed motions are exact and do not count."""
    square = 0.0
    for now in after:
        step, mass = now.response.step, now.response.body.system.mass
        e = scheme.error_constant * step.length * (now.state.acceleration - step.state.acceleration)
        e[now.response.held] = 0.0
        square += float(e @ mass @ e)
    if not square:
        return 0.0
    return float(np.sqrt(square / (2.0 * energy))) if energy > 0.0 else np.inf
