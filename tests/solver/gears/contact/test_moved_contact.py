"""Where modifications move the contact across the line of conjugate flanks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from evolvent.gears.contact.moved_contact import farthest_moved, nearest_places
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import yang

WIDE = np.full(5, -3.0), np.full(5, 3.0)
"""Edges of the flanks [mm], far from the line."""


def relieved(parabolic: bool = True) -> GearPair:
    """Yang's pair with tip relief of the pinion, 60 µm over the last third of its profile."""
    pair, tip = yang(), yang().pinion
    start = tip.tip_diameter - 2.5
    given = replace(tip.modifications, tip_relief_um=60.0, tip_relief_parabolic=parabolic,
                    tip_relief_start_diameter=start)
    return GearPair(replace(tip, modifications=given), pair.wheel, pair.centre_distance)


def gap(pair: GearPair, ξ: float, c: float) -> float:
    """Distance of the flanks at a distance c from the line: a parabola, and the depths of both."""
    total = c**2 / (2.0 * float(pair.relative_curvature_radius(np.array([ξ]))[0]))
    for member, gear, pitch_point in zip(Member, pair.gears, pair.pitch_point_roll_lengths):
        arc = (pitch_point + member.sign * ξ) ** 2 / (2.0 * gear.base_radius) + member.sign * c
        total += float(gear.flank_depth.at(np.array([np.sqrt(2.0 * gear.base_radius * arc)]), np.zeros(1))[0])
    return total


@pytest.mark.parametrize("parabolic", [True, False])
def test_least_gap(parabolic: bool) -> None:
    """Problem: tip relief of 60 µm, parabolic and linear, at roll distances before its start and along it. Exact: the
    least gap that SciPy finds, at a place within a hundredth of the farthest one."""
    pair = relieved(parabolic=parabolic)
    ξ = np.linspace(0.5, 1.0, 5) * pair.path_of_contact[1]
    found, farthest = nearest_places(pair, ξ, np.zeros(5), WIDE), farthest_moved(pair)
    assert np.ptp(found) > 0.2 * farthest
    for each, c in zip(ξ, found):
        wanted = minimize_scalar(lambda c, ξ=each: gap(pair, ξ, c), bounds=(-farthest, farthest), method="bounded",
                                 options={"xatol": 1e-6})
        assert gap(pair, each, c) <= wanted.fun + 1e-4
        assert c == pytest.approx(wanted.x, abs=0.01 * farthest)


def test_flanks_without_modifications() -> None:
    """Exact: on the line, and at the edge where that has left the flanks."""
    ξ, edges = np.zeros(3), (np.array([-1.0, 0.2, -1.0]), np.array([1.0, 1.0, -0.3]))
    assert farthest_moved(yang()) == 0.0
    assert nearest_places(yang(), ξ, np.zeros(3), edges) == pytest.approx([0.0, 0.2, -0.3])


def test_places_stay_on_both_flanks() -> None:
    """Problem: relief near an edge 0.05 mm from the line. Exact: no further than the edge."""
    pair = relieved()
    ξ = np.full(2, 0.95 * pair.path_of_contact[1])
    edges = np.full(2, -0.05), np.full(2, 0.05)
    found = nearest_places(pair, ξ, np.zeros(2), edges)
    assert (np.abs(found) <= 0.05 + 1e-12).all()
