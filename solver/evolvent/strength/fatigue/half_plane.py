"""Stress in an elastic half-plane under pressure and friction on its surface, in plane strain.

With w = x − t + iz, a normal force P into the body and a tangential one Q towards +x at t cause (Johnson, Contact
Mechanics, 1985, 2.2 and 2.3)

    σ_x = −P/π [z Re w⁻² − Im w⁻¹] − Q/π [2 Re w⁻¹ + z Im w⁻²]
    σ_z = −P/π [−z Re w⁻² − Im w⁻¹] + Q/π z Im w⁻²
    τ_xz = P/π z Im w⁻² − Q/π [z Re w⁻² − Im w⁻¹] ,

so that those of tractions follow from ∫ p/(w − t) dt and ∫ p/(w − t)² dt, which are closed where p is linear between
nodes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Complexes, Floats

SURFACE = 1e-9
"""Depth at which stress at the surface is evaluated, over the width of the tractions: the logarithms of neighbouring
intervals cancel there to rounding."""


@dataclass(frozen=True)
class SurfaceTractions:
    """Tractions on a strip of the surface z = 0, linear between n nodes, zero beside it."""

    nodes: Floats
    """x (n,) of the nodes, ascending [mm]."""
    pressure: Floats
    """p (n,) [MPa]."""
    friction: Floats
    """q (n,), tangential traction on the body towards +x [MPa]."""

    def stress(self, x: Floats, z: Floats) -> Floats:
        """(k, 3) σ_x, σ_z, τ_xz [MPa] at places x, z (k,), z >= 0 into the body [mm]."""
        depth = np.maximum(z, SURFACE * np.ptp(self.nodes))
        w = x + 1j * depth
        (p1, p2), (q1, q2) = (self._integrals(w, values) for values in (self.pressure, self.friction))
        across = depth * p2.real - p1.imag, depth * q2.real - q1.imag
        σx = -across[0] - (2.0 * q1.real + depth * q2.imag)
        σz = depth * p2.real + p1.imag + depth * q2.imag
        τ = depth * p2.imag - across[1]
        return np.column_stack([σx, σz, τ]) / np.pi

    def _integrals(self, w: Complexes, values: Floats) -> tuple[Complexes, Complexes]:
        """∫ v/(w − t) dt and ∫ v/(w − t)² dt (k,) of values (n,) at the nodes."""
        step = np.diff(self.nodes)
        slope = np.diff(values) / step
        apart = w[:, None] - self.nodes
        logarithm = np.diff(np.log(apart), axis=1)
        here = values[:-1] + slope * apart[:, :-1]  # the linear function, continued to w
        first = -(slope * step + here * logarithm).sum(axis=1)
        second = (slope * logarithm + here * np.diff(1.0 / apart, axis=1)).sum(axis=1)
        return first, second


def plane_strain(stress: Floats, poissons_ratio: float) -> Floats:
    """(k, 3, 3) stress tensors, axes x, y, z, of σ_x, σ_z, τ_xz (k, 3)."""
    σx, σz, τ = stress.T
    full = np.zeros((len(stress), 3, 3))
    full[:, 0, 0], full[:, 2, 2], full[:, 1, 1] = σx, σz, poissons_ratio * (σx + σz)
    full[:, 0, 2] = full[:, 2, 0] = τ
    return full


def hertz_tractions(half_width: float, peak: float, friction: float, count: int = 401) -> SurfaceTractions:
    """Hertz' half-ellipse of pressure that slides over the body, q = μp; nodes are dense at its edges."""
    x = -half_width * np.cos(np.linspace(0.0, np.pi, count))
    p = peak * np.sqrt(np.maximum(1.0 - (x / half_width) ** 2, 0.0))
    return SurfaceTractions(x, p, friction * p)
