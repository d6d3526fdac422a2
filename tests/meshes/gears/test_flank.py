"""The exact flank: point, normal, distance, and two flanks in contact by the conventions of docs/design.md."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import (
    Flank,
    action_plane_points,
    contact_lines,
    contact_normal,
    misalignment_rotation,
    misalignment_shift,
    nominal_angles,
    separation,
)
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile
from tests.support.meshes.modified_gears import fully_modified
from tests.support.paper_pairs import he, yang, zhang

RELIEF = Modifications(tip_relief_um=20.0, tip_relief_start_diameter=44.0, lead_crowning_um=8.0)
PARABOLA = replace(RELIEF, tip_relief_parabolic=True)
LEFT = replace(yang().pinion, hand=-1)
FLANKS = {
    "Yang pinion": yang().pinion,
    "left hand": LEFT,
    "relieved": replace(LEFT, modifications=RELIEF),
    "parabolic relief": replace(yang().pinion, modifications=PARABOLA),
    "every modification": fully_modified(LEFT, parabolic=True),
    "Yang wheel": yang().wheel,
    "He": he().pinion,
}
every_flank = pytest.mark.parametrize("gear", FLANKS.values(), ids=FLANKS.keys())
PAIRS = {
    "Yang": yang(),
    "Yang mirrored": GearPair(LEFT, replace(yang().wheel, hand=1), 93.0),
    "He": he(),
    "Zhang": zhang(),
}
every_pair = pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS.keys())


def grid(gear: GearParameters, count: int = 9) -> tuple[Floats, Floats]:
    """(ρ, z) over the whole flank, shape (count, count)."""
    half = gear.face_width / 2.0
    rho, z = np.meshgrid(np.linspace(*Flank(gear).roll_lengths, count), np.linspace(-half, half, count))
    return rho, z


@every_flank
def test_helicoid_is_the_turned_profile(gear: GearParameters) -> None:
    """The section at z is the mid-face profile turned by hand·z·tan β/(d/2) about +z (docs/design.md)."""
    rho, z = grid(gear)
    flat = Profile(gear).involute_at_roll(rho)
    turn = gear.hand * z * math.tan(math.radians(gear.helix_angle_deg)) / (gear.reference_diameter / 2.0)
    x = flat[..., 0] * np.cos(turn) - flat[..., 1] * np.sin(turn)
    y = flat[..., 0] * np.sin(turn) + flat[..., 1] * np.cos(turn)
    np.testing.assert_allclose(Flank(gear).helicoid_point(rho, z), np.stack([x, y, z], axis=-1), atol=1e-12)


@every_flank
def test_normal_is_normal_to_the_modified_surface(gear: GearParameters) -> None:
    """Unit, perpendicular to both tangents (central differences of points), and out of the tooth (towards θ > 0)."""
    flank, (rho, z), step = Flank(gear), grid(gear, 8), 1e-4
    normals = flank.normal(rho, z)
    for change in ((step, 0.0), (0.0, step)):
        ahead, behind = flank.point(rho + change[0], z + change[1]), flank.point(rho - change[0], z - change[1])
        tangent = (ahead - behind) / np.linalg.norm(ahead - behind, axis=-1, keepdims=True)
        np.testing.assert_allclose(np.sum(tangent * normals, axis=-1), 0.0, atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0)
    assert np.all(flank.distance(flank.helicoid_point(rho, z) + 1e-3 * normals) > 0.0)


@every_flank
def test_principal_curvatures_of_the_helicoid(gear: GearParameters) -> None:
    """The helicoid is straight along its generators and curved by cos β_b/ρ across them (second differences)."""
    flank, (rho, z), step = Flank(replace(gear, modifications=Modifications())), grid(gear, 5), 1e-3
    rho, z = rho[:, 1:], z[:, 1:]  # next to the base circle the curvature changes within any step
    point, normal, along = flank.point(rho, z), flank.normal(rho, z), flank.generator(rho, z)
    np.testing.assert_allclose(flank.distance(point + 2.0 * along), 0.0, atol=1e-12)
    straight, across = flank.principal_curvatures(rho)
    assert not straight.any()
    heights = [flank.distance(point + side * step * np.cross(normal, along)) for side in (1.0, -1.0)]
    np.testing.assert_allclose((heights[0] + heights[1]) / step**2, across, rtol=1e-3)


@every_flank
def test_distance_and_foot_of_a_known_offset(gear: GearParameters) -> None:
    """A flank point moved by h along the helicoid's normal is h from the flank and has the old foot, exactly."""
    flank, (rho, z) = Flank(gear), grid(gear)
    for offset in (0.0, 0.05, -0.03):
        points = flank.point(rho, z) + offset * flank.helicoid_normal(rho, z)
        foot, foot_z, distance = flank.project(points)
        np.testing.assert_allclose(distance, offset, atol=1e-12)
        np.testing.assert_allclose(np.stack([foot, foot_z]), np.stack([rho, z]), atol=1e-11)


def test_distance_is_the_shortest() -> None:
    """The closed-form distance of points off the helicoid is the least of 250 000 sampled distances."""
    flank = Flank(yang().pinion)
    points = flank.point(5.0, 1.0) + 0.3 * np.array([[0.15, 0.2, -0.1], [-0.05, -0.1, 0.2], [0.3, -0.2, 0.1]])
    rho, z = np.meshgrid(np.linspace(4.3, 5.7, 501), np.linspace(0.3, 1.7, 501))
    surface = flank.point(rho, z).reshape(-1, 3)
    for point, distance in zip(points, flank.distance(points), strict=True):
        assert np.linalg.norm(surface - point, axis=1).min() == pytest.approx(abs(distance), abs=2e-5)


def test_inside_the_base_cylinder_there_is_no_distance() -> None:
    """A point inside the base cylinder has no foot on the involute: nan, and no warning."""
    assert np.isnan(Flank(he().pinion).distance(np.array([70.0, 0.0, 0.0])))


def test_relief_and_crowning_at_known_points() -> None:
    """Relief: full at the tip, 0 below its start, half or a quarter at half the roll; crowning: full at both faces."""
    for given, middle in ((RELIEF, 0.5), (PARABOLA, 0.25)):
        gear = replace(yang().pinion, modifications=given)
        flank = Flank(gear)
        start, end = gear.roll_length(44.0), flank.roll_lengths[1]
        relief = flank.modification([flank.roll_lengths[0], start, (start + end) / 2.0, end], 0.0)
        np.testing.assert_allclose(relief, 0.020 * np.array([0.0, 0.0, middle, 1.0]), atol=1e-15)
        ends = flank.modification(start, [-8.45, 0.0, 4.225, 8.45])
        np.testing.assert_allclose(ends, 0.008 * np.array([1.0, 0.0, 0.25, 1.0]), atol=1e-15)


def turned(points: Floats, angle: float) -> Floats:
    """Points turned about +z."""
    return np.asarray(Rotation.from_rotvec([0.0, 0.0, angle]).apply(points.reshape(-1, 3)).reshape(points.shape))


def pinion_in_space(pair: GearPair, phi: float, tooth: int, points: Floats) -> Floats:
    """Points of pinion tooth 0's frame, as points of tooth i at rotation φ, in space (docs/design.md)."""
    return turned(points, float(nominal_angles(pair, phi)[0]) + 2.0 * math.pi * tooth / pair.pinion.z)


def into_wheel(pair: GearPair, phi: float, tooth: int, points: Floats) -> Floats:
    """Points of space in the frame of wheel tooth i, turned back onto tooth 0."""
    centred = points - np.array([pair.centre_distance, 0.0, 0.0])
    return turned(centred, -float(nominal_angles(pair, phi)[1]) + 2.0 * math.pi * tooth / pair.wheel.z)


ROTATIONS = (-0.31, -0.1, 0.0, 0.05, 0.217, 0.4)


@every_pair
@pytest.mark.parametrize("phi", ROTATIONS)
def test_flanks_touch_along_the_predicted_lines(pair: GearPair, phi: float) -> None:
    """On each contact line the flanks, placed by `nominal_angles`, share points and have opposite normals (1e-9 mm)."""
    lines = contact_lines(pair, phi)
    assert lines, "no contact line at all"
    pinion, wheel = Flank(pair.pinion), Flank(pair.wheel)
    for line in lines:
        xi, z = line.points(7)
        np.testing.assert_allclose(xi, pair.roll_distance(phi, line.tooth, z), atol=1e-12)
        rho_1, rho_2 = pair.curvature_radii(xi)
        predicted = action_plane_points(pair, xi, z)
        first = pinion_in_space(pair, phi, line.tooth, pinion.point(rho_1, z))
        np.testing.assert_allclose(first, predicted, atol=1e-9)
        np.testing.assert_allclose(into_wheel(pair, phi, line.tooth, predicted), wheel.point(rho_2, z), atol=1e-9)
        normal = pinion_in_space(pair, phi, line.tooth, pinion.normal(rho_1, z))
        np.testing.assert_allclose(normal, np.broadcast_to(contact_normal(pair), normal.shape), atol=1e-12)
        back = turned(normal, -float(nominal_angles(pair, phi)[1]) + 2.0 * math.pi * line.tooth / pair.wheel.z)
        np.testing.assert_allclose(back, -wheel.normal(rho_2, z), atol=1e-12)


@every_pair
@pytest.mark.parametrize("phi", ROTATIONS)
def test_flanks_never_penetrate(pair: GearPair, phi: float) -> None:
    """No point of a pinion flank is inside the facing wheel flank; the least gap is 0 on pairs with a contact line.

    Gaps are at least those of two cylinders at the points' distance along the common normal (convex flanks), so they
    grow off the line; pairs next to the path of contact, without a line, stay apart.
    """
    rho, z = grid(pair.pinion, 161)
    z = z * pair.face_width / pair.pinion.face_width
    touching = {line.tooth: line for line in contact_lines(pair, phi)}
    points = Flank(pair.pinion).point(rho, z)
    for tooth in range(min(touching) - 1, max(touching) + 2):
        local = into_wheel(pair, phi, tooth, pinion_in_space(pair, phi, tooth, points))
        on_tooth = np.hypot(local[..., 0], local[..., 1]) <= pair.wheel.tip_diameter / 2.0
        gaps = Flank(pair.wheel).distance(local)[on_tooth]
        gaps = gaps[~np.isnan(gaps)]
        assert np.all(gaps > -1e-9)
        if tooth not in touching and gaps.size:
            assert gaps.min() > 1e-6


@every_pair
def test_gap_beside_the_contact_line_is_hertz(pair: GearPair) -> None:
    """At a small distance s across the contact line the gap of the two flanks is s²/2R, R the relative radius."""
    pinion, wheel, step = Flank(pair.pinion), Flank(pair.wheel), 0.02
    rho_1, _ = pair.curvature_radii(0.7)
    z, phi = 0.0, 0.7 / pair.pinion.base_radius
    across = np.cross(pinion.normal(rho_1, z), pinion.generator(rho_1, z))
    sideways = pinion.point(rho_1, z) + step * across
    on_pinion = sideways - pinion.distance(sideways) * pinion.normal(rho_1, z)
    gap = wheel.distance(into_wheel(pair, phi, 0, pinion_in_space(pair, phi, 0, on_pinion)))
    assert gap == pytest.approx(step**2 / 2.0 / pair.relative_curvature_radius(0.7), rel=1e-2)


@every_pair
def test_contact_lines_agree_with_the_length_and_the_contact_ratio(pair: GearPair) -> None:
    """Lengths add up to `contact_line_length`; a tooth is in contact over ε_γ pitches of rotation, no longer."""
    angles = np.linspace(0.0, 2.0 * math.pi / pair.pinion.z, 401)[:-1] + 1e-7
    cosine = math.cos(pair.pinion.base_helix_angle)
    lines = [contact_lines(pair, phi) for phi in angles]
    for phi, touching in zip(angles, lines, strict=True):
        total = sum(line.z[1] - line.z[0] for line in touching) / cosine
        assert total == pytest.approx(pair.contact_line_length(phi))
    mean_count = np.mean([len(touching) for touching in lines])
    assert mean_count == pytest.approx(pair.total_contact_ratio, abs=0.01)


def test_mesh_of_both_gears_at_phi_zero() -> None:
    """At φ = 0 both loaded flanks of tooth pair 0 pass through the pitch point (d_w1/2, 0, 0)."""
    pair = yang()
    pitch = np.array([pair.working_pitch_diameters[0] / 2.0, 0.0, 0.0])
    assert Flank(pair.pinion).distance(turned(pitch, -float(nominal_angles(pair, 0.0)[0]))) == pytest.approx(
        0.0, abs=1e-12
    )
    assert Flank(pair.wheel).distance(into_wheel(pair, 0.0, 0, pitch)) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("misalignment_um", [30.0, -30.0, 3.0, -3.0, 0.0])
def test_separation_of_modified_misaligned_flanks(misalignment_um: float) -> None:
    """Wheel tilted by `misalignment_rotation` and shifted by `misalignment_shift`, both flanks modified: the gap on the
    lines is `separation`.

    The gap is measured between exact surfaces. `separation` is of first order: it may miss by tilt²·r_w2 and by the
    wheel's shift under the tilt, tilt·ρ_C2, times the modifications' slopes of 0.004: 0.4 µm at 30, 0.02 at 3 µm.
    """
    wheel = Modifications(tip_relief_um=15.0, tip_relief_start_diameter=146.0, lead_crowning_um=5.0)
    pair = yang(PARABOLA, wheel, misalignment_um)
    tilt = misalignment_rotation(pair)
    angle = float(np.linalg.norm(tilt))
    centre, phi = np.array([pair.centre_distance, 0.0, 0.0]), 0.05
    shifted = centre + np.array([0.0, 0.0, misalignment_shift(pair)])
    for line in contact_lines(pair, phi):
        xi, z = line.points(9)
        rho_1, _ = pair.curvature_radii(xi)
        points = pinion_in_space(pair, phi, line.tooth, Flank(pair.pinion).point(rho_1, z))
        untilted = Rotation.from_rotvec(-tilt).apply(points - shifted) + centre
        gap = Flank(pair.wheel).distance(into_wheel(pair, phi, line.tooth, untilted))
        bound = angle**2 * pair.working_pitch_diameters[1] / 2.0 + angle * 0.004 * 25.7 + 1e-8
        np.testing.assert_allclose(gap, separation(pair, xi, z), atol=bound)
