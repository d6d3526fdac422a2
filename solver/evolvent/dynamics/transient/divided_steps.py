"""Division of the interval between two positions of a pair into equal time steps.

Each time step is 2⁻ᵏ of that interval, and begins at a multiple of its own length: halves may become quarters anywhere,
and quarters halves after two of them. So every position of the table is the end of a step, and the ends between them
repeat with the mesh as the positions do.

The error of a step (changed_length.py) goes with the square of its length. One with more than the tolerance is repeated
at half its length, and a step is doubled only where the error is less than an eighth of it: it is then about half the
tolerance, so that lengths stay for many steps.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

QUIET = 0.125
"""Error of a step, over the tolerance, below which the next one may be doubled."""


@dataclass(frozen=True)
class DividedSteps:
    """Rules that divide the interval between two positions into time steps. By default it is one step."""

    tolerance: float = float("inf")
    """Largest error of a step that can be halved."""
    most_halvings: int = 0
    """Halvings k of the shortest step, 2⁻ᵏ of the interval, which is accepted whatever its error."""

    def can_halve(self, halvings: int) -> bool:
        """Whether a step of 2⁻ᵏ of the interval, k = halvings, may be repeated at half its length."""
        return halvings < self.most_halvings

    def accepts(self, halvings: int, error: float) -> bool:
        """Whether a step of 2⁻ᵏ of the interval, k = halvings, is accepted with this error."""
        return error <= self.tolerance or not self.can_halve(halvings)

    def after(self, halvings: int, error: float, reached: float) -> int:
        """Halvings k of the step after one that was accepted at once. reached: positions since the start, at its
        end."""
        is_even = reached / part(halvings) % 2.0 == 0.0
        return halvings - 1 if halvings and is_even and error < QUIET * self.tolerance else halvings


UNDIVIDED = DividedSteps()
"""One time step from each position to the next."""


def part(halvings: int) -> float:
    """Length of a step after k halvings over the interval between two positions, 2⁻ᵏ, exactly."""
    return 0.5**halvings


@dataclass(frozen=True)
class StepsTaken:
    """Time steps from one position to the next one, or over several positions."""

    accepted: int
    """Number of accepted time steps."""
    rejected: int
    """Number of time steps that were rejected and repeated at half their length."""
    shortest: float
    """Length of the shortest accepted time step [s]."""
    error: float
    """Largest estimated error of an accepted time step."""
    impulse: float
    """Impulse of the mesh force over the time steps, by the trapezoidal rule [N·s; N·s/mm in 2D]."""
    largest_force: float
    """Largest mesh force at the ends of the time steps [N; N/mm in 2D]."""
    lowest_error: float
    """Lowest transmission error at the ends of the time steps [mm]."""

    @staticmethod
    def joined(parts: Iterable[StepsTaken]) -> StepsTaken:
        """Time steps of several parts together, at least one."""
        every = tuple(parts)
        return StepsTaken(
            sum(each.accepted for each in every), sum(each.rejected for each in every),
            min(each.shortest for each in every), max(each.error for each in every),
            sum(each.impulse for each in every), max(each.largest_force for each in every),
            min(each.lowest_error for each in every),
        )
