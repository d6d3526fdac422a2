"""Tables of contact fatigue of both flanks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from evolvent.strength.fatigue.criterion import BELOW, NEAR_SURFACE, SHALLOW, Criterion
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent.strength.results.fatigue_rows import FatigueDepthRow, FatigueLifeRow, FatigueMapRow, FatigueRow
from evolvent.strength.results.friction_fatigue import FrictionFatigue, changes, compared_point
from evolvent.strength.results.friction_reversal import near_reversal
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair


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
                    if each.gears[member].at(place).any():
                        yield _largest(pair, member, each, criterion, place, found[0])


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
    """Infinite where nothing is left of a criterion, as of tension without friction; NaN where there was none."""
    with np.errstate(divide="ignore", over="ignore"):
        at_point, at_points = np.power(ratios, -slope)
    return float(at_point), float(at_points)


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
                here = _down_to_the_last(own, criterion)
                for ratio, depth, value in zip(own.depths[here], 1e3 * own.depths_mm[top, here], values[top, here]):
                    yield FatigueDepthRow(
                        member.label, each.friction, *point, criterion.name, float(depth), float(ratio), float(value)
                    )


def _down_to_the_last(own: FlankFatigue, criterion: Criterion) -> Bools:
    """(m,) which depths are at most as deep as the deepest place at which a criterion is of interest."""
    if BELOW in criterion.places:
        return np.ones(len(own.depths), dtype=bool)
    return np.asarray(own.depths <= max(SHALLOW.get(place, 0.0) for place in criterion.places) + 1e-9)


def _flank(pair: GearPair, member: Member, friction: float, own: FlankFatigue) -> Iterator[FatigueMapRow]:
    loads, depths = own.loads, 1e3 * own.depths_mm
    reverses = near_reversal(pair, member, loads, friction)
    diameter = diameters(pair, member, loads.roll_distance)
    for k in np.lexsort((loads.height, loads.roll_distance)):
        point = (
            member.label, friction, float(diameter[k]), float(loads.height[k]), float(loads.roll_distance[k]),
            float(loads.peak[k]), float(loads.half_width[k]), float(loads.friction[k]), bool(reverses[k]),
        )
        for criterion, values in own.values.items():
            found = {place: _deepest(own, values[k], depths[k], place) for place in criterion.places}
            nothing = math.nan, math.nan
            shallow = [found.get(place, nothing)[0] for place in NEAR_SURFACE]
            yield FatigueMapRow(*point, criterion.name, *(*shallow, *found.get(BELOW, nothing)))


def _deepest(own: FlankFatigue, values: Floats, depths: Floats, place: str) -> tuple[float, float]:
    """Largest value below a point at a place, and its depth."""
    here = np.flatnonzero(own.at(place))
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
        return FatigueRow(
            *head, no, criterion.unit, no, no, no, no, no, no, False, False, False, no, no, no, no, no, no, no
        )
    columns = np.flatnonzero(own.at(place))
    values = own.values[criterion][:, columns]
    k, m = np.unravel_index(int(np.argmax(values)), values.shape)
    ξ, value = float(own.loads.roll_distance[k]), float(values[k, m])
    reverses = criterion.of_history & near_reversal(pair, member, own.loads, each.friction)
    errors = _change_errors(member, each, criterion, place, first)
    at_point, at_points = _change_percents(own, first.gears[member], criterion, place)
    return FatigueRow(
        *head, value, criterion.unit, value * criterion.pressure_power * each.pressure_error,
        float(diameters(pair, member, np.array([ξ]))[0]), float(own.loads.height[k]),
        1e3 * float(own.depths_mm[k, columns[m]]), ξ, float(own.loads.peak[k]), each.at_zone_end(ξ), bool(reverses[k]),
        place == BELOW and m in (0, len(columns) - 1), *_point(own, first.gears[member], criterion, place),
        at_point, errors[0], at_points, errors[1],
    )


def _point(own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str) -> tuple[float, float, float]:
    """Roll distance [mm] of the point at which coefficients are compared, value there, and its depth [µm]."""
    point = compared_point(own, first, criterion, place)
    if point is None:
        return math.nan, math.nan, math.nan
    k = point[0]
    return float(own.loads.roll_distance[k]), *_deepest(own, own.values[criterion][k], 1e3 * own.depths_mm[k], place)


def _change_percents(
    own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str
) -> tuple[float, float]:
    at_point, at_points = changes(own, first, criterion, place)
    return 100.0 * (at_point - 1.0), 100.0 * (at_points - 1.0)


def _change_errors(
    member: Member, each: FrictionFatigue, criterion: Criterion, place: str, first: FrictionFatigue
) -> tuple[float, float]:
    """Of both changes, in per cent: how far those of the coarse companion are away."""
    if each.coarse is None or first.coarse is None:
        return math.nan, math.nan
    fine = _change_percents(each.gears[member], first.gears[member], criterion, place)
    coarse = _change_percents(each.coarse[member], first.coarse[member], criterion, place)
    return abs(coarse[0] - fine[0]), abs(coarse[1] - fine[1])
