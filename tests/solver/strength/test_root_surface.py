"""The root of a sector's mesh: where it lies, and the angles of its profile."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.meshing.root_meshes import with_back_root
from evolvent.strength.root_surface import compression_side, tension_side
from evolvent.strength.standard.critical_section import root_section
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh


def gear(helix_angle: float = 0.0) -> GearParameters:
    return GearParameters.from_rack(
        z=33, normal_module=2.3, normal_pressure_angle_deg=18.0, profile_shift=0.3, rack_tip_radius_coefficient=0.2,
        face_width=10.0, bore_diameter=30.0, helix_angle_deg=helix_angle,
    )


def test_profile_is_at_30_degrees_at_the_critical_section() -> None:
    """The radius at which the tangent is at 30°, between the nodes of a fine fillet, is that of the standard's critical
    section, 2e-3; on the root circle the tangent is at 90° less the place's own angle, 1°."""
    own = gear()
    fine = SectorResolution(profile_elements=12, face_elements=2, fillet_elements=60, back_elements=60)
    root = tension_side(sector_mesh(own, fine, "quadrilateral"), own)
    order = np.argsort(root.tangent_angles)
    radius = float(np.interp(np.radians(30.0), root.tangent_angles[order], root.radii[order]))
    lowest = root.radii < root.radii.min() * (1.0 + 1e-6)
    place = np.arctan2(root.surface.points[lowest, 1], root.surface.points[lowest, 0])
    section = root_section(own)
    assert radius == pytest.approx(np.hypot(section.height, 0.5 * section.chord), rel=2e-3)
    assert np.degrees(root.tangent_angles[lowest]) == pytest.approx(90.0 - np.degrees(place), abs=1.0)


@pytest.mark.parametrize("helix_angle", [0.0, 20.0])
def test_both_sides_are_mirror_images(helix_angle: float) -> None:
    """As high on the back as on the loaded side; the largest angle of the profile is the same on both, within what six
    and five elements make of it, 2.5°."""
    own = gear(helix_angle)
    mesh = with_back_root(sector_mesh(own, SectorResolution(profile_elements=12, face_elements=2)))
    tension, compression = tension_side(mesh, own), compression_side(mesh, own)
    assert compression.radii.max() <= tension.radii.max() * (1.0 + 1e-9)
    assert compression.radii.min() == pytest.approx(tension.radii.min(), rel=1e-9)
    assert compression.tangent_angles.max() == pytest.approx(tension.tangent_angles.max(), abs=0.044)
    assert set(tension.surface.nodes).isdisjoint(set(compression.surface.nodes))
    assert len(np.unique(tension.heights)) == 5


@pytest.mark.parametrize("teeth", [17, 90])
def test_fillet_is_deep_enough_for_bending(teeth: int) -> None:
    """Nodes count whose tangent is at 20° and more, none of the flank: on 17 teeth four below the root form circle do
    not, where the neck's tangent is at 2 to 16°; on 90 teeth, whose fillets begin at 15°, one."""
    own = GearParameters.from_rack(
        z=teeth, normal_module=2.0, normal_pressure_angle_deg=20.0, rack_tip_radius_coefficient=0.3, face_width=10.0,
        bore_diameter=10.0,
    )
    fine = SectorResolution(profile_elements=12, face_elements=2, fillet_elements=40, back_elements=40)
    root = tension_side(sector_mesh(own, fine, "quadrilateral"), own)
    angles, counted = np.degrees(root.tangent_angles), root.is_fillet
    assert counted[(angles > 22.0) & (2.0 * root.radii < 0.999 * own.root_form_diameter)].all()
    assert not counted[(angles < 20.0) | (2.0 * root.radii > own.root_form_diameter * 1.0001)].any()
    left_out = (~counted & (2.0 * root.radii < own.root_form_diameter * (1.0 - 1e-6))).sum()
    assert left_out == (4 if teeth == 17 else 1)
