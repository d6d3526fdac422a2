"""Tables of contact fatigue of flanks whose values are known."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from evolvent.scene.scene import load_scene
from evolvent.strength.fatigue.criterion import (
    BELOW,
    CONTACT_PRESSURE,
    DANG_VAN,
    ORTHOGONAL_SHEAR,
    SHALLOW,
    SURFACE,
    TENSION,
)
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.results.fatigue_tables import depth_rows, diameters, fatigue_rows, life_rows, map_rows
from evolvent.strength.results.friction_fatigue import FrictionFatigue, changes
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.checkout import ROOT

PAIR = load_scene(ROOT / "demos/he2022.toml").gear_pair()
DEPTHS = np.array([0.0, 0.1, 0.5, 1.0])
TENTH = "0.1 half-widths"
Rows = list[list[float]]


def flank(peaks: list[float], shear: Rows, tension: Floats) -> FlankFatigue:
    """Of three points at ξ = −2, 0, 3 mm, half-widths of 0.1, 0.2 and 0.1 mm."""
    n = len(peaks)
    place = np.column_stack([np.arange(n), np.zeros(n, dtype=int), np.zeros(n, dtype=int)])
    loads = FlankLoads(
        place, np.array([-2.0, 0.0, 3.0])[:n], np.zeros(n), np.array(peaks), np.array([0.1, 0.2, 0.1])[:n],
        np.full(n, 0.2),
    )
    surface = np.zeros((n, 4))
    surface[:, 0] = peaks
    edge = np.zeros((n, 4))
    edge[:, :2] = tension[:, None]
    values = {CONTACT_PRESSURE: surface, ORTHOGONAL_SHEAR: np.array(shear).reshape(n, 4), TENSION: edge}
    return FlankFatigue(loads, DEPTHS, values)


SHEAR: Rows = [[100, 120, 400, 500], [90, 300, 450, 90], [80, 96, 400, 80]]
FIRST = flank([1000.0, 900.0, 800.0], SHEAR, np.array([200.0, 180.0, 160.0]))
LOWER: Rows = [[80, 90, 410, 510], [72, 90, 440, 72], [64, 70, 380, 64]]
LESS = flank([1000.0, 900.0, 800.0], LOWER, np.array([150.0, 144.0, 128.0]))
FOUND = [FrictionFatigue(0.2, (FIRST, FIRST), 0.05, (-2.05,)), FrictionFatigue(0.15, (LESS, LESS), math.nan)]


def test_largest_values_and_their_places() -> None:
    """Shear is 100 at the surface, 500 at 0.1 mm below the point at ξ = −2 mm, which is the last depth, and at a tenth
    of a half-width 300, 20 µm below the pitch point, where friction reverses; the error is 5 % of each. The first point
    lies beside a zone that begins at ξ = −2.05 mm."""
    rows = {(row.gear, row.criterion, row.place): row for row in fatigue_rows(PAIR, FOUND) if row.friction == 0.2}
    name = ORTHOGONAL_SHEAR.name
    top, near, deep = (rows["pinion", name, place] for place in (SURFACE, TENTH, BELOW))
    assert (top.value, top.depth_um, top.roll_distance_mm, top.pressure_MPa) == (100.0, 0.0, -2.0, 1000.0)
    assert (near.value, near.depth_um, near.at_zone_end) == (300.0, pytest.approx(20.0), False)
    assert (deep.value, deep.depth_um, deep.value_error, deep.at_zone_end) == (500.0, 100.0, 25.0, True)
    assert [row.near_friction_reversal for row in (top, near, deep)] == [False, True, False]
    assert [row.at_depth_limit for row in (top, near, deep)] == [False, False, True]
    assert ("pinion", "contact_pressure", BELOW) not in rows
    diameter = 2.0 * np.hypot(PAIR.curvature_radii(np.array([-2.0]))[Member.WHEEL], PAIR.wheel.base_radius)
    assert rows["wheel", name, BELOW].diameter_mm == pytest.approx(float(diameter[0]))


def test_error_of_a_change() -> None:
    """Below, in the median: 440/450 on the fine meshes, 460/450 on the coarse ones, 4.4 % of difference; of the largest
    510/500 and 515/500; none without a companion at the first coefficient."""
    coarse: Rows = [[80, 90, 410, 515], [72, 90, 460, 72], [64, 70, 391, 64]]
    more = flank([1000.0, 900.0, 800.0], coarse, np.array([150.0, 144.0, 128.0]))
    found = [replace(FOUND[0], coarse=(FIRST, FIRST)), replace(FOUND[1], coarse=(more, more))]

    def errors(of: list[FrictionFatigue]) -> tuple[float, float]:
        chosen = (row for row in fatigue_rows(PAIR, of) if (row.criterion, row.place) == (ORTHOGONAL_SHEAR.name, BELOW))
        row = next(row for row in chosen if row.friction == 0.15)
        return row.change_percent_error, row.change_at_points_percent_error

    assert errors(found) == pytest.approx((100.0 * 5.0 / 500.0, 100.0 * 20.0 / 450.0))
    assert np.isnan(errors([FOUND[0], found[1]])).all()


def test_changes_are_those_of_one_point_and_at_points() -> None:
    """Below: 510/500 where it is largest first; at the points 1.02, 0.978 and 0.95, of which the second is the median.
    A point that one has alone does not count."""
    assert changes(LESS, FIRST, ORTHOGONAL_SHEAR, BELOW) == pytest.approx((1.02, 440 / 450))
    fewer = flank([1000.0, 900.0], LOWER[:2], np.array([150.0, 144.0]))
    moved = replace(fewer, loads=replace(fewer.loads, place=fewer.loads.place + np.array([1, 0, 0])))
    assert changes(moved, FIRST, ORTHOGONAL_SHEAR, BELOW) == pytest.approx((510 / 450, (510 / 450 + 440 / 400) / 2))


def test_coefficients_are_compared_at_one_point() -> None:
    """Problem: the largest shear jumps from the first point, 100 µm deep, to the second, 200 µm deep. Exact: the change
    is that at the first point, where it is largest at the first coefficient, and the table says where that is; of the
    largest values of both it would be +10 % instead of −10 %."""
    jumped = flank([1000.0] * 3, [[80, 90, 410, 450], [72, 90, 440, 550], [64, 70, 380, 64]], 150.0 * np.ones(3))
    found = [FOUND[0], FrictionFatigue(0.15, (jumped, jumped), math.nan)]
    rows = {row.friction: row for row in fatigue_rows(PAIR, found)
            if (row.gear, row.criterion, row.place) == ("pinion", ORTHOGONAL_SHEAR.name, BELOW)}
    first, second = rows[0.2], rows[0.15]
    assert (second.value, second.roll_distance_mm, second.depth_um) == (550.0, 0.0, 200.0)
    assert (second.point_roll_distance_mm, second.point_value, second.point_depth_um) == (-2.0, 450.0, 100.0)
    assert (first.point_roll_distance_mm, first.point_value, first.change_percent) == (-2.0, 500.0, 0.0)
    assert second.change_percent == pytest.approx(-10.0)
    lives = [row.life_ratio for row in life_rows(found, [4.0]) if (row.criterion, row.place, row.exponent) == (
        ORTHOGONAL_SHEAR.name, BELOW, 4.0)]
    assert lives == pytest.approx([0.9**-4] * 2)


def test_what_is_negligible_at_the_first_coefficient_has_no_change() -> None:
    """Problem: tension without friction at the first coefficient, of which round-off is left. Exact: it has neither
    change nor life over it; with a friction of 0.15 its value stands."""
    still = replace(FIRST, values={**FIRST.values, TENSION: FIRST.values[TENSION] * 1e-9})
    found = [FrictionFatigue(0.0, (still, still), math.nan), FOUND[1]]
    row = next(row for row in fatigue_rows(PAIR, found) if (row.friction, row.criterion) == (0.15, "tension"))
    assert row.value == 150.0 and np.isnan([row.change_percent, row.change_at_points_percent, row.point_value]).all()
    lives = [row for row in life_rows(found, [10.0]) if row.criterion == "tension" and row.place == TENTH]
    assert len(lives) == 2 and np.isnan([(row.life_ratio, row.life_ratio_at_points) for row in lives]).all()


def test_lives() -> None:
    """N ∝ value^−m over the first coefficient: tension falls to 0.75 of itself, at m = 4 the life is 3.16 times as
    long; contact pressure is the same, with its own exponent too; nothing of the first coefficient itself."""
    rows = list(life_rows(FOUND, [4.0]))
    assert {row.friction for row in rows} == {0.15}
    (tension,) = [row for row in rows if (row.criterion, row.gear, row.place) == ("tension", "pinion", TENTH)]
    assert tension.life_ratio == pytest.approx(0.75**-4)
    assert tension.life_ratio_at_points == pytest.approx(0.8**-4)
    pressure = [row for row in rows if row.criterion == "contact_pressure" and row.gear == "wheel"]
    assert [(row.exponent, bool(row.source), row.life_ratio) for row in pressure] == [
        (13.22, True, 1.0), (4.0, False, 1.0)]


def test_no_life_by_the_coefficients_alone() -> None:
    """Orthogonal shear and tension at the surface are μ p0 and 2 μ p0: once, lives by them had ratios up to hundreds.
    None there, by each exponent; at a tenth of a half-width there are lives by both."""
    for name in (ORTHOGONAL_SHEAR.name, TENSION.name):
        for place, known in ((SURFACE, False), (TENTH, True)):
            rows = [row for row in life_rows(FOUND, [4.0, 9.0]) if (row.criterion, row.place) == (name, place)]
            assert len(rows) == 4
            lives = np.array([(row.life_ratio, row.life_ratio_at_points) for row in rows])
            assert (np.isfinite(lives) == known).all()


@pytest.mark.parametrize("frictions", [(0.0, 0.2), (0.2, 0.0), (0.1, 0.2)])
def test_change_rests_on_the_histories_of_both_coefficients(frictions: tuple[float, float]) -> None:
    """Problem: shear is largest at the pitch point, where friction reverses unless there is none, which may be at
    either coefficient. Exact: the change at that point is flagged in each order; the value of the one without friction
    is not, and contact pressure, which has no history, never."""
    shear: Rows = [[100, 120, 400, 410], [90, 300, 450, 500], [80, 96, 400, 80]]
    own = flank([900.0, 1000.0, 800.0], shear, 100.0 * np.ones(3))
    found = [FrictionFatigue(μ, (own, own), math.nan) for μ in frictions]
    rows = {
        (row.friction, row.criterion): row for row in fatigue_rows(PAIR, found)
        if row.gear == "pinion" and row.place in (BELOW, SURFACE) and row.criterion != TENSION.name
    }
    below, pressure = rows[frictions[1], ORTHOGONAL_SHEAR.name], rows[frictions[1], "contact_pressure"]
    assert (below.point_roll_distance_mm, below.near_friction_reversal) == (0.0, frictions[1] > 0.0)
    assert below.point_near_friction_reversal
    assert not pressure.near_friction_reversal and not pressure.point_near_friction_reversal


def test_life_without_what_there_was(recwarn: pytest.WarningsRecorder) -> None:
    """Tension that is gone, or next to, at the second coefficient alone: a life without end, and no error."""
    for left in (0.0, 1e-60):
        still = replace(LESS, values={**LESS.values, TENSION: LESS.values[TENSION] * left})
        rows = life_rows([FOUND[0], FrictionFatigue(0.0, (still, still), math.nan)], [10.0])
        assert [row.life_ratio for row in rows if (row.criterion, row.place) == ("tension", TENTH)] == [math.inf] * 2
    assert not len(recwarn)


def test_exponents_belong_to_a_place() -> None:
    """Lundberg and Palmgren's exponent is one of the shear below the surface; at the surface it has none."""
    sourced = {(row.criterion, row.place, row.exponent) for row in life_rows(FOUND, [4.0]) if row.source}
    assert sourced == {(ORTHOGONAL_SHEAR.name, BELOW, 9.19), ("contact_pressure", SURFACE, 13.22)}


def test_map_has_every_point_from_the_root_on() -> None:
    """3 points, 3 criteria, 2 gears, 2 coefficients; roll distances ascend; of contact pressure nothing below."""
    rows = list(map_rows(PAIR, FOUND))
    assert len(rows) == 36
    own = [row for row in rows if (row.gear, row.friction, row.criterion) == ("wheel", 0.2, "contact_pressure")]
    assert [row.roll_distance_mm for row in own] == [-2.0, 0.0, 3.0]
    assert [row.at_surface for row in own] == [1000.0, 900.0, 800.0]
    assert all(math.isnan(row.below) and math.isnan(row.depth_um) for row in own)
    assert [row.near_friction_reversal for row in own] == [False, True, False]


def test_map_has_what_lies_at_each_depth() -> None:
    """Shear below the second point: 90 at the surface, 300 at 0.1 half-widths, 450 at most from 0.2 down, half of 0.2
    mm below it; nothing at depths that were not evaluated."""
    (row,) = [row for row in map_rows(PAIR, FOUND[:1]) if (row.gear, row.criterion, row.roll_distance_mm) == (
        "pinion", ORTHOGONAL_SHEAR.name, 0.0)]
    assert (row.at_surface, row.at_0_1, row.below, row.depth_um) == (90.0, 300.0, 450.0, 100.0)
    assert math.isnan(row.at_0_02) and math.isnan(row.at_0_05)
    assert list(SHALLOW) == ["0.02 half-widths", "0.05 half-widths", TENTH]


def test_depths_below_the_most_loaded_point() -> None:
    """The point with 1000 MPa: shear at 0, 10, 50 and 100 µm; contact pressure at the surface alone, tension down to
    0.1 half-widths."""
    rows = [row for row in depth_rows(PAIR, FOUND) if (row.gear, row.friction) == ("pinion", 0.2)]
    own = [row for row in rows if row.criterion == ORTHOGONAL_SHEAR.name]
    shear = [(row.depth_um, row.depth_over_half_width, row.value) for row in own]
    assert shear == [
        (0.0, 0.0, 100.0), (pytest.approx(10.0), 0.1, 120.0), (pytest.approx(50.0), 0.5, 400.0), (100.0, 1.0, 500.0)
    ]
    assert [row.criterion for row in rows].count("contact_pressure") == 1
    assert [row.criterion for row in rows].count("tension") == 2


def test_depths_are_below_a_point_whose_history_holds() -> None:
    """Problem: a pinion's flank with the largest pressure at the pitch line. Exact: with a friction coefficient above 0
    the depths lie below the most loaded of the other points, at μ = 0 too; without any below the most loaded of all."""
    made = [
        FrictionFatigue(μ, (flank([800.0, 1000.0, 900.0], SHEAR, np.zeros(3)),) * 2, math.nan)
        for μ in (0.0, 0.2)
    ]
    pitch, beyond = diameters(PAIR, Member.PINION, np.array([0.0, 3.0]))
    for found, wanted in ((made, beyond), (made[:1], pitch)):
        rows = [row for row in depth_rows(PAIR, found) if row.gear == "pinion"]
        assert {row.diameter_mm for row in rows} == {wanted} and {row.friction for row in rows} == {
            each.friction for each in found
        }


def test_flanks_without_any_point() -> None:
    """All values are unknown, no line over flank or depth."""
    nothing = flank([], [], np.zeros(0))
    found = [FrictionFatigue(0.1, (nothing, nothing), math.nan)]
    assert all(math.isnan(row.value) for row in fatigue_rows(PAIR, found))
    assert list(map_rows(PAIR, found)) == [] and list(depth_rows(PAIR, found)) == []
    assert DANG_VAN not in nothing.values


def test_diameters_at_the_pitch_point() -> None:
    """ξ = 0: the working pitch circles."""
    for member, diameter in zip(Member, PAIR.working_pitch_diameters):
        assert diameters(PAIR, member, np.zeros(1)) == pytest.approx([diameter])
