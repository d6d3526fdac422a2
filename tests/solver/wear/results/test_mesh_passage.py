"""One mesh passage of a flank point: Hertzian ridges on He's pair against the exact values for rigid load sharing."""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from evidence.solved_run import solved_run
from evolvent.contact.hertz import line_pressure
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.run.kept_pitch import pitch_of
from evolvent.wear.gears.flank_grid import line_arc
from evolvent.wear.results.mesh_passage import (
    ContactProfile,
    DepthProfile,
    PointPassage,
    pitch_point_depth,
    radius_at,
    roll_distance_at,
    sliding_distance,
)
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import spur_scene
from tests.support.gear_wear_cases import K, he_run, unworn_pair
from tests.support.synthetic_run import synthetic_run

A = 77.0  # mm, point A of He et al. 2022


def test_point_passage_at_half_load() -> None:
    """p0 = 425.0 MPa over 0.334° of the pinion, and a sliding distance of 0.0625 mm."""
    point = PointPassage.of(he_run(), A)
    assert point.hertz.max() == pytest.approx(425.0, abs=0.1)
    assert point.pressure.max() == pytest.approx(425.0, rel=2e-3)
    assert np.degrees(point.lasts) == pytest.approx(0.334, rel=0.02)
    assert point.sliding[-1] == pytest.approx(0.0625, rel=0.02)
    inner = point.hertz > 0.7 * 425.0  # averages reach half a cell over the rims, which are steep
    np.testing.assert_allclose(point.pressure[inner], point.hertz[inner], atol=0.02 * 425.0)


def test_point_pressure_has_no_spikes() -> None:
    """Problem: He's pair solved at standard, a point between the pitch point and the tip. Exact: the pressure rises to
    Hertz' and falls again, so that its total variation is twice its maximum, and the force is Hertz' for the own load;
    single quadrature points near the edge of the contact make the variation up to four times, and the maximum 19 %
    higher."""
    scene = spur_scene("mesh.level=standard", "sweep.positions=20", "contact.friction=0")
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    point = PointPassage.of(run, A)
    assert point.pressure.max() == pytest.approx(point.hertz.max(), rel=0.05)
    assert np.abs(np.diff(point.pressure)).sum() < 2.05 * point.pressure.max()
    assert point.pressure.sum() == pytest.approx(point.hertz.sum(), rel=0.01)


def test_contact_profile_is_hertzian() -> None:
    """Fitted stress and width are Hertz'; away from the pitch point the sliding is 2b|1 − v_2/v_1|, at point A 0.0625
    mm, and at the pitch point it is not zero."""
    for gear in Member:
        found = ContactProfile.of(he_run(), gear)
        np.testing.assert_allclose(found.peak, found.hertz, rtol=1e-3)
        np.testing.assert_allclose(found.half_width, found.hertz_half_width, rtol=1e-3)
        away = np.abs(found.roll_distance) > 1.0
        np.testing.assert_allclose(found.sliding[away], found.single_point[away], rtol=3e-3)
        at = int(np.argmin(np.abs(found.roll_distance)))
        assert found.single_point[at] < 1e-3 < 3e-3 < found.sliding[at]
    pinion = ContactProfile.of(he_run(), Member.PINION)
    assert np.interp(A, pinion.radius, pinion.single_point) == pytest.approx(0.0625, abs=1e-4)


def test_depth_profile_of_a_million_meshes() -> None:
    """Exact at point A: 2.885 µm by the line contact and 3.674 by Eq. 24. The computed depth is the former within 1 %,
    and at the pitch point that of a passing Hertzian pressure within 5 %."""
    pair = unworn_pair(he_run())
    for gear in Member:
        depths = DepthProfile.of(pair, gear, K)
        own, line, product = (
            1e9 * float(np.interp(A, depths.radius, values))
            for values in (depths.computed, depths.line, depths.peak_times_sliding)
        )
        assert (line, product) == pytest.approx((2.885, 3.674), abs=2e-3)
        assert own == pytest.approx(line, rel=1e-2)
        lowest = float(np.interp(75.0, depths.radius, depths.computed))
        assert lowest == pytest.approx(pitch_point_depth(pair.run, gear, K), rel=5e-2)


def test_pitch_point_depth_by_quadrature() -> None:
    """(K/H)∫p|v_s|dφ of a Hertz ridge over the pitch point, by quadrature, for both gears of a pair of unequal ones."""
    run = synthetic_run("pinion.face_width_mm=25.0", file="demos/zhang2023.toml")
    pair, φ = run.pair, np.linspace(-0.02, 0.02, 400_001)
    for gear in Member:
        ridge = ContactProfile.of(run, gear)
        at = int(np.argmin(np.abs(ridge.roll_distance)))
        assert abs(ridge.roll_distance[at]) < 1e-9
        ξ = pair.pinion.base_radius * φ
        s = line_arc(pair, gear, np.zeros(1)) - line_arc(pair, gear, ξ)
        speed = (1.0 + 1.0 / pair.ratio) * np.abs(ξ)
        whole = line_pressure(s, float(ridge.hertz_half_width[at]), float(ridge.hertz[at])) @ speed * (φ[1] - φ[0])
        assert pitch_point_depth(run, gear, K) == pytest.approx(K * whole, rel=2e-3)


def test_sliding_distance_by_quadrature() -> None:
    """∫|v_s|dφ while a contact of half-width b is over the point, by quadrature, also over the pitch point."""
    pair, b, φ = he_run().pair, 0.13, np.linspace(-0.15, 0.15, 600_001)
    speed = (1.0 + 1.0 / pair.ratio) * pair.pinion.base_radius * np.abs(φ)
    for gear in Member:
        for ξ in (-6.0, -0.1, 0.0, 5.0):
            s = line_arc(pair, gear, np.array([ξ])) - line_arc(pair, gear, pair.pinion.base_radius * φ)
            whole = float(speed @ (np.abs(s) < b)) * (φ[1] - φ[0])
            assert sliding_distance(pair, gear, np.array([ξ]), np.array([b]))[0] == pytest.approx(whole, rel=1e-3)


def places(pair: GearPair, gear: Member, ξ: Floats) -> Floats:
    """ξ there and back."""
    return roll_distance_at(pair, gear, radius_at(pair, gear, ξ))


@pytest.mark.parametrize("gear", Member)
def test_radius_and_roll_distance_are_inverse(gear: Member) -> None:
    """Each the other's inverse; on the pinion the tip is touched at the end of the path, on the wheel at its start."""
    pair, ξ = he_run().pair, np.linspace(*he_run().pair.path_of_contact, 7)
    np.testing.assert_allclose(places(pair, gear, ξ), ξ, atol=1e-12)
    assert radius_at(pair, gear, ξ).max() == pytest.approx(78.0)
    assert np.argmax(radius_at(pair, gear, ξ)) == (6, 0)[gear]
