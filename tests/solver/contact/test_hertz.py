"""Closed forms against printed reference numbers, and against numerical integration where the formula allows it.

References: NAFEMS R0094 benchmark 1 (external), the gear data of Yang et al. 2022 and He et al. (external), elasticity
integrals evaluated numerically (analytical).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad, trapezoid

from evolvent import hertz

STEEL = hertz.contact_modulus(210e3, 0.3, 210e3, 0.3)


def test_line_contact_of_the_nafems_cylinder() -> None:
    """Cylinder Ø 100 mm, E = 210 GPa, on a block E = 70 GPa, 35 kN/mm: a = 6.2146 mm, p0 = 3585.36 MPa."""
    modulus = hertz.contact_modulus(210e3, 0.3, 70e3, 0.3)
    assert modulus == pytest.approx(57692.3, abs=0.1)
    assert hertz.line_half_width(35e3, 50.0, modulus) == pytest.approx(6.2146, abs=5e-5)
    assert hertz.line_peak_pressure(35e3, 50.0, modulus) == pytest.approx(3585.36, abs=5e-3)


def test_rigid_and_flat_limits_of_modulus_and_radius() -> None:
    """A rigid plane has E = ∞ and R = ∞: only the other body counts."""
    assert hertz.contact_modulus(210e3, 0.3, math.inf, 0.3) == pytest.approx(210e3 / 0.91)
    assert hertz.relative_radius(50.0, math.inf) == 50.0
    assert hertz.relative_radius(10.0, -20.0) == pytest.approx(20.0)


def test_line_pressure_carries_the_load() -> None:
    """∫ p dx = F' for F' = 434 N/mm on R = 6.4 mm, and p = 0 outside the contact."""
    width, peak = hertz.line_half_width(434.0, 6.4, STEEL), hertz.line_peak_pressure(434.0, 6.4, STEEL)
    assert quad(hertz.line_pressure, -width, width, args=(width, peak))[0] == pytest.approx(434.0, rel=1e-8)
    assert hertz.line_pressure(np.array([1.001 * width]), width, peak)[0] == 0


def test_line_approach_is_the_integral_of_the_axis_strain() -> None:
    """δ(d) = −∫₀ᵈ ε_z dz with ε_z = (1−ν²)/E (σ_z − ν/(1−ν) σ_x), plane strain, d = 2000 b ≫ b."""
    modulus, poisson, load, width = 210e3, 0.3, 500.0, 0.2
    peak, depth = 2 * load / (math.pi * width), 2000 * width

    def strain(log_depth: float) -> float:
        ratio = math.exp(log_depth)
        stress = hertz.line_axis_stress(np.asarray(ratio), poisson)
        return -peak * (1 - poisson**2) / modulus * float(stress.depth - poisson / (1 - poisson) * stress.width) * ratio

    exact = width * quad(strain, math.log(1e-9), math.log(depth / width), limit=200)[0]
    assert hertz.line_approach(load, width, depth, modulus, poisson) == pytest.approx(exact, rel=1e-6)


def test_point_contact_formulas_agree_with_one_another() -> None:
    """a³ = 3PR/4E*, so that p0 = 3P/2πa², δ = a²/R: load of the pressure and p0 = 2E*a/πR agree."""
    contact = hertz.point_contact(100.0, 5.0, STEEL)
    assert contact.radius**3 == pytest.approx(3 * 100 * 5 / (4 * STEEL))
    assert contact.peak_pressure == pytest.approx(2 * STEEL * contact.radius / (math.pi * 5))
    assert contact.approach == pytest.approx(contact.radius**2 / 5)


@pytest.mark.parametrize("ratio", [1.0, 1.0 + 1e-9, 1.001, 2.0, 30.0, 1e4])
def test_elliptical_contact_solves_the_contact_equations(ratio: float) -> None:
    """u_z = δ − A x² − B y² inside the ellipse; u_z of the semi-ellipsoidal pressure is integrated numerically.

    Potential of an ellipsoid (Johnson 3.39): u_z = (p0 a b / 2E*) ∫₀^∞ (1 − x²/(a²+w) − y²/(b²+w)) dw/√((a²+w)(b²+w)w).
    """
    coefficient_a, load = 0.01, 300.0
    contact = hertz.elliptical_contact(load, coefficient_a, ratio * coefficient_a, STEEL)
    major, minor = contact.major, contact.minor

    def integral(power_a: int, power_b: int) -> float:
        def integrand(t: float) -> float:  # w = b² sinh²t takes the root singularity away
            w = (minor * math.sinh(t)) ** 2
            weight = 2 * minor * math.cosh(t) / math.sqrt((major**2 + w) * (minor**2 + w))
            return weight / ((major**2 + w) ** power_a * (minor**2 + w) ** power_b)

        return contact.peak_pressure * major * minor / (2 * STEEL) * quad(integrand, 0, 40, limit=400, epsrel=1e-11)[0]

    assert integral(0, 0) == pytest.approx(contact.approach, rel=1e-7)
    assert integral(1, 0) == pytest.approx(coefficient_a, rel=1e-7)
    assert integral(0, 1) == pytest.approx(ratio * coefficient_a, rel=1e-7)
    assert 2 / 3 * math.pi * contact.peak_pressure * major * minor == pytest.approx(load)


def test_elliptical_contact_of_a_sphere_is_the_point_contact() -> None:
    """A = B = 1/2R."""
    ellipse, circle = hertz.elliptical_contact(100.0, 0.1, 0.1, STEEL), hertz.point_contact(100.0, 5.0, STEEL)
    assert (ellipse.major, ellipse.minor) == pytest.approx((circle.radius, circle.radius))
    assert (ellipse.peak_pressure, ellipse.approach) == pytest.approx((circle.peak_pressure, circle.approach))


def test_elliptical_contact_refuses_exchanged_axes() -> None:
    """A must be the smaller coefficient; the message says so."""
    with pytest.raises(ValueError, match=r"0 < A <= B.*exchange the axes"):
        hertz.elliptical_contact(1.0, 2.0, 1.0, STEEL)


def test_subsurface_maxima_are_the_printed_ones() -> None:
    """Line: 0.30028 p0 at 0.78615 b, von Mises 0.5575 p0 at 0.704 b; sphere: 0.3100 p0 at 0.4809 a, edge tension."""
    assert hertz.line_largest_shear() == pytest.approx((0.30028, 0.78615), abs=5e-6)
    assert hertz.line_largest_mises(0.3) == pytest.approx((0.5575, 0.704), abs=5e-4)
    assert hertz.sphere_largest_shear(0.3) == pytest.approx((0.3100, 0.4809), abs=1e-4)
    assert hertz.sphere_edge_tension(0.3) == pytest.approx(0.4 / 3)


def test_cattaneo_traction_carries_the_force_and_keeps_the_law() -> None:
    """∫ q dx = Q and |q| ≤ μp everywhere, for Q/μP = 0, 0.36, 1; c/b = 0.8 at 0.36."""
    width, peak, friction = 0.2, 1000.0, 0.3
    normal = math.pi * width * peak / 2
    x = np.linspace(-width, width, 20001)
    for ratio in (0.0, 0.36, 1.0):
        shear = hertz.cattaneo_traction(x, width, friction, peak, ratio)
        assert trapezoid(shear, x) == pytest.approx(ratio * friction * normal, abs=1e-3)
        assert np.all(np.abs(shear) <= friction * hertz.line_pressure(x, width, peak) + 1e-9)
    assert hertz.stick_ratio_line(0.36) == pytest.approx(0.8)


def test_partial_slip_refuses_sliding() -> None:
    """Q > μP has no partial-slip solution."""
    with pytest.raises(ValueError, match=r"between 0 and 1, found 1\.2"):
        hertz.stick_ratio_sphere(1.2)


def test_mindlin_initial_stiffness_and_sliding_limit() -> None:
    """Q → 0: δ_x = Q Σ(2−ν)/G / 8a (full stick); Q = μP: δ_x = (3μP/16a) Σ(2−ν)/G."""
    compliance = 2 * 1.7 / 80e3
    small = hertz.mindlin_displacement(1000.0, 0.5, 0.2, 1e-6, compliance)
    assert small == pytest.approx(1e-6 * 0.2 * 1000 * compliance / (8 * 0.5), rel=1e-5)
    full = hertz.mindlin_displacement(1000.0, 0.5, 0.2, 1.0, compliance)
    assert full == pytest.approx(3 * 0.2 * 1000 / (16 * 0.5) * compliance)


def test_carter_creep_is_the_uniform_strain_of_the_stick_zone() -> None:
    """−(2/πE*) PV∫ q(s)/(x−s) ds = const = creep over the stick zone; b and p0 of the same R close the system.

    The principal value of √(c²−s²) over its own width is π(x − x_c), so the strain is elementary inside both ellipses.
    """
    line_load, radius, friction, ratio = 300.0, 8.0, 0.2, 0.5
    width, peak = hertz.line_half_width(line_load, radius, STEEL), hertz.line_peak_pressure(line_load, radius, STEEL)
    rolling = hertz.carter(width, radius, friction, ratio)

    def strain(x: float) -> float:
        def shear(s: float) -> float:
            stick = math.sqrt(max(0.0, rolling.stick_half_width**2 - (s - rolling.stick_centre) ** 2))
            return friction * peak / width * (math.sqrt(max(0.0, width**2 - s**2)) - stick)

        principal = quad(shear, -width, width, weight="cauchy", wvar=x, limit=400)[0]  # ∫ q/(s − x)
        return 2 / (math.pi * STEEL) * principal

    points = rolling.stick_centre + rolling.stick_half_width * np.array([-0.5, 0.0, 0.5])
    assert [strain(x) for x in points] == pytest.approx([-rolling.creep] * 3, rel=1e-5)


def test_line_contact_at_the_pitch_point_of_yang() -> None:
    """250 N·m, r_b1 = 19.1994 mm, β_b = 27.5402°: F_bn = 14685 N, 1579 MPa on the mean 33.81 mm, 1645 on 31.18 mm."""
    normal = 250e3 / 19.1994 / math.cos(math.radians(27.5402))
    assert normal == pytest.approx(14685, abs=0.5)
    working = math.tan(math.radians(20.7598))
    radius = hertz.relative_radius(19.1994 * working, 67.7626 * working) / math.cos(math.radians(27.5402))
    assert hertz.line_peak_pressure(normal / 33.81, radius, STEEL) == pytest.approx(1579, abs=0.5)
    assert hertz.line_peak_pressure(normal / 31.18, radius, STEEL) == pytest.approx(1645, abs=0.5)


def test_line_contact_at_the_pitch_point_of_he() -> None:
    """170 N·m, r_b = 70.4769 mm, 20°, 20 mm: F = 2412.1 N, p0 = 587.7 MPa, b = 0.1306 mm."""
    normal = 170e3 / 70.4769
    radius = 70.4769 * math.tan(math.radians(20)) / 2
    assert normal == pytest.approx(2412.1, abs=0.05)
    assert hertz.line_peak_pressure(normal / 20, radius, STEEL) == pytest.approx(587.7, abs=0.05)
    assert hertz.line_half_width(normal / 20, radius, STEEL) == pytest.approx(0.1306, abs=5e-5)
