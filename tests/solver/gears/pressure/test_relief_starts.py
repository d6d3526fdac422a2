"""Contacts that cover the start of a linear relief: a cylinder with a kink on a half-plane; places on a spur pair."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.pressure.flank_facets import FlankFacets
from evolvent.gears.pressure.relief_starts import (
    ContactWidth,
    ReliefStart,
    over_relief_starts,
    relief_starts,
    zone_limits,
)
from evolvent.scene.scene import load_scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.solver.results.test_relief_kinks import kinked

RELIEF = ("pinion.tip_relief_um=20", "wheel.tip_relief_um=20")


def relieved(*overrides: str) -> GearPair:
    """He's spur pair with linear reliefs."""
    return load_scene("demos/he2022.toml", [*RELIEF, *overrides]).gear_pair()


def contacts(ξ: Floats, half_width: float = 0.1, radius: float = 10.0, facet: float = 0.0) -> ContactWidth:
    """Contacts of one width at roll distances."""
    ones = np.ones(len(ξ))
    return ContactWidth(ξ, half_width * ones, radius * ones, facet * np.ones((len(ξ), 2)))


@pytest.mark.parametrize("angle", [0.5, 1.3])
def test_pressure_is_that_of_hertz_outside_the_reach_of_a_kink(angle: float) -> None:
    """Problem: a cylinder with R = b = E* = 1 whose surface is turned by an angle beyond a kink. Exact: while the kink
    is outside the contact, which is b on the side without relief and b + R·angle on the relieved one, the
    fitted peak is Hertz'; a fifth inside it is larger by 1 % and more."""
    start = ReliefStart(Member.PINION, "tip relief", 0.0, 1, angle, 1.0)
    unit = contacts(np.zeros(1), 1.0, 1.0)
    before, beyond = (float(start.reach(unit, side)[0]) for side in (-1, 1))
    assert (before, beyond) == (1.0, 1.0 + angle)
    for place in (before + 0.03, -beyond - 0.03):
        assert kinked(angle, place) == pytest.approx(1.0, abs=0.01)
    for place in (before - 0.2, -beyond + 0.2):
        assert kinked(angle, place) > 1.01


def test_reliefs_of_both_gears_are_found_with_their_sides() -> None:
    """Problem: tip relief of both gears, and root relief of the pinion. Exact: the pinion's tip relief lies at larger
    ξ, the wheel's at smaller, as the pinion's root relief. A helical pair has none, nor has parabolic relief."""
    pair = relieved("pinion.root_relief_um=5")
    tip, root, wheel = relief_starts(pair)
    assert [each.relief for each in (tip, root, wheel)] == ["tip relief", "root relief", "tip relief"]
    assert [each.towards for each in (tip, root, wheel)] == [1, -1, -1]
    assert tip.roll_distance > 0.0 > root.roll_distance and wheel.roll_distance == pytest.approx(-tip.roll_distance)
    parabolic = [f'{gear}.tip_relief_form="parabolic"' for gear in ("pinion", "wheel")]
    assert relief_starts(relieved(*parabolic)) == ()
    assert relief_starts(load_scene("demos/first_pair.toml").gear_pair()) == ()


def test_limits_of_a_zone_are_where_contacts_begin_to_cover_the_kink() -> None:
    """Problem: contacts every 2 µm, whose half-width grows with ξ. Exact: those between the limits cover a kink, all
    others do not; a facet more on either side widens the zone by it."""
    pair = relieved()
    wheel, pinion = sorted(relief_starts(pair), key=lambda start: start.roll_distance)
    ξ = np.linspace(-6.0, 6.0, 6001)
    for facet in (0.0, 0.05):
        ones = np.ones(len(ξ))
        contact = ContactWidth(ξ, 0.1 + 0.01 * (ξ + 6.0), 10.0 * ones, facet * np.ones((len(ξ), 2)))
        limits = np.sort(zone_limits(pair, contact))
        assert len(limits) == 4
        inside = (limits[0] < ξ) & (ξ < limits[1]) | (limits[2] < ξ) & (ξ < limits[3])
        assert np.array_equal(over_relief_starts(pair, contact), inside)
        reach = pinion.reach(contact.at(limits[3]), 1)[0]
        assert limits[3] - pinion.roll_distance == pytest.approx(reach, rel=1e-6)
        assert reach == pytest.approx(pinion.roll * (0.1 + 0.01 * (limits[3] + 6.0) + 10.0 * pinion.angle + facet))
    assert limits[0] < wheel.roll_distance < limits[1]


def test_a_limit_at_which_another_relief_begins_is_none() -> None:
    """Problem: contacts so wide that the zones of both reliefs meet. Exact: only the outer limits are left."""
    ξ = np.linspace(-40.0, 40.0, 801)
    first, last = sorted(zone_limits(relieved(), contacts(ξ, half_width=6.0)))
    assert first < -4.2 and last > 4.2


def test_facets_have_their_lengths_along_the_arc() -> None:
    """Rows of second-order nodes at ρ = 0, 1, … 6 mm, at two heights of which the upper one's nodes are moved, base
    radius 2 mm. Exact: three facets, from ρ²/2r_b; that of the end beyond the rows."""
    ρ = np.arange(7.0)
    flank = FlankFacets.of(np.repeat([-5.0, 5.0], 7), np.concatenate([ρ, ρ + 1e-3]), 2.0, 2)
    assert flank.row_before_tip == 4.0
    np.testing.assert_allclose(flank.lengths_at(np.array([-1.0, 0.5, 3.0, 5.9, 7.0])), [1.0, 1.0, 3.0, 5.0, 5.0])
