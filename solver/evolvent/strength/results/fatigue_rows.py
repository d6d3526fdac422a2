"""Contact fatigue of both flanks: what is largest and where, over the flank, and below its most loaded point."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.strength.fatigue.criterion import Criterion
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

FATIGUE, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_DEPTH = (
    "fatigue.csv", "fatigue_life.csv", "fatigue_map.csv", "fatigue_depth.csv"
)  # fmt: skip
SURFACE, BELOW, DEEP = "surface", "below", 0.2
"""Places: depth 0, and depths from so many half-widths on. Between them values fall from those of the surface."""


@dataclass(frozen=True)
class FrictionFatigue:
    """Fatigue of both flanks at one friction coefficient."""

    friction: float
    """μ."""
    gears: tuple[FlankFatigue, FlankFatigue]
    """Pinion and wheel."""
    pressure_error: float
    """Estimated error of the largest contact pressure over itself; NaN without a coarse companion."""


@dataclass(frozen=True)
class FatigueRow:
    """A line of fatigue.csv: where a criterion is largest on a gear."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    place: str
    """surface, or below it, from 0.2 half-widths of the contact on."""
    value: float
    """Largest over the flank and these depths, MPa; Fatemi-Socie has no unit. NaN where nothing was evaluated."""
    value_error: float
    """Its estimated error: that of the largest contact pressure over itself, times the value; NaN without a coarse
    companion (`output.error_bars`)."""
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
    change_percent: float
    """Of the value over that at the first friction coefficient."""
    change_at_points_percent: float
    """Median over the points of the flank of the same change, of each point's largest value at these depths."""


@dataclass(frozen=True)
class FatigueLifeRow:
    """A line of fatigue_life.csv: a life over that at the first friction coefficient, N ∝ value^−m."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    place: str
    """surface, or below it, from 0.2 half-widths of the contact on."""
    exponent: float
    """m."""
    source: str
    """Of the exponent; empty for those of fatigue.exponents."""
    life_ratio: float
    """By the largest values of the flank."""
    life_ratio_at_points: float
    """By the median change at the points of the flank."""


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
    friction_ratio: float
    """Tangential force over normal force then: μ where the contact slides, less where it sticks."""
    criterion: str
    """Its name."""
    at_surface: float
    """Value at the surface, MPa; Fatemi-Socie has no unit."""
    below: float
    """Largest from 0.2 half-widths below the surface on; NaN for contact pressure and tension."""
    depth_mm: float
    """Depth of that, likewise."""


@dataclass(frozen=True)
class FatigueDepthRow:
    """A line of fatigue_depth.csv: a criterion below the point of a flank with the largest contact pressure."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    depth_mm: float
    """Below the flank."""
    value: float
    """MPa; Fatemi-Socie has no unit."""


def diameters(pair: GearPair, member: Member, roll_distance: Floats) -> Floats:
    """Of the points of a gear's flank at roll distances ξ (n,), (n,) [mm]."""
    on_line = pair.curvature_radii(roll_distance)[member]
    return np.asarray(2.0 * np.hypot(on_line, pair.gears[member].base_radius))


def fatigue_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueRow]:
    """Of both gears, at all friction coefficients."""
    for each in found:
        for member in Member:
            own, first = each.gears[member], found[0].gears[member]
            for criterion in own.values:
                for place in places(criterion):
                    yield _largest(pair, member, each, criterion, place, first)


def places(criterion: Criterion) -> tuple[str, ...]:
    """Where a criterion has values."""
    return (SURFACE, BELOW) if criterion.below else (SURFACE,)


def own_exponent(criterion: Criterion, place: str) -> float | None:
    """Of the S-N line that a criterion has at a place: a source for stress below the surface says nothing of it."""
    return criterion.exponent if place == places(criterion)[-1] else None


def changes(own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str) -> tuple[float, float]:
    """Ratios of a criterion to that at the first friction coefficient: of the largest values, and the median over
    points that both have. NaN where there are none."""
    now, then = (each.values[criterion][:, _at(each, place)].max(axis=1) for each in (own, first))
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
                for place in places(criterion):
                    exponent = own_exponent(criterion, place)
                    known = [] if exponent is None else [(exponent, criterion.source)]
                    ratios = changes(own, first, criterion, place)
                    for m, source in [*known, *((given, "") for given in exponents)]:
                        lives = [ratio**-m for ratio in ratios]
                        yield FatigueLifeRow(
                            member.label, each.friction, criterion.name, place, m, source, lives[0], lives[1]
                        )


def map_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueMapRow]:
    """Of both gears, at all friction coefficients, from the root of the pinion on."""
    for each in found:
        for member, own in zip(Member, each.gears):
            yield from _flank(pair, member, each.friction, own)


def depth_rows(found: Sequence[FrictionFatigue]) -> Iterator[FatigueDepthRow]:
    """Of both gears, at all friction coefficients."""
    for each in found:
        for member, own in zip(Member, each.gears):
            if not len(own.loads.peak):
                continue
            top = int(np.argmax(own.loads.peak))
            for criterion, values in own.values.items():
                for depth, value in zip(own.depths_mm[top], values[top]):
                    if criterion.below or depth == 0.0:
                        yield FatigueDepthRow(member.label, each.friction, criterion.name, float(depth), float(value))


def _flank(pair: GearPair, member: Member, friction: float, own: FlankFatigue) -> Iterator[FatigueMapRow]:
    loads, deep = own.loads, _at(own, BELOW)
    diameter, depths = diameters(pair, member, loads.roll_distance), own.depths_mm[:, deep]
    for k in np.lexsort((loads.height, loads.roll_distance)):
        point = (
            member.label, friction, float(diameter[k]), float(loads.height[k]), float(loads.roll_distance[k]),
            float(loads.peak[k]), float(loads.half_width[k]), float(loads.friction[k]),
        )  # fmt: skip
        for criterion, values in own.values.items():
            below = values[k, deep]
            worst = int(np.argmax(below))
            under = (float(below[worst]), float(depths[k, worst])) if criterion.below else (math.nan, math.nan)
            yield FatigueMapRow(*point, criterion.name, float(values[k, 0]), *under)


def _largest(
    pair: GearPair, member: Member, each: FrictionFatigue, criterion: Criterion, place: str, first: FlankFatigue
) -> FatigueRow:
    own = each.gears[member]
    head = member.label, each.friction, criterion.name, place
    if not len(own.loads.peak):
        return FatigueRow(*head, *[math.nan] * 9)
    columns = np.flatnonzero(_at(own, place))
    values = own.values[criterion][:, columns]
    k, m = np.unravel_index(int(np.argmax(values)), values.shape)
    ξ, value = own.loads.roll_distance[k], float(values[k, m])
    largest, at_points = (100.0 * (ratio - 1.0) for ratio in changes(own, first, criterion, place))
    return FatigueRow(
        *head, value, value * each.pressure_error, float(diameters(pair, member, np.array([ξ]))[0]),
        float(own.loads.height[k]), float(own.depths_mm[k, columns[m]]), float(ξ), float(own.loads.peak[k]), largest,
        at_points,
    )  # fmt: skip


def _at(own: FlankFatigue, place: str) -> Bools:
    """(m,) which depths belong to a place."""
    return np.asarray(own.depths == 0.0 if place == SURFACE else own.depths >= DEEP)
