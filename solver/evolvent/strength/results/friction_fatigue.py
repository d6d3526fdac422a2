"""Contact fatigue of both flanks at one friction coefficient, and its change over another."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent.strength.fatigue.criterion import Criterion
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue

BESIDE_ZONE = 0.02
"""Of the path between the tip-edge zones: what lies so near to a zone is at its end."""


@dataclass(frozen=True)
class FrictionFatigue:
    """Fatigue of both flanks at one friction coefficient."""

    friction: float
    """μ."""
    gears: tuple[FlankFatigue, FlankFatigue]
    """Pinion and wheel."""
    pressure_error: float
    """Estimated error of the largest contact pressure over itself; NaN without a coarse companion."""
    zone_ends: tuple[float, ...] = ()
    """Roll distances [mm] at which tip-edge zones begin; empty where no tip edge bears."""
    coarse: tuple[FlankFatigue, FlankFatigue] | None = None
    """The same on elements of twice the size; None without a coarse companion."""

    def at_zone_end(self, roll_distance: float) -> bool:
        """Whether a place lies beside a tip-edge zone."""
        path = self.gears[0].loads.roll_distance
        return any(abs(roll_distance - end) < BESIDE_ZONE * float(np.ptp(path)) for end in self.zone_ends)


def changes(own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str) -> tuple[float, float]:
    """Ratios of a criterion to that at the first friction coefficient: of the largest values, and the median over
    points that both have. NaN where there are none."""
    now, then = (each.values[criterion][:, each.at(place)].max(axis=1, initial=0.0) for each in (own, first))
    if not (len(now) and len(then) and then.max() > 0.0):
        return math.nan, math.nan
    known = {tuple(key): value for key, value in zip(first.loads.place.tolist(), then)}
    ratios = [
        value / known[key]
        for key, value in zip(map(tuple, own.loads.place.tolist()), now)
        if known.get(key, 0.0) > 0.0
    ]
    return float(now.max() / then.max()), float(np.median(ratios)) if ratios else math.nan
