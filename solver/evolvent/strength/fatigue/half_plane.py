"""Stress in an elastic half-plane under pressure and friction on its surface, in plane strain.

With w = x − t + iz, a normal force P into the body and a tangential one Q towards +x at t cause (Johnson, Contact
Mechanics, 1985, 2.2 and 2.3)

    σ_x = −P/π [z Re w⁻² − Im w⁻¹] − Q/π [2 Re w⁻¹ + z Im w⁻²]
    σ_z = −P/π [−z Re w⁻² − Im w⁻¹] + Q/π z Im w⁻²
    τ_xz = P/π z Im w⁻² − Q/π [z Re w⁻² − Im w⁻¹] ,

so that those of tractions follow from ∫ p/(w − t) dt and ∫ p/(w − t)² dt, which are closed for Hertz' half-ellipse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Complexes, Floats

Integrals = tuple[Complexes, Complexes]
"""Integrals ∫ v/(w − t) dt and ∫ v/(w − t)² dt (k,) of a traction v."""
SURFACE = 1e-14
"""Depth over half-width at which stress at the surface is evaluated, as the integrals are singular at the contact's
edges."""


@dataclass(frozen=True)
class HertzTractions:
    """Hertz' half-ellipse of pressure, and friction in a constant ratio to it."""

    half_width: float
    """Half-width b of the contact [mm]."""
    peak: float
    """Peak pressure p0 [MPa]."""
    friction: float
    """Tangential traction on the body towards +x over the pressure: μ where the contact slides."""

    def stress(self, x: Floats, z: Floats) -> Floats:
        """Stresses σ_x, σ_z, τ_xz (k, 3) [MPa] at places x, z (k,) from the contact's middle, z >= 0 into the body
        [mm]."""
        depth = np.maximum(z, SURFACE * self.half_width)
        u = (x + 1j * depth) / self.half_width
        root = np.sqrt(u - 1.0) * np.sqrt(u + 1.0)  # the branch that cancels u at infinity
        pressure = np.pi * self.peak * (u - root), np.pi * self.peak / self.half_width * (u / root - 1.0)
        return _stress(depth, pressure, (self.friction * pressure[0], self.friction * pressure[1]))


@dataclass(frozen=True)
class LineForces:
    """Forces per length on n lines of the surface, such as those of a contact solution at its quadrature points."""

    places: Floats
    """Places x (n,) of the lines [mm]."""
    pressing: Floats
    """Normal forces P (n,), into the body [N/mm]."""
    dragging: Floats
    """Tangential forces Q (n,), on the body towards +x [N/mm]."""

    def stress(self, x: Floats, z: Floats) -> Floats:
        """Stresses σ_x, σ_z, τ_xz (k, 3) [MPa] at places x, z (k,), z > 0 into the body [mm]; those of tractions where
        z is not small beside the spacing."""
        inverse: Complexes = np.reciprocal(x[:, None] - self.places + 1j * z[:, None])
        square = inverse**2
        P, Q = self.pressing.astype(complex), self.dragging.astype(complex)
        return _stress(z, (inverse @ P, square @ P), (inverse @ Q, square @ Q))


def plane_strain(stress: Floats, poissons_ratio: float) -> Floats:
    """Stress tensors (k, 3, 3), axes x, y, z, of σ_x, σ_z, τ_xz (k, 3) in plane strain."""
    σx, σz, τ = stress.T
    full = np.zeros((len(stress), 3, 3))
    full[:, 0, 0], full[:, 2, 2], full[:, 1, 1] = σx, σz, poissons_ratio * (σx + σz)
    full[:, 0, 2] = full[:, 2, 0] = τ
    return full


def _stress(depth: Floats, pressure: Integrals, friction: Integrals) -> Floats:
    """Stresses σ_x, σ_z, τ_xz (k, 3) [MPa] at depths (k,) [mm]."""
    (p1, p2), (q1, q2) = pressure, friction
    across = depth * p2.real - p1.imag, depth * q2.real - q1.imag
    σx = -across[0] - (2.0 * q1.real + depth * q2.imag)
    σz = depth * p2.real + p1.imag + depth * q2.imag
    τ = depth * p2.imag - across[1]
    return np.column_stack([σx, σz, τ]) / np.pi
