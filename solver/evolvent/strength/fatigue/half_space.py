"""Stress in an elastic half-space below forces on its surface: those of a contact at its quadrature points.

Boussinesq's normal and Cerruti's tangential point force (Johnson, Contact Mechanics, 1985, Eqs 3.19 and 3.76). z goes
into the body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats

CHUNK = 2_000_000
"""Number of places times forces that are evaluated at once."""


@dataclass(frozen=True)
class PointForces:
    """Forces at n points of the surface z = 0."""

    places: Floats
    """Points x, y (n, 2) of the forces [mm]."""
    forces: Floats
    """Forces (n, 3) along x, y, z, the last into the body [N]."""
    poissons_ratio: float
    """Poisson's ratio ν of the body."""

    def stress(self, at: Floats) -> Floats:
        """Stress tensors (k, 3, 3) [MPa] at places (k, 3), z > 0 into the body [mm]; those of tractions where z is not
        small beside the spacing of the forces."""
        parts = np.array_split(at, max(1, len(at) * len(self.places) // CHUNK))
        return np.concatenate([self._stress(each) for each in parts])

    def _stress(self, at: Floats) -> Floats:
        x, y = (at[:, None, axis] - self.places[:, axis] for axis in (0, 1))
        z = np.broadcast_to(at[:, 2, None], x.shape)
        pressed = _boussinesq(x, y, z, self.poissons_ratio)
        along_x = _cerruti(x, y, z, self.poissons_ratio)
        turned = _cerruti(y, x, z, self.poissons_ratio)  # along y: x and y change places
        along_y = turned[[1, 0, 2, 3, 5, 4]]
        each = zip((along_x, along_y, pressed), self.forces.T)
        σx, σy, σz, τxy, τxz, τyz = sum(unit @ force for unit, force in each) / (2.0 * np.pi)
        return np.stack([σx, τxy, τxz, τxy, σy, τyz, τxz, τyz, σz], axis=1).reshape(-1, 3, 3)


def _boussinesq(x: Floats, y: Floats, z: Floats, ν: float) -> Floats:
    """Stresses σ_x, σ_y, σ_z, τ_xy, τ_xz, τ_yz (6, k, n), times 2π, by unit forces into the body."""
    ρ = np.sqrt(x**2 + y**2 + z**2)
    s, cubed, fifth = ρ + z, ρ**3, 3.0 / ρ**5
    even, bent = z / cubed - 1.0 / (ρ * s), (2.0 * ρ + z) / (cubed * s**2)

    def along(p: Floats) -> Floats:
        return -fifth * p**2 * z + (1.0 - 2.0 * ν) * (even + p**2 * bent)

    shear = -fifth * x * y * z + (1.0 - 2.0 * ν) * x * y * bent
    return np.stack([along(x), along(y), -fifth * z**3, shear, -fifth * x * z**2, -fifth * y * z**2])


def _cerruti(x: Floats, y: Floats, z: Floats, ν: float) -> Floats:
    """Stresses σ_x, σ_y, σ_z, τ_xy, τ_xz, τ_yz (6, k, n), times 2π, by unit forces along x."""
    ρ = np.sqrt(x**2 + y**2 + z**2)
    s, cubed, fifth = ρ + z, ρ**3, 3.0 / ρ**5
    first, bent = 1.0 / (ρ * s**2), 1.0 / (cubed * s**2) + 2.0 / (ρ**2 * s**3)

    def along(p: Floats, count: float) -> Floats:
        return -fifth * x * p**2 + (1.0 - 2.0 * ν) * x * (1.0 / cubed - count * first + p**2 * bent)

    shear = -fifth * x**2 * y + (1.0 - 2.0 * ν) * y * (x**2 * bent - first)
    return np.stack([along(x, 3.0), along(y, 1.0), -fifth * x * z**2, shear, -fifth * x**2 * z, -fifth * x * y * z])
