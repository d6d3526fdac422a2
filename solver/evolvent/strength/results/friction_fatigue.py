"""Contact fatigue of both flanks at one friction coefficient, and its change over another."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent.strength.fatigue.criterion import Criterion
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

NEGLIGIBLE = 1e-4
"""Stress over the contact pressure below which it counts as zero. Changes over it, and lives by them, would have no
meaning."""
AT_END = 1e-6
"""Tip-edge zones shorter than this [mm] are ignored."""
BESIDE_ZONE = 0.02
"""Distance from a tip-edge zone within which a point counts as beside it, over the path between the zones."""


@dataclass(frozen=True)
class FrictionFatigue:
    """Fatigue of both flanks at one friction coefficient."""

    friction: float
    """Friction coefficient μ."""
    gears: tuple[FlankFatigue, FlankFatigue]
    """Fatigue of the flanks of pinion and wheel."""
    pressure_error: float
    """Estimated error of the largest contact pressure over itself; NaN without a coarse companion."""
    zone_ends: tuple[float, ...] = ()
    """Roll distances [mm] at which tip-edge zones begin; empty where no tip edge bears."""
    coarse: tuple[FlankFatigue, FlankFatigue] | None = None
    """Fatigue of both flanks on elements of twice the size; None without a coarse companion."""

    def at_zone_end(self, roll_distance: float) -> bool:
        """Whether a place lies beside a tip-edge zone."""
        path = self.gears[0].loads.roll_distance
        return any(abs(roll_distance - end) < BESIDE_ZONE * float(np.ptp(path)) for end in self.zone_ends)


def zone_ends(pair: GearPair, inner: tuple[float, float]) -> tuple[float, ...]:
    """Roll distances [mm] at which tip-edge zones begin. inner: those between which no tip edge bears."""
    return tuple(x for x, end in zip(inner, pair.path_of_contact) if abs(x - end) > AT_END)


def compared_point(own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str) -> tuple[int, int] | None:
    """The point of the flank at which a criterion is compared between friction coefficients, as its indices in `own`
    and in `first`: where it is largest at the first one, among the points that both have. None where it is negligible
    there (`NEGLIGIBLE`), or without such points."""
    here = {tuple(key): k for k, key in enumerate(own.loads.place.tolist())}
    then = _at(first, criterion, place)
    shared = [(float(then[k]), k) for k, key in enumerate(map(tuple, first.loads.place.tolist())) if key in here]
    if not shared:
        return None
    k = max(shared)[1]
    return (here[tuple(first.loads.place[k].tolist())], k) if then[k] > 0.0 else None


def changes(own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str) -> tuple[float, float]:
    """Ratios of a criterion to that at the first friction coefficient: at the point of the flank where that is largest
    (`compared_point`), and the median over points that both have. NaN where the first one is negligible."""
    now, then = _at(own, criterion, place), _at(first, criterion, place)
    known = {tuple(key): value for key, value in zip(first.loads.place.tolist(), then)}
    ratios = [
        value / known[key] for key, value in zip(map(tuple, own.loads.place.tolist()), now) if known.get(key, 0.0) > 0.0
    ]
    point = compared_point(own, first, criterion, place)
    at_point = math.nan if point is None else float(now[point[0]] / then[point[1]])
    return at_point, float(np.median(ratios)) if ratios else math.nan


def _at(own: FlankFatigue, criterion: Criterion, place: str) -> Floats:
    """Largest value (n,) below each point at a place; 0 for a stress below `NEGLIGIBLE`, as tension without friction:
    what is left of it is the round-off of larger stresses."""
    values = own.values[criterion][:, own.at(place)].max(axis=1, initial=0.0)
    return np.where(values > NEGLIGIBLE * own.loads.peak, values, 0.0) if criterion.unit else values
