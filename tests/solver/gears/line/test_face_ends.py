"""Compliance near the ends of the face: limits of the law, which end is acute, and a contact that ends there."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from evolvent.fem.material import STEEL, Material
from evolvent.gears.line.face_ends import FaceEnds, softness
from evolvent.gears.line.stations import Stations, stations_at
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import helical_scene, spur_scene

HELICAL = helical_scene().gear_pair()
SOFT = Material(2.1e3, 0.3)


def stations(pair: GearPair = HELICAL) -> Stations:
    return stations_at(pair, 0.05, 0.5)


def test_law_at_the_end_and_far_from_it() -> None:
    """Exact: κ ln(w/b) at the end, 0 where w is not wider than the contact, and κ(w² − b²)/4d'² far from it, with
    d' = 1.5 d."""
    ends, b, w = FaceEnds(np.array([[0.0], [30.0]]), np.array([0.4])), np.full(2, 0.1), np.full(2, 0.7)
    extra, _ = ends.extra(b, w)
    assert extra[0] == pytest.approx(0.4 * math.log(7.0), rel=1e-12)
    assert extra[1] == pytest.approx(0.4 * (0.7**2 - 0.1**2) / (4.0 * 45.0**2), rel=1e-3)
    assert ends.extra(w, w)[0] == pytest.approx(0.0, abs=1e-15)


def test_slope_is_the_derivative() -> None:
    """b² grows with the load: the compliance falls by half its derivative with ln b, against b 1e-5 wider and
    narrower."""
    ends, w = FaceEnds(np.array([[0.0], [0.05], [0.4]]), np.array([0.3])), np.full(3, 0.8)
    b = np.array([0.1, 0.1, 0.2])
    (narrow, _), (wide, _) = (ends.extra(b * math.exp(step), w) for step in (-1e-5, 1e-5))
    assert ends.extra(b, w)[1] == pytest.approx(0.5 * (narrow - wide) / 2e-5, rel=1e-7)


@pytest.mark.parametrize("member", Member)
@pytest.mark.parametrize("hand", [1, -1])
def test_the_softer_end_is_the_acute_one(member: Member, hand: int) -> None:
    """Problem: one gear a hundred times as soft as the other one, of either hand. Right: its factor is larger at the
    end at which the outward normal of its flank points to the other one: the edge is acute there."""
    pinion, wheel = (replace(gear, hand=hand * gear.hand) for gear in HELICAL.gears)
    pair = replace(HELICAL, pinion=pinion, wheel=wheel)
    materials = [STEEL, STEEL]
    materials[member] = SOFT
    factor = FaceEnds.of(pair, materials, stations(pair)).factor.reshape(2, 2)
    gear = pair.gears[member]
    normal = Flank(gear).helicoid_normal(np.array([[5.0]]), np.array([0.0])).reshape(3)
    acute = 0 if normal[2] > 0.0 else 1
    assert factor[member][acute] > 5.0 * abs(factor[member][1 - acute])
    assert np.abs(factor[member.mate]).max() < 0.02 * factor[member].max()


def test_ends_of_equal_gears_are_equally_soft() -> None:
    """Exact, by symmetry: one gear's end is acute where the other one's is obtuse. A spur pair has upright ends."""
    factor = FaceEnds.of(HELICAL, (STEEL, STEEL), stations()).factor.reshape(2, 2).sum(axis=0)
    assert factor[0] == pytest.approx(factor[1], rel=1e-12)
    spur = spur_scene().gear_pair()
    assert FaceEnds.of(spur, (STEEL, STEEL), stations(spur)).factor.sum() == pytest.approx(2.0 * softness(0.0, 0.3))


def test_a_wider_gear_does_not_end_there() -> None:
    """Problem: a wheel that is 6 mm wider than the pinion. Exact: its ends are 3 mm further away."""
    wheel = replace(HELICAL.wheel, face_width=HELICAL.wheel.face_width + 6.0)
    same, wide = (FaceEnds.of(pair, (STEEL, STEEL), stations()) for pair in (HELICAL, replace(HELICAL, wheel=wheel)))
    assert wide.distance[:, 2:] == pytest.approx(same.distance[:, 2:] + 3.0, abs=1e-12)
    assert wide.distance[:, :2] == pytest.approx(same.distance[:, :2], abs=1e-12)
