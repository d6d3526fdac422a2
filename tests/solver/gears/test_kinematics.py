"""Two rotating frames: where flanks stand, and the integral of the nominal slip, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.kinematics import PairRotation, nominal_slip, spin
from evolvent_meshes.gears.flank import Flank, action_plane_points, contact_normal, separation
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.rotation import turn
from tests.support.paper_pairs import he, yang


def test_spin_is_the_derivative_of_turn() -> None:
    """Exact: d/dθ of a turned point is e_z × (x − c); central differences, 1e-9."""
    centre, arm, θ, δ = np.array([3.0, -1.0, 0.0]), np.array([[2.0, 0.5, 7.0]]), 0.7, 1e-5
    late, early = (centre + arm @ turn(θ + sign * δ, 3).T for sign in (1, -1))
    here = centre + arm @ turn(θ, 3).T
    np.testing.assert_allclose(spin(here, centre), (late - early) / (2 * δ), atol=1e-9)


@pytest.mark.parametrize("pair", [he(), yang()], ids=["spur", "helical"])
@pytest.mark.parametrize(("angle", "tooth"), [(0.0, 0), (0.05, 0), (-0.1, 0), (0.2, -1), (-0.3, 1)])
def test_flanks_of_a_tooth_pair_meet_on_the_line_of_action(pair: GearPair, angle: float, tooth: int) -> None:
    """Exact: both flanks' points with the curvature radii of (ξ, z), placed in space, are the point of the plane of
    action, for any tooth pair, rotation and height."""
    stand = PairRotation(pair, angle)
    z = np.array([-3.0, 0.0, 2.0])
    ξ = stand.roll_distance(tooth, z)
    wanted = action_plane_points(pair, ξ, z)
    for gear, ρ in zip(Member, pair.curvature_radii(ξ)):
        own = Flank(pair.gears[gear]).point(ρ, z)
        placed = own @ stand.rotation(gear, 3, tooth).T + stand.centre(gear, 3)
        np.testing.assert_allclose(placed, wanted, atol=1e-9)


@pytest.mark.parametrize("misalignment", [-20.0, 20.0])
def test_misalignment_opens_the_gap_that_the_geometry_says(misalignment: float) -> None:
    """Exact to first order, so within 1 % of 20 µm: the normal distance of the placed flanks is `separation`, and the
    wheel turns about its tilted axis."""
    pair = yang(misalignment_um=misalignment)
    stand, z = PairRotation(pair, 0.03), np.array([-8.0, -2.0, 5.0])
    ξ = stand.roll_distance(0, z)
    points = []
    for gear, ρ in zip(Member, pair.curvature_radii(ξ)):
        points.append(Flank(pair.gears[gear]).point(ρ, z) @ stand.rotation(gear, 3).T + stand.centre(gear, 3))
    gap = (points[1] - points[0]) @ contact_normal(pair)
    np.testing.assert_allclose(gap, separation(pair, ξ, z), atol=2e-4)
    assert np.abs(gap).max() > 5e-3
    further = PairRotation(pair, 0.03, (0.0, 1e-6))
    turned = further.rotation(Member.WHEEL, 3) @ stand.rotation(Member.WHEEL, 3).T - np.eye(3)
    arm = points[1] - stand.centre(Member.WHEEL, 3)
    rate = spin(points[1], stand.centre(Member.WHEEL, 3), stand.axis(Member.WHEEL))
    np.testing.assert_allclose(rate, 1e6 * arm @ turned.T, atol=1e-3)


def test_extra_rotations_turn_about_the_own_axis() -> None:
    """Exact: `beyond_nominal` adds to a gear's turn, and 2D is 3D without z."""
    stand = PairRotation(yang(), 0.1, (0.02, -0.03))
    for gear, ε in zip(Member, (0.02, -0.03)):
        nominal = PairRotation(yang(), 0.1).rotation(gear, 3, 2)
        np.testing.assert_allclose(stand.rotation(gear, 3, 2), turn(ε, 3) @ nominal, atol=1e-15)
        np.testing.assert_array_equal(stand.rotation(gear, 2, 2), stand.rotation(gear, 3, 2)[:2, :2])


def integral(ξ_before: float, ξ_now: float, offset: float = 0.0, ratio: float = 2.0) -> float:
    """Slip along the growing tangent, of a point `offset` [mm] from its slice's contact line; base radius 20 mm."""
    growth = 1.0 + 1.0 / ratio
    rate = np.array([[growth * (ξ_now + offset)]])
    slip = nominal_slip(
        rate, np.array([ξ_now]), np.array([ξ_before]), np.ones((1, 1)), ratio, (ξ_now - ξ_before) / 20.0
    )
    return float(slip[0, 0])


@pytest.mark.parametrize(("before", "now"), [(1.0, 1.5), (-2.0, -1.0), (0.0, 0.4), (-0.4, 0.0)])
@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_slip_without_a_crossing(before: float, now: float, offset: float) -> None:
    """Exact: v = (1 + 1/u)(ξ + offset) per radian is linear in ξ; its integral over dφ = dξ/r_b."""
    if before == 0.0:
        offset = 0.0  # starts at the crossing, where a point of the slice counts as the slice does
    expected = 1.5 * (0.5 * (now**2 - before**2) + offset * (now - before)) / 20.0
    assert integral(before, now, offset) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(("before", "now"), [(-0.3, 0.2), (0.5, -0.1)])
def test_slip_counts_from_the_pitch_crossing(before: float, now: float) -> None:
    """Exact: where ξ changes sign, the integral from ξ = 0 alone, (1 + 1/u) ξ²/2 r_b."""
    assert integral(before, now) == pytest.approx(1.5 * 0.5 * now**2 / 20.0, rel=1e-12)


@pytest.mark.parametrize("rounding", [-1e-14, 0.0, 1e-14])
def test_rounding_at_the_pitch_point_changes_nothing(rounding: float) -> None:
    """A position at the crossing, to rounding, has the slip of the whole step before it, in the old direction; a step
    from there that of the step after it. Else positions one pitch apart would differ."""
    assert integral(-0.3, rounding) == pytest.approx(-1.5 * 0.5 * 0.3**2 / 20.0, rel=1e-9)
    assert integral(rounding, 0.3, 0.01) == pytest.approx(1.5 * 0.5 * (0.3**2 + 0.3 * 0.01) / 20.0, rel=1e-9)
