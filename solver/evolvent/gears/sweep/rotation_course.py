"""The free rotation from position to position, which predicts where the next one is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RotationCourse:
    """Free rotation of the equilibrium from position to position, to predict where a search starts.

    angle: of the pinion at the last position [rad].
    beyond_nominal: rotations of pinion and wheel there beyond the nominal ones, in equilibrium without friction [rad].
    rate: their change per rotation of the pinion; 0 where there is no position before.
    """

    angle: float
    beyond_nominal: tuple[float, float]
    rate: tuple[float, float] = (0.0, 0.0)

    def at(self, angle: float) -> tuple[float, float]:
        """Rotations of pinion and wheel [rad] at a pinion angle, on a straight line through the last two positions."""
        pinion, wheel = (value + rate * (angle - self.angle) for value, rate in zip(self.beyond_nominal, self.rate))
        return pinion, wheel

    def followed_by(self, angle: float, beyond_nominal: tuple[float, float]) -> RotationCourse:
        """Course of the free rotation after one more position."""
        if angle == self.angle:
            return RotationCourse(angle, beyond_nominal, self.rate)
        pinion, wheel = ((new - old) / (angle - self.angle) for new, old in zip(beyond_nominal, self.beyond_nominal))
        return RotationCourse(angle, beyond_nominal, (pinion, wheel))
