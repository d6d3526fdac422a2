"""A gear from the coefficients of its rack."""

from __future__ import annotations

import pytest

from evolvent_meshes.gears.gear import GearParameters


def test_rack_coefficients_and_diameters_agree() -> None:
    """A gear from rack coefficients has the textbook diameters and gives the coefficients back."""
    gear = GearParameters.from_rack(
        z=30, normal_module=2.0, normal_pressure_angle_deg=20.0, profile_shift=0.2, face_width=10.0, bore_diameter=20.0
    )
    assert (gear.tip_diameter, gear.root_diameter, gear.rack_tip_radius) == pytest.approx((64.8, 55.8, 0.5))
    assert (gear.tip_coefficient, gear.dedendum_coefficient) == pytest.approx((1.0, 1.25))
    assert gear.root_form_diameter < gear.reference_diameter
