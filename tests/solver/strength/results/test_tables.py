"""Rows of formulas: what they are made of, and what lies outside a factor's range."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from evolvent.strength.results.tables import formula_rows, formula_warnings
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair


def load(member: Member, helix_angle: float = 0.0, times: int = 1, rack_tip_radius: float = 0.38) -> RootLoad:
    """Of so many times 30 and 50 teeth of 3 mm under 150 N·m."""
    pinion, wheel = (
        GearParameters.from_rack(
            z=times * z, normal_module=3.0, normal_pressure_angle_deg=20.0, helix_angle_deg=helix_angle,
            face_width=20.0, bore_diameter=bore, hand=hand, rack_tip_radius_coefficient=rack_tip_radius,
        )
        for z, bore, hand in ((30, 40.0, 1), (50, 60.0, -1))
    )
    return RootLoad(GearPair(pinion, wheel, times * 120.0 / math.cos(math.radians(helix_angle))), member, 150e3)


@pytest.mark.parametrize("member", Member)
@pytest.mark.parametrize("helix_angle", [0.0, 25.0])
def test_stress_is_the_product_of_its_columns(helix_angle: float, member: Member) -> None:
    """σ = share · Y_F · Y_S · Y_β Y_DT Y_B · F_t/(b m_n) of every formula, with F_t = 2 T_1/d_1; the critical section
    lies between root and tip circle, of helical gears, too."""
    own = load(member, helix_angle)
    gear, nominal = own.pair.gears[member], 2.0 * 150e3 / own.pair.pinion.reference_diameter / (20.0 * 3.0)
    rows = list(formula_rows(own, (2006, 2019), 6))
    assert len(rows) == (2 if helix_angle else 7)
    for row in rows:
        factors = row.form_factor * row.stress_correction_factor * row.other_factors
        assert row.stress_MPa == pytest.approx(row.load_share * factors * nominal, rel=1e-12)
        assert row.whole_load_MPa == pytest.approx(factors * nominal, rel=1e-12)
        assert 0.5 * gear.root_diameter < row.radius_mm < 0.5 * gear.tip_diameter
        assert 1.0 < row.notch_parameter < 8.0


def test_factors_beyond_their_range_are_said() -> None:
    """A rack with a sharp tip leaves a sharp fillet on 300 teeth, q_s = 8 and more; the usual one does not."""
    assert list(formula_warnings([load(Member.PINION), load(Member.WHEEL)])) == []
    sharp = load(Member.PINION, times=10, rack_tip_radius=0.0)
    assert sharp.form_at(sharp.contact_ratio - 1.0).notch_parameter >= 8.0
    (said,) = formula_warnings([sharp])
    assert said.startswith("pinion: Y_S is extrapolated")


@pytest.mark.parametrize(("rim", "web", "said"), [(6.0, None, True), (9.0, None, False), (6.0, 5.0, False)])
def test_rims_that_do_not_bend_are_said(rim: float, web: float | None, said: bool) -> None:
    """Teeth 6.75 mm high on a rim that is held at its inside: with 6 mm Y_B is above 1, which finite elements do not
    find; with 9 mm it is 1. A rim of 6 mm on a web bends."""
    own = load(Member.WHEEL)
    gear, bore = own.pair.wheel, own.pair.wheel.root_diameter - 2.0 * rim
    held = replace(gear, bore_diameter=bore, support=Support(is_rim=True))
    wheel = held if web is None else replace(gear, web=Web(web, rim))
    pair = replace(own.pair, wheel=wheel)
    found = list(formula_warnings([RootLoad(pair, Member.PINION, 150e3), RootLoad(pair, Member.WHEEL, 150e3)]))
    assert len(found) == said
    assert all(sentence.startswith("wheel: the inside of its rim is held rigidly") for sentence in found)
    assert all("Y_B = 1.48; give web_thickness_mm" in sentence for sentence in found)
