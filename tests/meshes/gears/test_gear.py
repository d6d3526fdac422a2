"""A gear from the coefficients of its rack."""

from __future__ import annotations

import math

import pytest

from evolvent_meshes.gears.gear import GearParameters, usual_rack_tip_radius


def test_rack_coefficients_and_diameters_agree() -> None:
    """A gear from rack coefficients has the textbook diameters and gives the coefficients back."""
    gear = GearParameters.from_rack(
        z=30, normal_module=2.0, normal_pressure_angle_deg=20.0, profile_shift=0.2, face_width=10.0, bore_diameter=20.0
    )
    assert (gear.tip_diameter, gear.root_diameter, gear.rack_tip_radius) == pytest.approx((64.8, 55.8, 0.76))
    assert (gear.tip_coefficient, gear.dedendum_coefficient) == pytest.approx((1.0, 1.25))
    assert gear.root_form_diameter < gear.reference_diameter


@pytest.mark.parametrize(
    ("angle", "dedendum", "exact"), [(20.0, 1.25, 0.38), (20.0, 1.5, 0.34196), (28.0, 1.25, 0.20098), (20.0, 3.0, 0.0)]
)
def test_usual_tip_radius_of_the_rack(angle: float, dedendum: float, exact: float) -> None:
    """ISO 53, profile A: 0.38 modules, or less where the rack's tip is narrow. Exact: an arc that touches the flank and
    the tip line, of half-width s = π/4 − h_fP* tan α, has ρ = s tan(45° + α/2); a tip of no width has no radius."""
    assert usual_rack_tip_radius(2.0, math.radians(angle), dedendum) == pytest.approx(2.0 * exact, rel=2e-5)
