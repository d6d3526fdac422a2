"""Closed forms of contact mechanics: estimates for scenes, and exact solutions for tests.

Sources: K. L. Johnson, *Contact Mechanics* (1985), equation numbers as given below.
Units: N, mm, MPa (N/mm²). The formulas of the line contact take numbers or arrays that broadcast.

All use the contact modulus 1/E* = (1 − ν1²)/E1 + (1 − ν2²)/E2 and the relative curvature 1/R = 1/R1 + 1/R2. A steel
cylinder of 50 mm radius under 1000 N/mm on a plane:

>>> from evolvent import hertz
>>> modulus = hertz.contact_modulus(210e3, 0.3, 210e3, 0.3)
>>> print(f"{hertz.line_half_width(1000.0, 50.0, modulus):.3f} mm")
0.743 mm
>>> print(f"{hertz.line_peak_pressure(1000.0, 50.0, modulus):.0f} MPa")
857 MPa
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi, sqrt
from typing import NamedTuple, TypeVar

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import ellipe, ellipk, elliprd

from evolvent_meshes.arrays import Floats

Value = TypeVar("Value", float, Floats)

GOLDEN = (1 + sqrt(5)) / 2
"""The golden ratio."""


def contact_modulus(modulus1: float, poisson1: float, modulus2: float, poisson2: float) -> float:
    """E* [MPa] of two elastic bodies; pass `math.inf` as a modulus for a rigid one."""
    return 1 / ((1 - poisson1**2) / modulus1 + (1 - poisson2**2) / modulus2)


def relative_radius(radius1: Value, radius2: Value) -> Value:
    """R [mm] with 1/R = 1/R1 + 1/R2; a concave side has a negative radius, a flat one `math.inf`."""
    return 1 / (1 / radius1 + 1 / radius2)


# --- line contact: two cylinders, load F' per length ---------------------------------------------------------------


def line_half_width(line_load: Value | float, radius: Value, modulus: float) -> Value:
    """Half-width of a line contact b = √(4 F' R / π E*) [mm] (Johnson 4.43). line_load F' [N/mm], radius R [mm],
    modulus E* [MPa]."""
    return np.sqrt(4 * line_load * radius / (pi * modulus))


def line_peak_pressure(line_load: Value | float, radius: Value, modulus: float) -> Value:
    """Peak pressure of a line contact p0 = √(F' E* / π R) = 2 F' / π b [MPa] (Johnson 4.45)."""
    return np.sqrt(line_load * modulus / (pi * radius))


def line_pressure(x: Value, half_width: float, peak: float) -> Value:
    """Pressure of a line contact p(x) = p0 √(1 − x²/b²), zero outside |x| < b [MPa] (Johnson 4.44)."""
    return peak * np.sqrt(np.maximum(0.0, 1 - (x / half_width) ** 2))


def line_approach(line_load: float, half_width: float, depth: float, modulus: float, poisson: float) -> float:
    """Compression [mm] of one body between the contact centre and the depth d ≫ b below it (Johnson 5.58).

    δ = F' (1 − ν²)/(π E) [2 ln(2 d/b) − ν/(1 − ν)], plane strain. Unlike in point contact, the approach of two
    cylinders grows without bound with the depth d of the point that is held.
    """
    logarithm = 2 * np.log(2 * depth / half_width) - poisson / (1 - poisson)
    return line_load * (1 - poisson**2) / (pi * modulus) * logarithm


# --- point and elliptical contact ----------------------------------------------------------------------------------


class PointContact(NamedTuple):
    """Circular contact.

    radius: a of the contact [mm].
    peak_pressure: p0 [MPa].
    approach: δ [mm].
    """

    radius: float
    peak_pressure: float
    approach: float


def point_contact(load: float, radius: float, modulus: float) -> PointContact:
    """Sphere on sphere: a³ = 3PR/4E*, p0 = 3P/2πa², δ = a²/R (Johnson 4.22-4.24). load P [N]."""
    a = np.cbrt(3 * load * radius / (4 * modulus))
    return PointContact(a, 3 * load / (2 * pi * a**2), a**2 / radius)


class EllipticalContact(NamedTuple):
    """Elliptical contact.

    major: half axis a [mm].
    minor: half axis b <= a [mm].
    peak_pressure: p0 [MPa].
    approach: δ [mm].
    """

    major: float
    minor: float
    peak_pressure: float
    approach: float


def elliptical_contact(load: float, curvature_a: float, curvature_b: float, modulus: float) -> EllipticalContact:
    """Contact of two bodies with the gap A x² + B y², 0 < A ≤ B [1/mm] (Johnson, section 4.2).

    The shape m = e² = 1 − b²/a² solves B/A = R_D(0, 1, 1−m)/R_D(0, 1−m, 1), which is Johnson's ratio of
    complete elliptic integrals written with Carlson's R_D so that it neither cancels nor divides by zero at A = B.
    The size follows from A + B = p0 E(m)/(E* b) and P = ⅔ π p0 a b.

    Raises ValueError unless 0 < A ≤ B.
    """
    if not 0 < curvature_a <= curvature_b:
        raise ValueError(
            f"elliptical_contact wants gap coefficients 0 < A <= B, found A = {curvature_a:g}, B = {curvature_b:g}; "
            "exchange the axes, or use the line contact for A = 0"
        )
    shape = _ellipse_shape(curvature_b / curvature_a)
    total = curvature_a + curvature_b
    major = np.cbrt(3 * load * ellipe(shape) / (2 * pi * modulus * total * (1 - shape)))
    minor = major * sqrt(1 - shape)
    peak = 3 * load / (2 * pi * major * minor)
    return EllipticalContact(major, minor, peak, peak * minor * ellipk(shape) / modulus)


def _ellipse_shape(ratio: float) -> float:
    """Shape m = 1 − b²/a² for B/A = ratio ≥ 1."""
    if ratio == 1:
        return 0.0

    def residual(log_axis_ratio: float) -> float:
        square = np.exp(-2 * log_axis_ratio)
        return np.log(elliprd(0.0, 1.0, square) / elliprd(0.0, square, 1.0) / ratio)

    # b/a lies between (A/B)^⅔ and 1 (Johnson, fig. 4.4); wide bounds cost two or three more steps
    return 1 - np.exp(-2 * brentq(residual, 0.0, np.log(ratio) + 1, xtol=1e-14, rtol=1e-14))


# --- below the surface ---------------------------------------------------------------------------------------------


class SubsurfaceMaximum(NamedTuple):
    """Maximum of a stress below the surface.

    value: over p0.
    depth: over the half-width (or radius) of the contact.
    """

    value: float
    depth: float


class AxisStress(NamedTuple):
    """Principal stresses on the axis of the contact, over p0.

    width: along the width of the contact.
    line: along its line.
    depth: normal to the surface.
    """

    width: Floats
    line: Floats
    depth: Floats


def line_axis_stress(depth: Floats, poisson: float) -> AxisStress:
    """Stresses of a frictionless line contact at depth z/b below its centre, plane strain (Johnson 4.46)."""
    root = np.sqrt(1 + depth**2)
    width, vertical = -((1 + 2 * depth**2) / root - 2 * depth), -1 / root
    return AxisStress(width, poisson * (width + vertical), vertical)


def sphere_axis_stress(depth: Floats, poisson: float) -> AxisStress:
    """Stresses of a frictionless sphere contact at depth z/a below its centre (Johnson 3.45)."""
    half = 0.5 / (1 + depth**2)
    radial = -(1 + poisson) * (1 - depth * np.arctan2(1.0, depth)) + half
    return AxisStress(radial, radial, -2 * half)


def line_largest_shear() -> SubsurfaceMaximum:
    """Largest shear stress below a line contact and its depth, 0.30028 p0 at 0.78615 b: exactly φ^(−5/2) at φ^(−1/2)
    with the golden ratio φ."""
    return SubsurfaceMaximum(GOLDEN**-2.5, GOLDEN**-0.5)


def line_largest_mises(poisson: float) -> SubsurfaceMaximum:
    """Largest von Mises stress below a line contact: 0.5575 p0 at 0.704 b for ν = 0.3."""
    return _largest(lambda depth: _mises(line_axis_stress(depth, poisson)))


def sphere_largest_shear(poisson: float) -> SubsurfaceMaximum:
    """Largest shear stress below a sphere: 0.3100 p0 at 0.4809 a for ν = 0.3."""

    def shear(depth: Floats) -> Floats:
        stress = sphere_axis_stress(depth, poisson)
        return 0.5 * np.abs(stress.width - stress.depth)

    return _largest(shear)


def sphere_edge_tension(poisson: float) -> float:
    """Largest tension, radial at the edge of the circle: (1 − 2ν)/3 of p0 (Johnson, section 3.4)."""
    return (1 - 2 * poisson) / 3


def _mises(stress: AxisStress) -> Floats:
    first, second, third = stress
    return np.sqrt(0.5 * ((first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2))


def _largest(function: Callable[[Floats], Floats]) -> SubsurfaceMaximum:
    options = {"xatol": 1e-10}
    result = minimize_scalar(lambda depth: -function(depth), bounds=(1e-6, 3.0), method="bounded", options=options)
    return SubsurfaceMaximum(float(-result.fun), float(result.x))


# --- friction ------------------------------------------------------------------------------------------------------


def stick_ratio_line(load_ratio: float) -> float:
    """Half-width of stick over that of contact c/b = √(1 − Q/μP) of a line contact pushed sideways with Q < μP
    (Cattaneo; Johnson, section 7.2)."""
    return sqrt(1 - _partial(load_ratio))


def cattaneo_traction(x: Floats, half_width: float, friction: float, peak: float, load_ratio: float) -> Floats:
    """Shear traction [MPa] q = μp0[√(1−x²/b²) − (c/b)√(1−x²/c²)] in partial slip (Johnson, section 7.2).

    x: positions across the contact [mm], any shape; load_ratio: Q/μP, from 0 to 1.
    """
    stick = stick_ratio_line(load_ratio)
    slip = line_pressure(x, half_width, peak)
    if stick == 0:
        return friction * slip
    return friction * (slip - stick * line_pressure(x, stick * half_width, peak))


def stick_ratio_sphere(load_ratio: float) -> float:
    """Radius of stick over that of contact c/a = (1 − Q/μP)^⅓ of a sphere contact pushed sideways (Mindlin; Johnson,
    section 7.2)."""
    return (1 - _partial(load_ratio)) ** (1 / 3)


def mindlin_displacement(load: float, radius: float, friction: float, load_ratio: float, compliance: float) -> float:
    """Sideways shift [mm] δ_x = (3μP/16a)[Σ(2−ν)/G][1−(1−Q/μP)^⅔] of a sphere contact (Johnson, section 7.2).

    load P [N], radius a of the contact [mm], compliance Σ(2−ν)/G over both bodies [1/MPa].
    """
    return 3 * friction * load / (16 * radius) * compliance * (1 - (1 - _partial(load_ratio)) ** (2 / 3))


class Rolling(NamedTuple):
    """Tractive rolling of cylinders.

    stick_half_width: c of the stick zone [mm].
    stick_centre: distance of its centre ahead of the contact centre [mm].
    creep: absolute value [-].
    """

    stick_half_width: float
    stick_centre: float
    creep: float


def carter(half_width: float, radius: float, friction: float, load_ratio: float) -> Rolling:
    """Elastically similar cylinders rolling with traction Q: c = b√(1−Q/μP) at the leading edge (Johnson, section 8.3).

    radius: the relative radius R [mm]; the creep is μ(b − c)/R.
    """
    stick = half_width * stick_ratio_line(load_ratio)
    return Rolling(stick, half_width - stick, friction * (half_width - stick) / radius)


def _partial(load_ratio: float) -> float:
    if not 0 <= load_ratio <= 1:
        raise ValueError(f"partial slip wants Q/(μP) between 0 and 1, found {load_ratio:g}; above 1 the bodies slide")
    return load_ratio
