"""The Hertz estimate of Yang et al. 2022 with the gear data printed there."""

from __future__ import annotations

import math

import pytest

from evidence.pages.papers.yang_estimate import LoadFactors, yang_estimate
from evolvent import hertz

STEEL = hertz.contact_modulus(210e3, 0.3, 210e3, 0.3)


def estimate(factors: LoadFactors) -> float:
    """Yang et al. 2022, Eq. 4, for the helical pair under 250 N·m [MPa]."""
    return yang_estimate(
        torque=250e3,
        face_width=16.9,
        reference_diameter=40.818,
        contact_ratio=1.7740,
        teeth_ratio=60 / 17,
        base_helix=math.radians(27.5402),
        pressure_angle=math.radians(19.8241),
        modulus=STEEL,
        factors=factors,
    )


def test_yang_estimate_is_the_printed_stress() -> None:
    """2390.6 MPa with the printed factors 1.25·1.293·1.1·1.2257, 1619.4 MPa without."""
    assert estimate(LoadFactors()) == pytest.approx(2390.6, abs=0.05)
    assert estimate(LoadFactors.none()) == pytest.approx(1619.4, abs=0.05)
    assert LoadFactors().product == pytest.approx(2.1792, abs=1e-4)
