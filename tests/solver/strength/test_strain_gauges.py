"""Strain gauges on the fillet of a sector under stresses that are written out, and where none can be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.fem.material import Material
from evolvent.gears.meshing.root_meshes import with_back_root
from evolvent.strength.root_passage import GearRoots, RootPassage
from evolvent.strength.root_surface import RootSurface, compression_side, tension_side
from evolvent.strength.strain_gauges import Gauge, gauge_places, gauge_strain
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh

STEEL = Material(200e3, 0.3)
GAUGE = Gauge(Member.PINION, True, np.radians(45.0), 0.0, 0.5)


def root(shape: str, loaded: bool = True, helix_angle: float = 0.0) -> RootSurface:
    """Of 33 teeth of 2.3 mm with 24 elements around the fillets."""
    gear = GearParameters.from_rack(
        z=33, normal_module=2.3, normal_pressure_angle_deg=18.0, profile_shift=0.3, rack_tip_radius_coefficient=0.2,
        face_width=10.0, bore_diameter=30.0, helix_angle_deg=helix_angle,
    )
    fine = SectorResolution(profile_elements=12, face_elements=6, fillet_elements=24, back_elements=24)
    mesh = with_back_root(sector_mesh(gear, fine, shape))
    return (tension_side if loaded else compression_side)(mesh, gear)


def roots(own: RootSurface, values: Floats) -> GearRoots:
    """Uniaxial stress along the profile, the same on both sides. values: (k, nodes)."""
    n = own.surface.normals[:, :2]
    t = np.zeros((len(n), 3))
    t[:, :2] = np.column_stack([-n[:, 1], n[:, 0]]) / np.linalg.norm(n, axis=1)[:, None]
    stress = values[:, :, None, None] * t[:, :, None] * t[:, None, :]
    passage = RootPassage(own, np.arange(len(values)) * 0.1, stress, *np.ones((2, len(values))))
    return GearRoots(passage, passage)


@pytest.mark.parametrize(("shape", "helix_angle"), [("quadrilateral", 0.0), ("hexahedron", 0.0), ("hexahedron", 20.0)])
@pytest.mark.parametrize("loaded", [True, False])
def test_uniform_stress_along_the_profile(shape: str, helix_angle: float, loaded: bool) -> None:
    """σ/E at each rotation, on both sides, in space and in a section, wherever the gauge lies: 100 and 300 MPa make 500
    and 1500 µm/m."""
    own = root(shape, loaded, helix_angle)
    uniform = np.array([100.0, 300.0])[:, None] * np.ones(len(own.radii))
    for angle, length in ((35.0, 0.2), (60.0, 1.0)):
        gauge = replace(GAUGE, loaded_side=loaded, angle=np.radians(angle), length=length)
        assert gauge_strain(gauge, roots(own, uniform), STEEL) == pytest.approx(np.array([5e-4, 1.5e-3]), rel=1e-9)


def test_mean_of_a_stress_that_is_linear_along_the_face() -> None:
    """In space, σ = 100 z: a gauge at z = 2 mm has 200 MPa over E."""
    own = root("hexahedron")
    gauge = replace(GAUGE, height=2.0)
    assert gauge_strain(gauge, roots(own, 100.0 * own.heights[None]), STEEL) == pytest.approx([1e-3], rel=1e-9)


def test_a_long_gauge_finds_less_than_the_peak() -> None:
    """A stress that is 100 MPa where the profile has the gauge's angle and falls with the square of the angle's
    difference d, 100 (1 − d²/d_0²), d_0 = 30°: a gauge without a length finds it, 1e-3, and one of 0.6 mm the mean of
    the values at the nodes below it, 2 %."""
    own = root("quadrilateral")
    values = 100.0 * (1.0 - ((own.tangent_angles - GAUGE.angle) / np.radians(30.0)) ** 2)
    short, long = (
        float(gauge_strain(replace(GAUGE, length=length), roots(own, values[None]), STEEL)[0]) for length in (1e-4, 0.6)
    )
    assert short == pytest.approx(100.0 / STEEL.youngs_modulus, rel=1e-3)
    order = np.argsort(own.tangent_angles)
    places = gauge_places(replace(GAUGE, length=0.6), own)
    assert np.ptp(places) == pytest.approx(0.6, rel=0.05)
    x = own.surface.points[order]
    arcs = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])
    middle = np.interp(GAUGE.angle, own.tangent_angles[order], arcs)
    below = np.interp(middle + np.linspace(-0.3, 0.3, 601), arcs, values[order])
    assert long == pytest.approx(float(below.mean()) / STEEL.youngs_modulus, rel=0.02)
    assert long < 0.97 * short


@pytest.mark.parametrize(
    "wrong",
    [
        replace(GAUGE, angle=0.0), replace(GAUGE, angle=np.radians(88.0), length=2.0), replace(GAUGE, length=50.0),
        replace(GAUGE, height=5.1),
    ],
)
def test_gauges_off_the_root_are_refused(wrong: Gauge) -> None:
    """Above the fillet, beyond the middle of the space, longer than the root, beside the face."""
    said = (
        r"strength\.gauges: found strain gauge 3, on the pinion, with angle_deg = .*, height_mm = .* and length_mm = "
        r".*; allowed: angle_deg from .* to .*, height_mm from -5 to 5, .* remedy: move it, or take a shorter one"
    )
    with pytest.raises(InputError, match=said):
        gauge_places(replace(wrong, number=3), root("hexahedron"))


def test_heights_do_not_count_in_a_section() -> None:
    """A gauge beside the face has the places of one at mid-face, and a message on its angle names no heights."""
    plane = root("quadrilateral")
    assert gauge_places(replace(GAUGE, height=5.1), plane) == pytest.approx(gauge_places(GAUGE, plane), rel=1e-15)
    with pytest.raises(InputError, match=r"allowed: angle_deg from \S+ to \S+, all of it on"):
        gauge_places(replace(GAUGE, angle=0.0), plane)
