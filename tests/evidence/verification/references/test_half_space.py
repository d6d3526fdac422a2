"""Stresses and displacement below an elliptical contact, integrated, against what is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ellipeinc, ellipkinc

from evidence.verification.references.half_space import Ellipse
from evolvent.contact import hertz
from evolvent.fem.material import STEEL

MODULUS = STEEL.plane_modulus / 2
DEPTH = np.array([0.1, 0.3, 0.48, 1.0, 3.0])


def test_stress_below_a_circular_contact_is_that_of_johnson() -> None:
    """a = b: the stresses of Johnson 3.45 at all depths from a/10 on, to 1e-9 p0, and its largest shear."""
    found = Ellipse(2.0, 2.0, 500.0, STEEL).stress(2.0 * DEPTH) / 500.0
    exact = hertz.sphere_axis_stress(DEPTH, 0.3)
    assert np.allclose(found, np.stack([exact.width, exact.line, exact.depth], axis=1), atol=1e-9)
    assert Ellipse(2.0, 2.0, 500.0, STEEL).largest_shear() == pytest.approx(hertz.sphere_largest_shear(0.3), rel=1e-6)


@pytest.mark.parametrize("k", [0.2, 0.4, 0.6, 0.8])
def test_stress_below_an_elliptical_contact_is_that_of_thomas_and_hoersch(k: float) -> None:
    """b/a = k: Thomas & Hoersch 1930, as in Boresi & Schmidt, *Advanced Mechanics of Materials*, with F and H the
    incomplete elliptic integrals of modulus k' = √(1 − k²) and amplitude arccot(kz/b); to 1e-6 p0 from b/10 on."""
    ν, m, s = 0.3, 1 - k**2, k * DEPTH
    n = np.sqrt((k**2 + s**2) / (1 + s**2))
    F, H = (integral(np.arctan2(1.0, s), m) for integral in (ellipkinc, ellipeinc))
    x = -(1 - n) / 2 + s * (F - H) + ν * (1 - n / k**2 + s * (H / k**2 - F))
    y = 1 / (2 * n) + 1 / 2 - n / k**2 + s * (H / k**2 - F) + ν * (n - 1 + s * (F - H))
    z = -(1 / n - n) / 2
    exact = 2 * k / m * np.stack([x, y, z], axis=1)
    found = Ellipse(1.0 / k, 1.0, 1.0, STEEL).stress(DEPTH)
    assert np.allclose(found, exact, atol=1e-6)


@pytest.mark.parametrize("curvature", [0.01, 0.03])
def test_sinking_is_half_of_the_approach(curvature: float) -> None:
    """Two equal half-spaces share δ of the ellipse (Johnson, section 4.2); far below, a point force's displacement is
    left: P(1 + ν)(3 − 2ν)/(2πE z) on its axis."""
    contact = hertz.elliptical_contact(1000.0, 0.01, curvature, MODULUS)
    ellipse = Ellipse(contact.major, contact.minor, contact.peak_pressure, STEEL)
    assert 2 * ellipse.sinking(0.0) == pytest.approx(contact.approach, rel=1e-9)
    far = 1e4
    assert ellipse.sinking(far) == pytest.approx(1000.0 * 1.3 * 2.4 / (2 * np.pi * 210e3 * far), rel=1e-6)
