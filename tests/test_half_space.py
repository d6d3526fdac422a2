"""Stresses and displacement below an elliptical contact, integrated, against what is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.ladder.half_space import Ellipse
from solver import hertz
from solver.material import STEEL

MODULUS = STEEL.plane_modulus / 2


def test_circle():
    """a = b: the stresses of Johnson 3.45 at all depths from a/10 on, to 1e-9 p0, and its largest shear."""
    depth = np.array([0.1, 0.3, 0.48, 1.0, 3.0])
    found = Ellipse(2.0, 2.0, 500.0, STEEL).stress(2.0 * depth) / 500.0
    exact = hertz.sphere_axis_stress(depth, 0.3)
    assert np.allclose(found, np.stack([exact.width, exact.line, exact.depth], axis=1), atol=1e-9)
    assert Ellipse(2.0, 2.0, 500.0, STEEL).largest_shear() == pytest.approx(hertz.sphere_largest_shear(0.3), rel=1e-6)


@pytest.mark.parametrize(
    ("ratio", "shear", "depth"), [(0.2, 0.322, 0.745), (0.4, 0.325, 0.665), (0.6, 0.323, 0.590), (0.8, 0.317, 0.530)]
)
def test_largest_shear_of_ellipses(ratio, shear, depth):
    """Johnson 1985, table 4.1: τ/p0 within 0.5 % and z/b within 1 % of the printed values for ellipses b/a."""
    found = Ellipse(1.0 / ratio, 1.0, 100.0, STEEL).largest_shear()
    assert found.value == pytest.approx(shear, rel=0.005)
    assert found.depth == pytest.approx(depth, rel=0.01)


@pytest.mark.parametrize("curvature", [0.01, 0.03])
def test_sinking_is_half_of_the_approach(curvature):
    """Two equal half-spaces share δ of the ellipse (Johnson, section 4.2); far below, a point force's displacement is
    left: P(1 + ν)(3 − 2ν)/(2πE z) on its axis."""
    contact = hertz.elliptical_contact(1000.0, 0.01, curvature, MODULUS)
    ellipse = Ellipse(contact.major, contact.minor, contact.peak_pressure, STEEL)
    assert 2 * ellipse.sinking(0.0) == pytest.approx(contact.approach, rel=1e-9)
    far = 1e4
    assert ellipse.sinking(far) == pytest.approx(1000.0 * 1.3 * 2.4 / (2 * np.pi * 210e3 * far), rel=1e-6)
