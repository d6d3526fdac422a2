"""What a transient has reached: all that its next time step begins with."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.contact.step.step_solution import DeformedSurfaces
from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.energy import EnergyBalance


@dataclass(frozen=True)
class Reached:
    """The end of a time step, or the start."""

    time: float
    """[s]."""
    length: float
    """Of the step that ended here [s]; 0 at the start."""
    next_length: float
    """That the next one is to have [s]."""
    motions: tuple[BodyMotion, ...]
    """Of each body."""
    deformed: DeformedSurfaces | None
    """From which slip is measured; None: as placed."""
    balance: EnergyBalance
    """Since the start."""
