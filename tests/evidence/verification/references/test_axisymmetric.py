"""Signorini's problem in the section of a round body, the reference solution of the half-spheres."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.verification.references.axisymmetric import pressed_on_plane, sphere_section
from evolvent.contact import hertz
from evolvent.fem.material import STEEL


def test_small_axisymmetric_contact_is_hertz() -> None:
    """A sphere of 10 mm, cut off 8 mm from the contact, a/R = 0.025: two of them, each on the plane between both, have
    Hertz' p0 for R = 5 mm and E*/2 under the force found, within 0.3 %; the pressure carries the force."""
    a = 0.25
    force, r, pressure = pressed_on_plane(sphere_section(10.0, 8.0, 8.5, a, 8), STEEL, a**2 / 10.0)
    exact = hertz.point_contact(force, 5.0, 0.5 * STEEL.plane_modulus)
    inner = r < 0.7 * exact.radius
    top = np.polyfit(r[inner] ** 2, pressure[inner] ** 2, 1)[1]
    assert np.sqrt(top) == pytest.approx(exact.peak_pressure, rel=3e-3)
    own = pressure[:-2:2] * r[:-2:2], pressure[1:-1:2] * r[1:-1:2], pressure[2::2] * r[2::2]
    simpson = np.sum((own[0] + 4.0 * own[1] + own[2]) * (r[2::2] - r[:-2:2])) / 6.0
    assert 2.0 * np.pi * simpson == pytest.approx(force, rel=5e-3)
