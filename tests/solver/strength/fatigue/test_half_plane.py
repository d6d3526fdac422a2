"""Stress below line contacts, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.strength.fatigue.criteria import largest_shear, von_mises
from evolvent.strength.fatigue.half_plane import HertzTractions, LineForces, plane_strain
from evolvent_meshes.arrays import Floats

B, PEAK = 0.4, 1500.0  # mm, MPa


def sliding_line(x: Floats, z: Floats, μ: float) -> Floats:
    """σ_x, σ_z, τ_xz (k, 3) below Hertz' half-ellipse of pressure with q = μp on the body (Johnson 1985, Eqs 4.49 and
    7.8; M'Ewen 1949): m and n are the half-axes of the confocal ellipse through the place."""
    s = B**2 - x**2 + z**2
    root = np.sqrt(s**2 + 4.0 * x**2 * z**2)
    m, n = np.sqrt(0.5 * (root + s)), np.sign(x) * np.sqrt(np.maximum(0.5 * (root - s), 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = (z**2 + n**2) / (m**2 + n**2)
        slope = (m**2 - z**2) / (m**2 + n**2)
    normal = -PEAK / B * np.stack([m * (1.0 + ratio) - 2.0 * z, m * (1.0 - ratio), n * slope], axis=1)
    dragged = PEAK / B * (n * (2.0 + slope) - 2.0 * x)
    return normal + μ * np.stack([dragged, normal[:, 2], normal[:, 0]], axis=1)


@pytest.mark.parametrize("μ", [0.0, 0.132])
def test_below_a_sliding_line_contact(μ: float) -> None:
    """Half-ellipse of pressure that slides: all components at a grid of places from 0.02 b to 4 b deep, to 1e-9 of
    p0."""
    grid = np.meshgrid(np.linspace(-3.0, 3.0, 25) * B + 1e-3, np.geomspace(0.02, 4.0, 12) * B)
    x, z = (each.ravel() for each in grid)
    found = HertzTractions(B, PEAK, μ).stress(x, z)
    assert np.abs(found - sliding_line(x, z, μ)).max() < 1e-9 * PEAK


def test_largest_stresses_below_a_line_contact() -> None:
    """Without friction: largest shear 0.30028 p0 at 0.78615 b, von Mises (ν = 0.3) 0.5575 p0 at 0.704 b."""
    z = np.linspace(0.5, 1.0, 1001) * B
    stress = plane_strain(HertzTractions(B, PEAK, 0.0).stress(np.zeros_like(z), z), 0.3)
    shear, mises = largest_shear(stress) / PEAK, von_mises(stress) / PEAK
    assert (shear.max(), z[np.argmax(shear)] / B) == pytest.approx((0.30028, 0.78615), rel=1e-3)
    assert (mises.max(), z[np.argmax(mises)] / B) == pytest.approx((0.5575, 0.704), rel=2e-3)


def test_tension_at_the_trailing_edge() -> None:
    """The body is dragged towards +x: behind the contact, at x = −b, its surface has tension 2μp0 (Johnson, 7.1.1), as
    much compression ahead of it, and −p0 at its middle."""
    μ = 0.2
    loads = HertzTractions(B, PEAK, μ)
    σ = loads.stress(np.array([-B, B, 0.0]), np.zeros(3))
    assert σ[0, 0] == pytest.approx(2.0 * μ * PEAK, rel=2e-3)
    assert σ[1, 0] == pytest.approx(-2.0 * μ * PEAK, rel=2e-3)
    assert σ[2] == pytest.approx([-PEAK, -PEAK, -μ * PEAK], rel=1e-4)


@pytest.mark.parametrize("points", [12, 24])
def test_forces_at_quadrature_points(points: int) -> None:
    """The half-ellipse that slides as forces at Gauss points: stress from 0.6 b on to 1e-2 of p0 with 12 points across
    the contact, 1e-5 with 24."""
    s, w = np.polynomial.legendre.leggauss(points)
    force = PEAK * np.sqrt(1.0 - s**2) * B * w
    x, z = (each.ravel() for each in np.meshgrid(np.linspace(-1.5, 1.5, 25) * B, np.linspace(0.6, 2.0, 8) * B))
    found = LineForces(B * s, force, 0.1 * force).stress(x, z)
    bar = {12: 1e-2, 24: 1e-3}[points]
    assert np.abs(found - HertzTractions(B, PEAK, 0.1).stress(x, z)).max() < bar * PEAK
