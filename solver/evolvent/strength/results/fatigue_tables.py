"""Tables of contact fatigue of both flanks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from evolvent.strength.fatigue.criterion import BELOW, DANG_VAN, NEAR_SURFACE, SHALLOW, Criterion
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent.strength.results.fatigue_rows import FatigueDepthRow, FatigueLifeRow, FatigueMapRow, FatigueRow
from evolvent.strength.results.friction_fatigue import FrictionFatigue, changes, compared_point
from evolvent.strength.results.friction_reversal import near_reversal, passes_pitch_line
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair


def diameters(pair: GearPair, member: Member, roll_distance: Floats) -> Floats:
    """Diameters (n,) of a gear at the points of its flank with roll distances ξ (n,) [mm]."""
    on_line = pair.curvature_radii(roll_distance)[member]
    return np.asarray(2.0 * np.hypot(on_line, pair.gears[member].base_radius))


def fatigue_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueRow]:
    """Rows of fatigue.csv of both gears, at all friction coefficients."""
    for each in found:
        for member in Member:
            for criterion in each.gears[member].values:
                for place in criterion.places:
                    if each.gears[member].at(place).any():
                        yield _largest(pair, member, each, criterion, place, found[0])


def life_rows(found: Sequence[FrictionFatigue], exponents: Sequence[float]) -> Iterator[FatigueLifeRow]:
    """Rows of fatigue_life.csv of both gears, at all friction coefficients but the first."""
    for each in found[1:]:
        for member in Member:
            own, first = each.gears[member], found[0].gears[member]
            for criterion in own.values:
                for place in criterion.places:
                    none = place in criterion.without_life
                    ratios = (math.nan, math.nan) if none else changes(own, first, criterion, place)
                    for m, source in (*criterion.slopes_at(place), *((given, "") for given in exponents)):
                        at_point, at_points = _lives(ratios, m)
                        yield FatigueLifeRow(
                            gear=member.label, friction=each.friction, criterion=criterion.name, place=place,
                            exponent=m, source=source, life_ratio=at_point, life_ratio_at_points=at_points,
                        )


def _lives(ratios: tuple[float, float], slope: float) -> tuple[float, float]:
    """Ratios of lives: infinite where nothing is left of a criterion, as of tension without friction; NaN where there
    was none."""
    with np.errstate(divide="ignore", over="ignore"):
        at_point, at_points = np.power(ratios, -slope)
    return float(at_point), float(at_points)


def map_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueMapRow]:
    """Rows of fatigue_map.csv of both gears, at all friction coefficients, from the root of the pinion on."""
    for each in found:
        for member, own in zip(Member, each.gears):
            yield from _flank(pair, member, each.friction, own)


def depth_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueDepthRow]:
    """Rows of fatigue_depth.csv of both gears, at all friction coefficients. Points about the pitch line are left out
    at each of them if one is above 0, so that like points are compared."""
    rubbing = any(each.friction for each in found)
    for each in found:
        for member, own in zip(Member, each.gears):
            if not len(own.loads.peak):
                continue
            reverses = near_reversal(pair, member, own.loads, each.friction)
            reverses |= rubbing & passes_pitch_line(pair, member, own.loads)
            top = int(np.argmax(np.where(reverses & ~reverses.all(), 0.0, own.loads.peak)))
            for criterion in own.values:
                yield from _below(pair, member, each, criterion, top)


def section_rows(pair: GearPair, found: Sequence[FrictionFatigue]) -> Iterator[FatigueDepthRow]:
    """Rows of fatigue_section.csv: Dang Van's criterion of both gears, at all friction coefficients, from the root of
    the pinion on."""
    for each in found:
        for member, own in zip(Member, each.gears):
            heights = np.unique(own.loads.height)
            if not len(heights):
                continue
            middle = np.flatnonzero(own.loads.height == heights[np.argmin(np.abs(heights))])
            for k in middle[np.argsort(own.loads.roll_distance[middle])]:
                yield from _below(pair, member, each, DANG_VAN, int(k))


def _below(
    pair: GearPair, member: Member, found: FrictionFatigue, criterion: Criterion, k: int
) -> Iterator[FatigueDepthRow]:
    """Rows of a criterion over the depth below point k of a flank."""
    own = found.gears[member]
    here, diameter = _down_to_the_last(own, criterion), diameters(pair, member, own.loads.roll_distance[[k]])[0]
    for ratio, depth, value in zip(own.depths[here], own.depths_mm[k, here], own.values[criterion][k, here]):
        yield FatigueDepthRow(
            gear=member.label, friction=found.friction, diameter_mm=float(diameter),
            height_mm=float(own.loads.height[k]), criterion=criterion.name, depth_um=1e3 * float(depth),
            depth_over_half_width=float(ratio), value=float(value),
        )


def _down_to_the_last(own: FlankFatigue, criterion: Criterion) -> Bools:
    """Whether each depth (m,) is at most as deep as the deepest place at which a criterion is of interest."""
    if BELOW in criterion.places:
        return np.ones(len(own.depths), dtype=bool)
    return np.asarray(own.depths <= max(SHALLOW.get(place, 0.0) for place in criterion.places) + 1e-9)


def _flank(pair: GearPair, member: Member, friction: float, own: FlankFatigue) -> Iterator[FatigueMapRow]:
    loads, depths = own.loads, 1e3 * own.depths_mm
    reverses = near_reversal(pair, member, loads, friction)
    diameter = diameters(pair, member, loads.roll_distance)
    for k in np.lexsort((loads.height, loads.roll_distance)):
        for criterion, values in own.values.items():
            found = {place: _deepest(own, values[k], depths[k], place) for place in criterion.places}
            nothing = math.nan, math.nan
            surface, *shallow = (found.get(place, nothing)[0] for place in NEAR_SURFACE)
            below, depth = found.get(BELOW, nothing)
            yield FatigueMapRow(
                gear=member.label, friction=friction, diameter_mm=float(diameter[k]), height_mm=float(loads.height[k]),
                roll_distance_mm=float(loads.roll_distance[k]), pressure_MPa=float(loads.peak[k]),
                half_width_mm=float(loads.half_width[k]), traction_coefficient=float(loads.friction[k]),
                near_friction_reversal=bool(reverses[k]), criterion=criterion.name, at_surface=surface,
                at_0_02=shallow[0], at_0_05=shallow[1], at_0_1=shallow[2], below=below, depth_um=depth,
            )


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
    nothing = FatigueRow(
        gear=member.label, friction=each.friction, criterion=criterion.name, place=place, value=math.nan,
        unit=criterion.unit, value_error=math.nan, diameter_mm=math.nan, height_mm=math.nan, depth_um=math.nan,
        roll_distance_mm=math.nan, pressure_MPa=math.nan, at_zone_end=False, near_friction_reversal=False,
        at_depth_limit=False, point_roll_distance_mm=math.nan, point_value=math.nan, point_depth_um=math.nan,
        point_at_zone_end=False, point_near_friction_reversal=False,
        change_percent=math.nan, change_percent_error=math.nan, change_at_points_percent=math.nan,
        change_at_points_percent_error=math.nan,
    )
    if not len(own.loads.peak):
        return nothing
    columns = np.flatnonzero(own.at(place))
    values = own.values[criterion][:, columns]
    k, m = np.unravel_index(int(np.argmax(values)), values.shape)
    ξ, value = float(own.loads.roll_distance[k]), float(values[k, m])
    reverses = criterion.of_history & near_reversal(pair, member, own.loads, each.friction)
    errors = _change_errors(member, each, criterion, place, first)
    at_point, at_points = _change_percents(own, first.gears[member], criterion, place)
    compared = compared_point(own, first.gears[member], criterion, place)
    point = _point(own, criterion, place, compared)
    reverses_there = _reverses_at_point(pair, member, each, first, compared)
    return replace(
        nothing, value=value, value_error=value * criterion.pressure_power * each.pressure_error,
        diameter_mm=float(diameters(pair, member, np.array([ξ]))[0]), height_mm=float(own.loads.height[k]),
        depth_um=1e3 * float(own.depths_mm[k, columns[m]]), roll_distance_mm=ξ, pressure_MPa=float(own.loads.peak[k]),
        at_zone_end=each.at_zone_end(ξ), near_friction_reversal=bool(reverses[k]),
        at_depth_limit=place == BELOW and m in (0, len(columns) - 1), point_roll_distance_mm=point[0],
        point_value=point[1], point_depth_um=point[2], point_at_zone_end=each.at_zone_end(point[0]),
        point_near_friction_reversal=criterion.of_history and reverses_there, change_percent=at_point,
        change_percent_error=errors[0],
        change_at_points_percent=at_points, change_at_points_percent_error=errors[1],
    )


def _point(
    own: FlankFatigue, criterion: Criterion, place: str, point: tuple[int, int] | None
) -> tuple[float, float, float]:
    """Roll distance [mm] of the point at which coefficients are compared, value there, and its depth [µm]. point: see
    `compared_point`."""
    if point is None:
        return math.nan, math.nan, math.nan
    k = point[0]
    return float(own.loads.roll_distance[k]), *_deepest(own, own.values[criterion][k], 1e3 * own.depths_mm[k], place)


def _reverses_at_point(
    pair: GearPair, member: Member, each: FrictionFatigue, first: FrictionFatigue, point: tuple[int, int] | None
) -> bool:
    """Whether friction reverses near the point at which coefficients are compared, at either of both. point: see
    `compared_point`."""
    if point is None:
        return False
    return any(
        near_reversal(pair, member, found.gears[member].loads, found.friction)[k]
        for found, k in zip((each, first), point)
    )


def _change_percents(
    own: FlankFatigue, first: FlankFatigue, criterion: Criterion, place: str
) -> tuple[float, float]:
    at_point, at_points = changes(own, first, criterion, place)
    return 100.0 * (at_point - 1.0), 100.0 * (at_points - 1.0)


def _change_errors(
    member: Member, each: FrictionFatigue, criterion: Criterion, place: str, first: FrictionFatigue
) -> tuple[float, float]:
    """Differences of both changes from those of the coarse companion, in per cent."""
    if each.coarse is None or first.coarse is None:
        return math.nan, math.nan
    fine = _change_percents(each.gears[member], first.gears[member], criterion, place)
    coarse = _change_percents(each.coarse[member], first.coarse[member], criterion, place)
    return abs(coarse[0] - fine[0]), abs(coarse[1] - fine[1])
