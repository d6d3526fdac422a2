"""The depth of a modified flank: a gear with r_b = 40 mm, evaluated from ρ = 10 to 20 mm, and a face of 30 mm."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from evolvent_meshes.gears.modifications.flank_depth import FlankDepth
from evolvent_meshes.gears.modifications.modifications import Modifications

BASE, START, TIP, FACE = 40.0, 10.0, 20.0, 30.0


def depth_of(**given: Any) -> FlankDepth:
    return FlankDepth(Modifications(**given), BASE, START, TIP, FACE)


def diameter(roll_length: float) -> float:
    return 2.0 * math.hypot(BASE, roll_length)


TIP_RELIEF = {"tip_relief_um": 8.0, "tip_relief_start_diameter": diameter(16.0)}
ROOT_RELIEF = {"root_relief_um": 8.0, "root_relief_end_diameter": diameter(14.0)}
END_RELIEF = {"end_relief_um": 8.0, "end_relief_length": 6.0}
CASES: dict[str, tuple[dict[str, Any], list[tuple[float, float, float]]]] = {
    "tip relief": (TIP_RELIEF, [(10.0, 0.0, 0.0), (16.0, 15.0, 0.0), (18.0, 0.0, 4.0), (20.0, -15.0, 8.0)]),
    "parabolic tip relief": (TIP_RELIEF | {"tip_relief_parabolic": True}, [(16.0, 0.0, 0.0), (18.0, 0.0, 2.0)]),
    "root relief": (ROOT_RELIEF, [(20.0, 0.0, 0.0), (14.0, 15.0, 0.0), (12.0, 0.0, 4.0), (10.0, 1.0, 8.0)]),
    "root relief below its full depth": (ROOT_RELIEF, [(9.0, 0.0, 10.0)]),
    "parabolic root relief": (ROOT_RELIEF | {"root_relief_parabolic": True}, [(14.0, 0.0, 0.0), (12.0, 0.0, 2.0)]),
    "profile crowning": (
        {"profile_crowning_um": 4.0}, [(15.0, 3.0, 0.0), (10.0, 0.0, 4.0), (20.0, 15.0, 4.0), (12.5, 0.0, 1.0)],
    ),
    "profile slope": ({"profile_slope_um": 5.0}, [(10.0, 3.0, 0.0), (15.0, 0.0, 2.5), (20.0, 15.0, 5.0)]),
    "negative profile slope": ({"profile_slope_um": -5.0}, [(10.0, 3.0, 5.0), (15.0, 0.0, 2.5), (20.0, 15.0, 0.0)]),
    "lead crowning": ({"lead_crowning_um": 4.0}, [(10.0, 0.0, 0.0), (15.0, -15.0, 4.0), (20.0, 7.5, 1.0)]),
    "helix slope": ({"helix_slope_um": 6.0}, [(10.0, -15.0, 0.0), (15.0, 0.0, 3.0), (20.0, 15.0, 6.0)]),
    "negative helix slope": ({"helix_slope_um": -6.0}, [(10.0, -15.0, 6.0), (15.0, 0.0, 3.0), (20.0, 15.0, 0.0)]),
    "end relief": (END_RELIEF, [(10.0, 9.0, 0.0), (15.0, -12.0, 4.0), (20.0, 15.0, 8.0), (20.0, -15.0, 8.0)]),
    "parabolic end relief": (END_RELIEF | {"end_relief_parabolic": True}, [(10.0, -9.0, 0.0), (15.0, 12.0, 2.0)]),
    "twist": (
        {"twist_um": 8.0},
        [(10.0, -15.0, 4.0), (20.0, 15.0, 4.0), (10.0, 15.0, 0.0), (20.0, -15.0, 0.0), (15.0, 9.0, 2.0)],
    ),
    "negative twist": (
        {"twist_um": -8.0}, [(10.0, 15.0, 4.0), (20.0, -15.0, 4.0), (10.0, -15.0, 0.0), (20.0, 15.0, 0.0)],
    ),
}
"""Modifications; roll length [mm], height [mm] and depth [µm] of points."""


@pytest.mark.parametrize("name", CASES)
def test_depth_at_known_points(name: str) -> None:
    """Full, half, a quarter and none of an amount, where its definition says so. Exact."""
    given, points = CASES[name]
    rho, z, exact = np.array(points).T
    assert depth_of(**given).at(rho, z) == pytest.approx(1e-3 * exact, abs=1e-15)


@pytest.mark.parametrize("name", CASES)
def test_no_modification_adds_material(name: str) -> None:
    """On the evaluated flank the least depth is 0, whatever the sign of the amount, and the largest in a corner."""
    depth = depth_of(**CASES[name][0])
    rho, z = np.meshgrid(np.linspace(START, TIP, 41), np.linspace(-0.5 * FACE, 0.5 * FACE, 41))
    found = depth.at(rho, z)
    assert found.min() == pytest.approx(0.0, abs=1e-15)
    assert found.max() == found[[0, 0, -1, -1], [0, -1, 0, -1]].max() > 0.0


@pytest.mark.parametrize("name", CASES)
def test_slopes_are_the_derivatives_of_the_depth(name: str) -> None:
    """Central differences of 1 µm beside the kinks: 1e-9."""
    depth, step = depth_of(**CASES[name][0]), 1e-3
    rho, z = np.meshgrid(np.linspace(START - 0.9, TIP + 0.8, 9), np.linspace(-15.1, 15.2, 10))
    along_roll, along_z = depth.slopes(rho, z)
    assert along_roll == pytest.approx((depth.at(rho + step, z) - depth.at(rho - step, z)) / (2.0 * step), abs=1e-9)
    assert along_z == pytest.approx((depth.at(rho, z + step) - depth.at(rho, z - step)) / (2.0 * step), abs=1e-9)


@pytest.mark.parametrize("name", ["tip relief", "root relief"])
def test_kink_is_the_jump_of_the_slope(name: str) -> None:
    """Exact: the slope ahead of the start of a linear relief less that behind it; parabolic ones have none."""
    depth = depth_of(**CASES[name][0])
    (kink,) = depth.kinks
    ahead, behind = depth.slopes(kink.roll_length + np.array([1e-6, -1e-6]), np.zeros(2))[0]
    assert (kink.relief, kink.turn) == (name, pytest.approx(ahead - behind, rel=1e-12))
    assert depth_of(**CASES[f"parabolic {name}"][0]).kinks == ()


def test_modifications_add_up() -> None:
    """The depth of all modifications together is the sum of each one's. Exact."""
    together = {key: value for given, _ in list(CASES.values()) for key, value in given.items()}
    rho, z = np.meshgrid(np.linspace(9.0, 20.0, 7), np.linspace(-15.0, 15.0, 8))
    whole = depth_of(**together)
    parts = sum(FlankDepth(whole.given.only(name), BASE, START, TIP, FACE).at(rho, z) for name in whole.given.amounts)
    assert len(whole.given.amounts) == 8
    assert whole.at(rho, z) == pytest.approx(parts, abs=1e-15)
