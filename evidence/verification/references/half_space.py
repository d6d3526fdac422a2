"""Below an elliptical contact, on its axis: Boussinesq's point force integrated over Hertz' pressure.

Source: K. L. Johnson, *Contact Mechanics* (1985), Eq. 3.19 (stresses) and 3.22c (displacement). x runs along the
half-axis a, y along b, z into the half-space. For a = b the stresses are those of `hertz.sphere_axis_stress`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from evidence.verification.references.subsurface import mises, shear
from evolvent.contact.hertz import SubsurfaceMaximum
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Floats

POINTS = 64
"""In each direction of a quarter of the ellipse: 1e-9 from a depth of b/10 on."""


@dataclass(frozen=True)
class Ellipse:
    """An elliptical contact and the body below it.

    a, b:     half-axes [mm].
    peak:     Hertz' peak pressure [MPa].
    material: of the body.
    """

    a: float
    b: float
    peak: float
    material: Material

    def _points(self) -> tuple[Floats, Floats, Floats]:
        """x, y (q,) of the quarter x, y > 0, and the force (q,) on four points placed alike [N]."""
        nodes, weights = np.polynomial.legendre.leggauss(POINTS)
        w, dw = np.pi / 4 * (nodes + 1), np.pi / 4 * weights  # the radius is sin w: smooth where the pressure ends
        t = np.pi / 2 * (np.arange(POINTS) + 0.5) / POINTS
        x, y = self.a * np.outer(np.sin(w), np.cos(t)), self.b * np.outer(np.sin(w), np.sin(t))
        area = self.a * self.b * (np.sin(w) * np.cos(w) * dw)[:, None] * np.full(POINTS, 2 * np.pi / POINTS)
        return x.ravel(), y.ravel(), (self.peak * np.cos(w)[:, None] * area).ravel()

    def stress(self, depth: Floats) -> Floats:
        """Principal stresses (n, 3) along x, y, z [MPa] at depths (n,) > 0 [mm]."""
        x, y, P = self._points()
        z, ν = np.atleast_1d(depth)[:, None], self.material.poissons_ratio
        r2 = x**2 + y**2
        ρ = np.sqrt(r2 + z**2)

        def along(p2: Floats, q2: Floats) -> Floats:
            plane = (p2 - q2) / (r2 * ρ * (ρ + z)) + z * q2 / (r2 * ρ**3)
            return ((1 - 2 * ν) * plane - 3 * z * p2 / ρ**5) @ P / (2 * np.pi)

        vertical = (-3 * z**3 / ρ**5) @ P / (2 * np.pi)
        return np.stack([along(x**2, y**2), along(y**2, x**2), vertical], axis=1)

    def sinking(self, depth: float) -> float:
        """Displacement [mm] into the half-space of the point at this depth [mm], 0 at infinity."""
        x, y, P = self._points()
        ν = self.material.poissons_ratio
        ρ = np.sqrt(x**2 + y**2 + depth**2)
        unit = depth**2 / ρ**3 + 2 * (1 - ν) / ρ
        return float((1 + ν) / (2 * np.pi * self.material.youngs_modulus) * unit @ P)

    def largest_shear(self) -> SubsurfaceMaximum:
        """τ/p0 and its depth/b."""
        return self._largest(shear)

    def largest_mises(self) -> SubsurfaceMaximum:
        """σ_vM/p0 and its depth/b."""
        return self._largest(mises)

    def _largest(self, measure: Callable[[Floats], Floats]) -> SubsurfaceMaximum:
        def negative(depth: float) -> float:
            return -float(measure(self.stress(np.array([depth * self.b])))[0]) / self.peak

        largest = minimize_scalar(negative, bounds=(0.1, 2.0), method="bounded", options={"xatol": 1e-8})
        return SubsurfaceMaximum(-float(largest.fun), float(largest.x))
