"""The unloaded transmission error against the flanks' own geometry."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.pair import GearPair

NANOMETRE = 1e-6


def pair(helix: float = 0.0, misalignment: float = 0.0, **modified: Any) -> GearPair:
    """30/45 teeth, the pinion with modifications."""
    rack: dict[str, Any] = {"normal_module": 3.0, "normal_pressure_angle_deg": 20.0, "helix_angle_deg": helix}
    rack |= {"face_width": 16.0, "bore_diameter": 30.0}
    hands = (30, 1), (45, -1)
    pinion, wheel = (GearParameters.from_rack(z=z, hand=hand, **rack) for z, hand in hands)
    given = Modifications(**modified)
    distance = (pinion.reference_diameter + wheel.reference_diameter) / 2.0
    return GearPair(replace(pinion, modifications=given), wheel, distance, misalignment)


RELIEF = {"tip_relief_um": 25.0, "tip_relief_start_diameter": 88.0}  # so long that single contact lies on it


def angles(one: GearPair, count: int = 7) -> Floats:
    return 2.0 * np.pi / one.pinion.z * (np.arange(count) + 0.3) / count


@pytest.mark.parametrize("helix", [0.0, 18.0])
def test_conjugate_flanks_have_none(helix: float) -> None:
    """0 at every rotation, on whichever gear is turned: 1 nm."""
    one = pair(helix)
    for free in Member:
        assert unloaded_error(RigidFlanks(one), angles(one), free) == pytest.approx(0.0, abs=NANOMETRE)


@pytest.mark.parametrize("helix", [0.0, 18.0])
def test_error_of_an_even_layer_is_its_depth(helix: float) -> None:
    """Flanks that miss 7 µm along their normals everywhere turn by 7 µm/cos β_b further: the parallel flank. 1 nm."""
    one = pair(helix)
    chart = FlankChart(np.array([20.0, 200.0]), np.array([0.0]), np.full((2, 1), 7e-3))
    exact = 7e-3 / np.cos(one.pinion.base_helix_angle)
    for charts in ((chart, None), (None, chart)):
        assert unloaded_error(RigidFlanks(one, charts), angles(one)) == pytest.approx(exact, abs=NANOMETRE)


def test_chart_over_the_face_where_the_mate_is_below_the_base_circle() -> None:
    """A pinion of 21 teeth whose mate's flanks reach below its base circle, where it has no involute: 7 µm at both
    ends of the face are 7 µm everywhere, 1 nm, and not an error."""
    rack: dict[str, Any] = {"normal_module": 4.0, "normal_pressure_angle_deg": 20.0, "face_width": 30.0}
    pinion, wheel = (GearParameters.from_rack(z=z, bore_diameter=35.0, **rack) for z in (21, 43))
    one = GearPair(pinion, wheel, 128.0)
    chart = FlankChart(np.array([77.0, 94.0]), np.array([-15.0, 15.0]), np.full((2, 2), 7e-3))
    found = unloaded_error(RigidFlanks(one, (chart, None)), angles(one, 2))
    assert found == pytest.approx(7e-3, abs=NANOMETRE)


@pytest.mark.parametrize("free", Member)
@pytest.mark.parametrize("parabolic", [False, True])
def test_relief_against_profiles_turned_onto_each_other(free: Member, parabolic: bool) -> None:
    """Spur pair with tip relief: both transverse profiles as 20,001 points in polar coordinates; the least angle
    between them at equal radius, of all tooth pairs, times the base radius. 1 nm."""
    one = pair(**RELIEF, tip_relief_parabolic=parabolic)
    turns = angles(one, 11)
    exact = [profile_gap(one, float(angle), free) for angle in turns]
    assert np.ptp(exact) > 1e-3
    assert unloaded_error(RigidFlanks(one), turns, free) == pytest.approx(exact, abs=NANOMETRE)


def profile_gap(one: GearPair, angle: float, free: Member) -> float:
    """r_b times the least angle by which the free gear's profile has to turn."""
    stand, standing = PairRotation(one, angle), free.mate
    own, other = (Flank(one.gears[gear]) for gear in (standing, free))
    points, mate = (flank.point(np.linspace(*flank.roll_lengths, 20001), 0.0)[:, :2] for flank in (own, other))
    curve = CubicSpline(np.hypot(*mate.T), np.unwrap(np.arctan2(mate[:, 1], mate[:, 0])))
    least = np.inf
    for tooth in range(-4, 5):
        space = points @ stand.rotation(standing, 2, tooth).T + stand.centre(standing, 2)
        local = (space - stand.centre(free, 2)) @ stand.rotation(free, 2, tooth)
        radius = np.hypot(*local.T)
        inside = (radius >= curve.x[0]) & (radius <= curve.x[-1])
        turned = np.arctan2(local[inside, 1], local[inside, 0]) - curve(radius[inside])
        turned = turned[np.abs(turned) < 0.5 * np.pi / one.gears[free].z]
        least = min(least, *turned, np.inf)
    return float(one.gears[free].base_radius * least)


@pytest.mark.parametrize("misalignment", [0.0, 15.0])
def test_helical_flanks_just_touch(misalignment: float) -> None:
    """Relief, crowning and a tilted axis: with the wheel turned by e/r_b no point of the pinion's flank lies inside the
    wheel's, and the nearest one on it: within 1 nm, on a grid that is refined about it."""
    one = pair(18.0, misalignment, tip_relief_um=25.0, tip_relief_start_diameter=92.0, lead_crowning_um=12.0)
    turns = angles(one, 3)
    found = unloaded_error(RigidFlanks(one), turns, Member.WHEEL)
    assert np.ptp(found) > 1e-4
    for angle, e in zip(turns, found):
        stand = PairRotation(one, float(angle), (0.0, float(e) / one.wheel.base_radius))
        nearest = min(nearest_distance(one, stand, tooth) for tooth in range(-3, 4))
        assert nearest == pytest.approx(0.0, abs=NANOMETRE)


def test_misalignment_of_either_sign_takes_the_same_room() -> None:
    """Conjugate helical flanks, the wheel tilted about the pitch point: one end of the face touches first, at every
    rotation, by about half the misalignment, whichever way it is tilted; where its contact line ends off the pitch
    point, the axial part of the tilt adds a third of that at most."""
    for misalignment in (5.0, -5.0):
        one = pair(18.0, misalignment)
        found = unloaded_error(RigidFlanks(one), angles(one))
        half = 0.5e-3 * 5.0
        assert (found < -0.7 * half).all()
        assert (found > -1.35 * half).all()


def nearest_distance(one: GearPair, stand: PairRotation, tooth: int) -> float:
    """Least signed distance of the pinion's flank from the wheel's [mm]."""
    flank, mate = Flank(one.pinion), Flank(one.wheel)
    centre, size = np.array([np.mean(flank.roll_lengths), 0.0]), np.array([np.ptp(flank.roll_lengths), 16.0])
    least = np.inf
    for _ in range(7):
        ρ = np.clip(centre[0] + size[0] * np.linspace(-0.5, 0.5, 121), *flank.roll_lengths)
        z = np.clip(centre[1] + size[1] * np.linspace(-0.5, 0.5, 121), -8.0, 8.0)
        grid = np.meshgrid(ρ, z, indexing="ij")
        space = flank.point(*grid) @ stand.rotation(Member.PINION, 3, tooth).T
        local = (space - stand.centre(Member.WHEEL, 3)) @ stand.rotation(Member.WHEEL, 3, tooth)
        foot, _, distance = mate.project(local)
        with np.errstate(invalid="ignore"):
            outside = ~((foot >= mate.roll_lengths[0]) & (foot <= mate.roll_lengths[1]))
        distance = np.where(outside, np.inf, distance)
        i, j = np.unravel_index(int(np.argmin(distance)), distance.shape)
        least, centre, size = min(least, float(distance[i, j])), np.array([ρ[i], z[j]]), size / 20.0
    return least
