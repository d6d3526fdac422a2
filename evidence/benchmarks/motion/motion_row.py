"""A line of the tables on pairs in motion."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan


@dataclass(frozen=True)
class MotionRow:
    """What was computed, and its bar."""

    what: str
    seconds: float
    """CPU time."""
    below: float
    """Seconds by which these are divided; NaN where the bar is for the seconds themselves."""
    bar: float
    """At most."""

    @property
    def found(self) -> float:
        """What the bar is for."""
        return self.seconds if isnan(self.below) else self.seconds / self.below

    @property
    def met(self) -> bool:
        """Whether it is in its bar."""
        return self.found <= self.bar
