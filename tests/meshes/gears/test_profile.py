"""The transverse profile: exact involute, the rack's envelope as fillet, smooth joints."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.profile import SEGMENTS, Profile, mirror
from tests.support.paper_pairs import he, yang, zhang

GEARS = {
    f"{name} {part}": gear
    for name, pair in (("Yang", yang()), ("He", he()), ("Zhang", zhang()))
    for part, gear in zip(("pinion", "wheel"), pair.gears, strict=True)
}
every_gear = pytest.mark.parametrize("gear", GEARS.values(), ids=GEARS.keys())


def unit_tangent(profile: Profile, name: str, t: float) -> Floats:
    """Tangent (2,) of a segment by a central difference inside [0, 1]."""
    step = 1e-6
    low, high = max(t - step, 0.0), min(t + step, 1.0)
    chord = profile.segment(name, high) - profile.segment(name, low)
    return np.asarray(chord / np.linalg.norm(chord))


@every_gear
def test_involute_is_the_unwound_string(gear: GearParameters) -> None:
    """Problem: the involute point of roll length ρ. Solution: the end of a string unwound from the base circle.

    The string leaves the base circle at the point whose tangent it is; its length is ρ, and ρ is also the arc of the
    base circle from the involute's origin. The string is the profile's normal.
    """
    profile = Profile(gear)
    rho = np.linspace(*profile.roll_lengths, 7)
    points, normals = profile.involute_at_roll(rho), profile.normal(rho)
    feet = points - rho[:, None] * normals
    np.testing.assert_allclose(np.linalg.norm(feet, axis=1), gear.base_radius, rtol=1e-14)
    np.testing.assert_allclose(np.einsum("ij,ij->i", feet, normals), 0.0, atol=1e-12)
    unwound = gear.base_half_angle - np.arctan2(feet[:, 1], feet[:, 0])
    np.testing.assert_allclose(unwound * gear.base_radius, rho, rtol=1e-12)
    np.testing.assert_allclose(profile.involute(profile.radius(rho)), points, atol=1e-12)


@every_gear
def test_tooth_thickness_of_the_profile(gear: GearParameters) -> None:
    """On the reference circle the tooth is s_t = m_t(π/2) + 2x m_n tan α_t thick (ISO 21771:2007, 4.7.1)."""
    shift = 2.0 * gear.profile_shift * gear.normal_module * math.tan(gear.transverse_pressure_angle)
    thickness = gear.transverse_module * math.pi / 2.0 + shift
    angle = float(Profile(gear).angle(gear.reference_diameter / 2.0))
    assert 2.0 * angle * gear.reference_diameter / 2.0 == pytest.approx(thickness, rel=1e-12)


@every_gear
def test_half_profile_is_continuous(gear: GearParameters) -> None:
    """The half profile runs from the cut θ = π/z to θ = 0 without a gap, on the given root and tip circles."""
    profile = Profile(gear)
    for first, second in pairwise(SEGMENTS):
        np.testing.assert_allclose(profile.segment(first, 1.0), profile.segment(second, 0.0), atol=1e-12)
    start, end = profile.root_arc(0.0), profile.tip_arc(1.0)
    assert math.atan2(start[1], start[0]) == pytest.approx(math.pi / gear.z)
    assert np.linalg.norm(start) == pytest.approx(gear.root_diameter / 2.0)
    np.testing.assert_allclose(end, [gear.tip_diameter / 2.0, 0.0], atol=1e-12)


@every_gear
def test_fillet_is_tangent_at_both_ends(gear: GearParameters) -> None:
    """The fillet leaves the root circle and joins the involute without a kink (rounded rack tip, no undercut)."""
    profile = Profile(gear)
    for first, second in (("root", "fillet"), ("fillet", "involute")):
        np.testing.assert_allclose(unit_tangent(profile, first, 1.0), unit_tangent(profile, second, 0.0), atol=1e-5)


def rack_distance(gear: GearParameters, points: Floats) -> Floats:
    """Signed distances in the normal section of points (…, 2) = (u, v) in the rack's transverse section, + outside.

    The rack tooth is built here from the standard's drawing: flanks through half the space width at the pitch line,
    inclined by α_n; the tip line; a circle ρ_fP tangent to both. Written apart from the code under test.
    """
    alpha, radius = gear.normal_pressure_angle, gear.rack_tip_radius
    u, v = np.abs(points[..., 0]) * math.cos(gear.helix_angle), points[..., 1]
    half_space = gear.normal_module * (math.pi / 4.0 - gear.profile_shift * math.tan(alpha))
    tip = (gear.root_diameter - gear.reference_diameter) / 2.0
    flank = (u - half_space - v * math.tan(alpha)) * math.cos(alpha)
    centre_v = tip + radius
    centre_u = half_space + centre_v * math.tan(alpha) - radius / math.cos(alpha)
    inside = np.maximum(flank, tip - v)
    in_corner = (v < centre_v - radius * math.sin(alpha)) & (u > centre_u)
    corner = np.hypot(u - centre_u, v - centre_v) - radius
    return np.asarray(np.where(in_corner & (v < centre_v), np.maximum(inside, corner), inside))


@every_gear
def test_fillet_is_the_envelope_of_the_rolling_rack(gear: GearParameters) -> None:
    """Problem: roll the rack along the gear. Solution: it touches every fillet point once and never cuts deeper.

    For each point the least distance from the rack over its whole travel is 0 (sampled every 2 µm of travel, so that it
    is met within the square of that), without use of the law of gearing that the code solves.
    """
    profile = Profile(gear)
    points = np.concatenate([profile.fillet(np.linspace(0.0, 1.0, 9)), profile.involute_arc(np.linspace(0.0, 1.0, 4))])
    radius, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0]) - math.pi / gear.z
    reference = gear.reference_diameter / 2.0
    travel = np.linspace(-8.0 * gear.normal_module, 8.0 * gear.normal_module, 16001)[:, None]
    turned = angle + travel / reference
    in_rack = np.stack([radius * np.sin(turned) - travel, radius * np.cos(turned) - reference], axis=-1)
    least = rack_distance(gear, in_rack).min(axis=0)
    np.testing.assert_allclose(least, 0.0, atol=2e-6)


@every_gear
def test_arc_lengths_of_the_profile_segments(gear: GearParameters) -> None:
    """Segment lengths against chords of a fine outline; equal steps of t are equal arcs."""
    profile = Profile(gear)
    for name in SEGMENTS:
        steps = np.linalg.norm(np.diff(profile.segment(name, np.linspace(0.0, 1.0, 1001)), axis=0), axis=1)
        assert steps.sum() == pytest.approx(profile.arc_lengths[name], rel=1e-5)
        np.testing.assert_allclose(steps, steps.mean(), rtol=2e-2)


def test_full_round_root_has_no_arc() -> None:
    """With the largest tool tip radius the root arc vanishes and the fillet ends at the cut, on the root circle."""
    gear = GEARS["He pinion"]
    slope = math.cos(gear.normal_pressure_angle) / (1.0 - math.sin(gear.normal_pressure_angle))
    radius = gear.rack_tip_radius + gear.rack_tip_half_land * slope
    profile = Profile(replace(gear, rack_tip_radius=radius - 1e-12))
    assert profile.arc_lengths["root"] == pytest.approx(0.0, abs=1e-9)
    end = profile.fillet(0.0)
    assert math.atan2(end[1], end[0]) == pytest.approx(math.pi / gear.z)


def test_outline_is_symmetric_and_closed_over_the_sector() -> None:
    """The outline goes once from −π/z to π/z and is its own mirror image; its area lies between the circles."""
    profile = Profile(GEARS["Yang wheel"])
    points = profile.outline(65)
    np.testing.assert_allclose(mirror(points)[::-1], points, atol=1e-12)
    angle = np.arctan2(points[:, 1], points[:, 0])
    assert (angle[0], angle[-1]) == pytest.approx((-math.pi / 60, math.pi / 60))
    x, y = points.T
    area = 0.5 * abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    root, _, tip = profile.radii
    assert math.pi / 60 * root**2 < area < math.pi / 60 * tip**2
