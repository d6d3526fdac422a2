"""Into how many equal parts the way from one position of a pair to the next one is divided.

Each time step is 2⁻ᵏ of that way, and begins at a multiple of its own length: halves may become quarters anywhere, and
quarters halves where two of them have been gone. So every position of the table is the end of a step, and what lies
between repeats with the mesh as the positions do.

The error of a step (changed_length.py) goes with the square of its length. One with more than the tolerance is taken
again in half, and a step is doubled only where the error is less than an eighth of it: it is then about half the
tolerance, so that lengths stay for many steps.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

QUIET = 0.125
"""Of the tolerance: errors below let steps be doubled."""


@dataclass(frozen=True)
class DividedSteps:
    """The rules. By default nothing is divided."""

    tolerance: float = float("inf")
    """Largest error of a step that can be halved."""
    most_halvings: int = 0
    """k of the shortest step, which is taken whatever its error."""

    def can_halve(self, halvings: int) -> bool:
        """Whether a step of 2⁻ᵏ, k = halvings, may be tried again in half."""
        return halvings < self.most_halvings

    def accepts(self, halvings: int, error: float) -> bool:
        """Whether such a step counts."""
        return error <= self.tolerance or not self.can_halve(halvings)

    def after(self, halvings: int, error: float, reached: float) -> int:
        """k of the step after one that was accepted at once. reached: positions since the start, at its end."""
        is_even = reached / part(halvings) % 2.0 == 0.0
        return halvings - 1 if halvings and is_even and error < QUIET * self.tolerance else halvings


UNDIVIDED = DividedSteps()
"""One time step from each position to the next."""


def part(halvings: int) -> float:
    """2⁻ᵏ, exactly."""
    return 0.5**halvings


@dataclass(frozen=True)
class StepsTaken:
    """Time steps from one position to the next one, or over several positions."""

    accepted: int
    """Their number."""
    rejected: int
    """Those that were taken again in half."""
    shortest: float
    """Of the accepted ones [s]."""
    error: float
    """The largest estimated one that was accepted."""
    impulse: float
    """Of the mesh force over them, by the trapezoidal rule [N·s; N·s/mm in 2D]."""
    largest_force: float
    """Of the mesh, at their ends [N; N/mm in 2D]."""
    lowest_error: float
    """Of transmission, at their ends [mm]."""

    @staticmethod
    def joined(parts: Iterable[StepsTaken]) -> StepsTaken:
        """Of all of several, at least one."""
        every = tuple(parts)
        return StepsTaken(
            sum(each.accepted for each in every), sum(each.rejected for each in every),
            min(each.shortest for each in every), max(each.error for each in every),
            sum(each.impulse for each in every), max(each.largest_force for each in every),
            min(each.lowest_error for each in every),
        )
