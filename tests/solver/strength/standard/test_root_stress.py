"""Nominal root stresses against published ones and against what they reduce to."""

from __future__ import annotations

import math

import numpy as np
import pytest

from evolvent.strength.standard.factors import Edition
from evolvent.strength.standard.root_stress import RootLoad, boundary_stresses, largest_stress, standard_stress
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import zhang

TORQUE = 500e3
"""On the pinion [N·mm]."""
EDITIONS: tuple[Edition, ...] = 2006, 2019
STRESSES = {
    (0.20, Member.PINION): (530.1, 351.9, 328.0, 220.7), (0.20, Member.WHEEL): (546.5, 372.9, 348.6, 228.3),
    (0.25, Member.PINION): (516.1,), (0.25, Member.WHEEL): (533.8,),
    (0.30, Member.PINION): (502.8,), (0.30, Member.WHEEL): (521.7,),
}
"""Rack tip radius and gear -> stresses [MPa] at b, c, d, e: the paper's Eqs 1-25 in their correct ISO form, computed
apart."""


def load(pair: GearPair, member: Member) -> RootLoad:
    return RootLoad(pair, member, TORQUE)


def helical_pair(angle: float, face_width: float = 20.0) -> GearPair:
    """21/34 teeth at the tight centre distance."""
    gears = [
        GearParameters.from_rack(
            z=z, normal_module=2.0, normal_pressure_angle_deg=20.0, helix_angle_deg=angle, hand=hand,
            face_width=face_width, bore_diameter=15.0,
        )
        for z, hand in ((21, 1), (34, -1 if angle else 1))
    ]
    distance = 0.5 * (gears[0].reference_diameter + gears[1].reference_diameter)
    return GearPair(gears[0], gears[1], centre_distance=distance)


@pytest.mark.parametrize(("radius", "member"), list(STRESSES))
def test_stresses_at_the_boundary_points(radius: float, member: Member) -> None:
    """Zhang's pair at 500 N·m with equal sharing: 0.1 % (0.03 % for the digits that are known)."""
    found = {point.name[-2]: point.stress for point in boundary_stresses(load(zhang(radius), member))}
    wanted = STRESSES[radius, member]
    assert [found[name] for name in "bcde"][: len(wanted)] == pytest.approx(wanted, rel=3e-4)


def test_largest_stress_lies_between_the_boundary_points() -> None:
    """With Pedrero's sharing the root bears less at b than with half of the load, and most between b and c; each point
    of a fine list bears no more."""
    pair = zhang()
    root = load(pair, Member.PINION)
    b, c = (point for point in boundary_stresses(root) if point.name[-2] in "bc")
    worst = largest_stress(root)
    assert b.below_tip < worst.below_tip < c.below_tip
    assert b.stress * 0.393 / 0.5 < worst.stress < b.stress
    assert 0.393 < worst.share < 0.607


def test_standard_takes_the_outer_point_of_single_contact() -> None:
    """Zhang's pair, whole load at d, (ε − 1) p_b below the tip: twice the 328.0 MPa of equal sharing, times Y_DT =
    2.366 − 0.666 ε at a tolerance class of 4 in the edition of 2006, times 0.7 in that of 2019: 0.03 %."""
    root = load(zhang(), Member.PINION)
    deep = 2.366 - 0.666 * 2.14131
    assert standard_stress(root, 2006, 6).stress == pytest.approx(656.0, rel=3e-4)
    assert standard_stress(root, 2006, 4).stress == pytest.approx(656.0 * deep, rel=3e-4)
    assert standard_stress(root, 2019, 4).stress == pytest.approx(656.0 * 0.7, rel=3e-4)


@pytest.mark.parametrize("edition", EDITIONS)
@pytest.mark.parametrize("member", Member)
def test_helical_gears_become_spur_gears(edition: Edition, member: Member) -> None:
    """β = 1e-8°: every part of the stress as of spur gears, 1e-9; the overlap ratio itself is 6e-10."""
    spur, nearly = (standard_stress(load(helical_pair(angle), member), edition) for angle in (0.0, 1e-8))
    for name in ("form_factor", "stress_correction_factor", "helix_angle_factor", "deep_tooth_factor", "stress"):
        assert getattr(nearly, name) == pytest.approx(getattr(spur, name), rel=1e-9)


def test_points_of_helical_flanks_are_refused() -> None:
    with pytest.raises(InputError, match="wanted spur gears, found a helix angle of 15°"):
        boundary_stresses(load(helical_pair(15.0), Member.PINION))
    with pytest.raises(InputError, match="wanted spur gears"):
        largest_stress(load(helical_pair(15.0), Member.PINION))


def test_normal_force_of_a_long_tooth_bends_it_as_a_beam() -> None:
    """Y_F alone is the bending stress M/W of the load's part across the tooth's axis, σ b m_n/F_t: from the same load
    point by statics, 1e-12."""
    form = load(zhang(), Member.WHEEL).form_at(0.5)
    gear, section = form.section.gear, form.section
    normal_force = 1.0 / math.cos(gear.pressure_angle)  # for F_t = 1 N at the reference circle
    moment = normal_force * math.cos(form.point.load_angle) * (form.point.height - section.height)
    stress = moment / (section.chord**2 / 6.0)  # per mm of width
    assert form.form_factor == pytest.approx(stress * gear.module, rel=1e-12)
    assert form.is_in_range and np.isfinite(form.stress_correction_factor)
