"""Tooth thickness allowances: thinner teeth, the backlash that follows, and the rack that cuts them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.gears.flank import Flank, nominal_angles
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile, mirror
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.sector_cases import COARSE, nodes_of
from tests.support.paper_pairs import he, yang, zhang

ALLOWANCES = -70.0, -50.0


def thinner(pair: GearPair) -> GearPair:
    """The pair with ALLOWANCES, roots as they were."""
    pinion, wheel = (
        replace(gear, tooth_thickness_allowance_um=allowance) for gear, allowance in zip(pair.gears, ALLOWANCES)
    )
    return replace(pair, pinion=pinion, wheel=wheel)


def from_rack(allowance: float) -> GearParameters:
    """A helical gear whose root the rack cuts."""
    return GearParameters.from_rack(
        z=25, normal_module=2.0, normal_pressure_angle_deg=20.0, helix_angle_deg=18.0, profile_shift=0.2,
        tooth_thickness_allowance_um=allowance, face_width=10.0, bore_diameter=20.0,
    )


@pytest.mark.parametrize("pair", [yang(), he(), zhang()], ids=["Yang", "He", "Zhang"])
def test_backlash_is_that_of_the_allowances(pair: GearPair) -> None:
    """A_sn thins the tooth by A_sn d_w/(z m_n) on the working pitch circle and opens the flanks by A_sn cos α_n along
    their normals, at any centre distance: j_bn grows by 120 µm · cos α_n."""
    grown = thinner(pair).normal_backlash - pair.normal_backlash
    assert grown == pytest.approx(0.12 * math.cos(pair.pinion.normal_pressure_angle), rel=1e-9)


def test_loaded_flanks_stay_at_the_pitch_point() -> None:
    """Half of the allowance is on the loaded flank: the frame of each gear turns so that at φ = 0 the flanks of thin
    teeth touch at the pitch point, too."""
    pair = thinner(yang())
    for gear, radius, centre, frame in zip(
        pair.gears, pair.working_pitch_diameters, (0.0, pair.centre_distance), nominal_angles(pair, 0.0)
    ):
        x, y = Profile(gear).involute(radius / 2.0)
        turned = np.array([np.cos(frame) * x - np.sin(frame) * y, np.sin(frame) * x + np.cos(frame) * y])
        assert turned + np.array([centre, 0.0]) == pytest.approx([pair.working_pitch_diameters[0] / 2.0, 0.0], abs=1e-9)


def test_rack_cuts_deeper() -> None:
    """The rack is pushed in by A_sn/(2 tan α_n): 100 µm less tooth thickness are 274.75 µm less root diameter; the
    coefficients of the rack are as given, and the tip is where it was."""
    plain, thin = from_rack(0.0), from_rack(-100.0)
    assert plain.root_diameter - thin.root_diameter == pytest.approx(0.1 / math.tan(math.radians(20.0)), abs=1e-12)
    assert (thin.dedendum_coefficient, thin.tip_diameter) == pytest.approx((1.25, plain.tip_diameter), abs=1e-12)
    lost = plain.normal_thickness(plain.reference_diameter) - thin.normal_thickness(thin.reference_diameter)
    assert lost == pytest.approx(0.1, abs=1e-12)


def test_both_flanks_of_the_mesh_are_exact() -> None:
    """A sector's nodes: both flanks lie A_sn cos α_n/2 inside those of full thickness, within 1e-9 mm; the fillet
    begins on the flank and ends on the root circle."""
    plain, thin = (from_rack(allowance) for allowance in (0.0, -100.0))
    mesh = sector_mesh(thin, COARSE)
    flank, back = nodes_of(mesh, "flank"), nodes_of(mesh, "back")
    inside = 0.05 * math.cos(thin.normal_pressure_angle)
    np.testing.assert_allclose(Flank(plain).distance(flank), -inside, atol=1e-9)
    above = back[np.hypot(back[:, 0], back[:, 1]) > thin.root_form_diameter / 2.0]
    turned_back = np.column_stack([mirror(above[:, :2]), -above[:, 2]])  # the mirrored flank has the mirrored helix
    np.testing.assert_allclose(Flank(plain).distance(turned_back), -inside, atol=1e-9)
    fillet = Profile(thin).fillet(np.array([0.0, 1.0]))
    assert np.hypot(*fillet[0]) == pytest.approx(thin.root_diameter / 2.0, abs=1e-9)
    assert fillet[1] == pytest.approx(Profile(thin).involute(thin.root_form_diameter / 2.0), abs=1e-9)
