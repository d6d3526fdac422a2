"""Contact fatigue of both flanks: what is largest and where, over the flank, and below its most loaded point."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.strength.fatigue.criterion import BELOW, DEEP, NEAR, SURFACE, Criterion
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

FATIGUE, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_DEPTH = (
    "fatigue.csv", "fatigue_life.csv", "fatigue_map.csv", "fatigue_depth.csv"
)  # fmt: skip
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


@dataclass(frozen=True)
class FatigueRow:
    """A line of fatigue.csv: where a criterion is largest on a gear."""

    gear: str
    """pinion or wheel. Both flanks bear the same tractions: with one material the values are the same."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    place: str
    """surface; near surface, below it down to 0.2 half-widths of the contact; below, deeper."""
    value: float
    """Largest over the flank and these depths. NaN where nothing was evaluated."""
    unit: str
    """MPa; empty for Fatemi-Socie, which is a strain."""
    value_error: float
    """Its estimated error by the contact pressure: that of the largest one over itself times the value, twice that of
    Fatemi-Socie. NaN without a coarse companion (`output.error_bars`)."""
    diameter_mm: float
    """Where it is largest: diameter of the gear."""
    height_mm: float
    """Axial position there, 0 at mid-face."""
    depth_mm: float
    """Depth below the flank there."""
    roll_distance_mm: float
    """Distance of the contact from the pitch point along the path of contact, negative towards the pinion's root."""
    pressure_MPa: float
    """Contact pressure above that point."""
    at_zone_end: bool
    """Whether it lies beside the zone of a tip edge, which is left out: it may be larger further in, and where it lies
    is no prediction of where damage begins."""
    change_percent: float
    """Of the value over that at the first friction coefficient."""
    change_at_points_percent: float
    """Median over the points of the flank of the same change, of each point's largest value at these depths."""
    change_at_points_percent_error: float
    """How far the coarse companion's is from it; NaN without one."""


@dataclass(frozen=True)
class FatigueLifeRow:
    """A line of fatigue_life.csv: a life, in passages of the contact, over that at the first friction coefficient,
    N ∝ value^−m."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    place: str
    """As in fatigue.csv."""
    exponent: float
    """m."""
    source: str
    """Of the exponent; empty for those of fatigue.exponents."""
    life_ratio: float
    """By the largest values of the flank, each at a single point, which may lie beside a tip-edge zone (`at_zone_end`
    of fatigue.csv) and at another one for each coefficient."""
    life_ratio_at_points: float
    """By the median change at the points of the flank, each compared with itself: the one to quote."""


@dataclass(frozen=True)
class FatigueMapRow:
    """A line of fatigue_map.csv: a criterion at a point of a flank."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    diameter_mm: float
    """Of the point."""
    height_mm: float
    """Axial position, 0 at mid-face."""
    roll_distance_mm: float
    """Distance of the contact from the pitch point along the path of contact, negative towards the pinion's root."""
    pressure_MPa: float
    """Peak contact pressure when the contact passes."""
    half_width_mm: float
    """Of the contact then."""
    traction_coefficient: float
    """Net tangential force over normal force then: μ where the contact slides, less where it sticks or the pitch line
    crosses the slice."""
    criterion: str
    """Its name."""
    at_surface: float
    """Value at the surface, in the unit of fatigue.csv."""
    near_surface: float
    """Largest below it down to 0.2 half-widths; NaN for contact pressure."""
    below: float
    """Largest deeper; NaN for contact pressure and tensile stress."""
    depth_mm: float
    """Depth of that, likewise."""


@dataclass(frozen=True)
class FatigueDepthRow:
    """A line of fatigue_depth.csv: a criterion below the point of a flank with the largest contact pressure."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    diameter_mm: float
    """Of the point."""
    height_mm: float
    """Its axial position, 0 at mid-face."""
    criterion: str
    """Its name."""
    depth_mm: float
    """Below the flank."""
    depth_over_half_width: float
    """The same, over the half-width of the contact."""
    value: float
    """In the unit of fatigue.csv."""


def diameters(pair: GearPair, member: Member, roll_distance: Floats) -> Floats:
    """Of the points of a gear's flank at roll distances ξ (n,), (n,) [mm]."""
    on_line = pair.curvature_radii(roll_distance)[member]
    return np.asarray(2.0 * np.hypot(on_line, pair.gears[member].base_radius))


def fatigue_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueRow]:
    """Of both gears, at all friction coefficients."""
    for each in found:
        for member in Member:
            for criterion in each.gears[member].values:
                for place in criterion.places:
                    if depths_at(each.gears[member], place).any():
                        yield _largest(pair, member, each, criterion, place, found[0])


def depths_at(own: FlankFatigue, place: str) -> Bools:
    """(m,) which depths belong to a place."""
    below = {SURFACE: own.depths == 0.0, BELOW: own.depths >= DEEP, NEAR: (own.depths > 0.0) & (own.depths < DEEP)}
    return np.asarray(below[place])


def changes(own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str) -> tuple[float, float]:
    """Ratios of a criterion to that at the first friction coefficient: of the largest values, and the median over
    points that both have. NaN where there are none."""
    now, then = (each.values[criterion][:, depths_at(each, place)].max(axis=1, initial=0.0) for each in (own, first))
    if not (len(now) and len(then) and then.max() > 0.0):
        return math.nan, math.nan
    known = {tuple(key): value for key, value in zip(first.loads.place.tolist(), then)}
    ratios = [
        value / known[key]
        for key, value in zip(map(tuple, own.loads.place.tolist()), now)
        if known.get(key, 0.0) > 0.0
    ]
    return float(now.max() / then.max()), float(np.median(ratios)) if ratios else math.nan


def life_rows(found: Sequence[FrictionFatigue], exponents: Sequence[float]) -> Iterator[FatigueLifeRow]:
    """Of both gears, at all friction coefficients but the first."""
    for each in found[1:]:
        for member in Member:
            own, first = each.gears[member], found[0].gears[member]
            for criterion in own.values:
                for place in criterion.places:
                    ratios = changes(own, first, criterion, place)
                    for m, source in (*criterion.slopes_at(place), *((given, "") for given in exponents)):
                        yield FatigueLifeRow(
                            member.label, each.friction, criterion.name, place, m, source, *_lives(ratios, m)
                        )


def _lives(ratios: tuple[float, float], slope: float) -> tuple[float, float]:
    """Infinite where nothing is left of a criterion, as of tension without friction."""
    with np.errstate(divide="ignore", over="ignore"):
        largest, at_points = np.power(ratios, -slope)
    return float(largest), float(at_points)


def map_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueMapRow]:
    """Of both gears, at all friction coefficients, from the root of the pinion on."""
    for each in found:
        for member, own in zip(Member, each.gears):
            yield from _flank(pair, member, each.friction, own)


def depth_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueDepthRow]:
    """Of both gears, at all friction coefficients."""
    for each in found:
        for member, own in zip(Member, each.gears):
            if not len(own.loads.peak):
                continue
            top = int(np.argmax(own.loads.peak))
            point = float(diameters(pair, member, own.loads.roll_distance[[top]])[0]), float(own.loads.height[top])
            for criterion, values in own.values.items():
                here = np.any([depths_at(own, place) for place in criterion.places], axis=0)
                for ratio, depth, value in zip(own.depths[here], own.depths_mm[top, here], values[top, here]):
                    yield FatigueDepthRow(
                        member.label, each.friction, *point, criterion.name, float(depth), float(ratio), float(value)
                    )


def _flank(pair: GearPair, member: Member, friction: float, own: FlankFatigue) -> Iterator[FatigueMapRow]:
    loads, depths = own.loads, own.depths_mm
    diameter = diameters(pair, member, loads.roll_distance)
    for k in np.lexsort((loads.height, loads.roll_distance)):
        point = (
            member.label, friction, float(diameter[k]), float(loads.height[k]), float(loads.roll_distance[k]),
            float(loads.peak[k]), float(loads.half_width[k]), float(loads.friction[k]),
        )  # fmt: skip
        for criterion, values in own.values.items():
            found = {place: _deepest(own, values[k], depths[k], place) for place in criterion.places}
            nothing = math.nan, math.nan
            near, below = found.get(NEAR, nothing), found.get(BELOW, nothing)
            yield FatigueMapRow(*point, criterion.name, found[SURFACE][0], near[0], *below)


def _deepest(own: FlankFatigue, values: Floats, depths: Floats, place: str) -> tuple[float, float]:
    """Largest value below a point at a place, and its depth."""
    here = np.flatnonzero(depths_at(own, place))
    if not len(here):
        return math.nan, math.nan
    worst = here[int(np.argmax(values[here]))]
    return float(values[worst]), float(depths[worst])


def _largest(
    pair: GearPair, member: Member, each: FrictionFatigue, criterion: Criterion, place: str, first: FrictionFatigue
) -> FatigueRow:
    own = each.gears[member]
    head = member.label, each.friction, criterion.name, place
    if not len(own.loads.peak):
        no = math.nan
        return FatigueRow(*head, no, criterion.unit, no, no, no, no, no, no, False, no, no, no)
    columns = np.flatnonzero(depths_at(own, place))
    values = own.values[criterion][:, columns]
    k, m = np.unravel_index(int(np.argmax(values)), values.shape)
    ξ, value = float(own.loads.roll_distance[k]), float(values[k, m])
    largest, at_points = (100.0 * (ratio - 1.0) for ratio in changes(own, first.gears[member], criterion, place))
    return FatigueRow(
        *head, value, criterion.unit, value * criterion.pressure_power * each.pressure_error,
        float(diameters(pair, member, np.array([ξ]))[0]), float(own.loads.height[k]),
        float(own.depths_mm[k, columns[m]]), ξ, float(own.loads.peak[k]), each.at_zone_end(ξ), largest, at_points,
        _change_error(member, each, criterion, place, first, at_points),
    )  # fmt: skip


def _change_error(
    member: Member, each: FrictionFatigue, criterion: Criterion, place: str, first: FrictionFatigue, percent: float
) -> float:
    if each.coarse is None or first.coarse is None:
        return math.nan
    coarse = changes(each.coarse[member], first.coarse[member], criterion, place)[1]
    return abs(100.0 * (coarse - 1.0) - percent)
