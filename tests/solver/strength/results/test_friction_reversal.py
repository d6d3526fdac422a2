"""Where friction reverses on the flanks of a pair with a pressure angle of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from evolvent.scene.scene import load_scene
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.results.friction_reversal import flank_distance, near_reversal
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.checkout import ROOT

SPUR = load_scene(ROOT / "demos/he2022.toml").gear_pair()
HELICAL = load_scene(ROOT / "demos/yang2022.toml").gear_pair()
μ, B = 0.1, 0.1


def loads(roll_distance: list[float]) -> FlankLoads:
    """Half-widths of 0.1 mm, all of which slide."""
    n = len(roll_distance)
    one = np.ones(n)
    return FlankLoads(np.zeros((n, 3), dtype=int), np.array(roll_distance), 0.0 * one, one, B * one, μ * one)


@pytest.mark.parametrize("pair", [SPUR, HELICAL])
@pytest.mark.parametrize("member", list(Member))
def test_length_along_an_involute(pair: GearPair, member: Member) -> None:
    """The contact moves on by dξ while the gear turns by dξ/r_b, and over the profile by its radius of curvature times
    that: the integral of ρ/r_b from the pitch point on."""
    base = pair.gears[member].base_radius
    for ξ in (-2.0, 0.0, 3.0):
        exact = quad(lambda at: pair.curvature_radii(np.array([at]))[member][0] / base, 0.0, ξ)[0]
        assert abs(flank_distance(pair, member, np.array([ξ]))[0]) == pytest.approx(abs(exact), abs=1e-9)


@pytest.mark.parametrize("pair", [SPUR, HELICAL])
def test_within_two_half_widths_of_the_pitch_line(pair: GearPair) -> None:
    """Near the pitch point a point at ξ is ξ tan α cos β_b from the pitch line, across the contact line, on both
    flanks: flagged at 0.95 of two half-widths and not at 1.05. Two half-widths of ξ itself are well within."""
    gear = pair.gears[Member.PINION]
    slope = pair.curvature_radii(np.zeros(1))[Member.PINION][0] / gear.base_radius * np.cos(gear.base_helix_angle)
    limit = 2.0 * B / float(slope)
    assert limit > 2.5 * 2.0 * B
    own = loads([-1.05 * limit, -0.95 * limit, 0.0, 0.95 * limit, 1.05 * limit])
    for member in Member:
        assert near_reversal(pair, member, own, μ).tolist() == [False, True, True, True, False]


def test_slices_that_stick_in_part() -> None:
    """Far from the pitch line: a slice with half of μ is flagged, one with μ is not; without friction none is, at the
    pitch point neither."""
    own = replace(loads([3.0, 3.0]), friction=np.array([0.5 * μ, μ]))
    assert near_reversal(SPUR, Member.PINION, own, μ).tolist() == [True, False]
    assert not near_reversal(SPUR, Member.PINION, replace(loads([0.0]), friction=np.zeros(1)), 0.0).any()
