"""Stiffness of ISO 6336-1, clause 9, against values that others have published."""

from __future__ import annotations

import math
from typing import Any

import pytest

from evolvent.gears.problem.iso_stiffness import (
    blank_factor,
    flexibility,
    mesh_stiffness,
    outside_range,
    single_stiffness,
)
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

HEAVY = 1e3  # N/mm


def gear(z: int, x: float = 0.0, **more: Any) -> GearParameters:
    given = {"normal_module": 3.0, "normal_pressure_angle_deg": 20.0, "face_width": 20.0, "bore_diameter": 20.0} | more
    return GearParameters.from_rack(z=z, profile_shift=x, **given)


def he_pair() -> GearPair:
    """50/50 teeth, 1.25 dedendum coefficient."""
    return GearPair(gear(50), gear(50), 150.0)


def example_pair() -> GearPair:
    """Example 1 of ISO/TR 6336-30:2017, as quoted in github.com/gfsReboucas/Drivetrain, MATISO_6336.m: 17/103 teeth,
    m_n = 8 mm, β = 15.8°, basic rack D of ISO 53."""
    given: dict[str, Any] = {
        "normal_module": 8.0, "helix_angle_deg": 15.8, "face_width": 100.0, "dedendum_coefficient": 1.4,
        "bore_diameter": 60.0,
    }
    return GearPair(gear(17, 0.145, hand=1, **given), gear(103, 0.0, hand=-1, **given), 500.0)


def test_he_pair() -> None:
    """c' = 14.05 and c_γ = 22.0 N/(mm µm) of He's pair, to their last digits; by hand 0.8 · 0.975/q' with
    q' = 0.04723 + 0.41342/50."""
    pair = he_pair()
    single = single_stiffness(pair, HEAVY)
    assert single == pytest.approx(0.8 * 0.975 / (0.04723 + 0.41342 / 50.0), rel=1e-12)
    assert single == pytest.approx(14.05, abs=0.01)
    assert mesh_stiffness(single, pair.transverse_contact_ratio) == pytest.approx(22.0, abs=0.05)


def test_helical_example_of_the_standard() -> None:
    """ISO/TR 6336-30:2017, example 1: z_n = 18.905 and 114.543, 1/q' = 17.85584, c' = 12.37047 N/(mm µm), to their last
    digits; c_γα = 17.46485 to 2e-4, as its tip diameters are rounded."""
    pair = example_pair()
    assert [each.virtual_teeth for each in pair.gears] == pytest.approx([18.905, 114.543], abs=1e-3)
    assert 1.0 / flexibility(pair) == pytest.approx(17.85584, abs=1e-5)
    single = single_stiffness(pair, HEAVY)
    assert single == pytest.approx(12.37047, abs=1e-5)
    assert mesh_stiffness(single, pair.transverse_contact_ratio) == pytest.approx(17.46485, rel=2e-4)


@pytest.mark.parametrize(("thickness", "rim", "exact"), [
    (5.0, 6.0, 1.0 + math.log(0.25) / (5.0 * math.exp(0.4))), (2.0, 6.0, 1.0 + math.log(0.2) / (5.0 * math.exp(0.4))),
    (5.0, 9.0, 1.0 + math.log(0.25) / (5.0 * math.exp(0.6))), (20.0, 6.0, 1.0),
])
def test_blank_factor_of_webs(thickness: float, rim: float, exact: float) -> None:
    """By hand for b = 20 and m_n = 3 mm: C_R = 1 + ln(b_s/b)/(5 e^(s_R/5m_n)), with b_s/b of 0.2 at least, 1 of a web
    as wide as the face; c' has that of the softer gear, whichever it is."""
    webbed = gear(50, web=Web(thickness, rim))
    assert blank_factor(webbed) == pytest.approx(exact, rel=1e-12)
    assert blank_factor(gear(50)) == 1.0
    for gears in ((gear(50), webbed), (webbed, gear(50))):
        ratio = single_stiffness(GearPair(*gears, 150.0), HEAVY) / single_stiffness(he_pair(), HEAVY)
        assert ratio == pytest.approx(exact, rel=1e-12)


def test_light_load_and_other_metals() -> None:
    """Below 100 N/mm c' falls with the fourth root of the line load. 210 GPa is steel; of steel on a metal of half its
    modulus c' is 2 · 1 · ½/(1 + ½) = ⅔."""
    pair = he_pair()
    whole = single_stiffness(pair, HEAVY)
    assert single_stiffness(pair, 100.0 / 16.0) == pytest.approx(0.5 * whole, rel=1e-12)
    assert single_stiffness(pair, HEAVY, (210e3, 210e3)) == whole
    assert single_stiffness(pair, HEAVY, (206e3, 103e3)) == pytest.approx(2.0 / 3.0 * whole, rel=1e-12)


def test_the_smaller_gear_is_the_standards_pinion() -> None:
    """A step-up drive has the stiffness of the same gears the other way round, though q' is not symmetric in them."""
    small, large = gear(20, 0.3), gear(60, 0.0)
    distance = 3.0 * 40.0 + 0.9
    down, up = GearPair(small, large, distance), GearPair(large, small, distance)
    assert flexibility(down) == flexibility(up)
    by_hand = 0.04723 + 0.15551 / 20 + 0.25791 / 60 - 0.00635 * 0.3 - 0.11654 * 0.3 / 20 + 0.00529 * 0.09
    assert flexibility(down) == pytest.approx(by_hand, rel=1e-12)


def test_gears_that_the_formula_is_not_for_are_named() -> None:
    """More shift on the larger gear, and a sum below −0.5: said with the values; He's pair is in range."""
    assert outside_range(he_pair()) is None
    assert "-0.2" in str(outside_range(GearPair(gear(40, -0.2), gear(60, 0.0), 150.0 - 0.5)))
    assert "-0.6" in str(outside_range(GearPair(gear(40, -0.2), gear(60, -0.4), 150.0 - 1.6)))
