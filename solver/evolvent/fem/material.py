"""Isotropic linear elasticity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import number


@dataclass(frozen=True)
class Material:
    """Isotropic elastic material; 2D bodies are in plane strain.

    youngs_modulus: [MPa] from 1e-12 to 1e20.
    poissons_ratio: from −0.9999 to 0.49999, beyond which rounding makes the stiffness useless. Contact pressures are
        verified up to 0.45 (poisson_limit.py).
    Raises InputError.
    """

    youngs_modulus: float = 210e3
    poissons_ratio: float = 0.3

    def __post_init__(self) -> None:
        remedy = "give one in MPa, steel has 210e3"
        wanted = "a finite number > 0, from 1e-12 to 1e20 [MPa]"
        number("youngs_modulus", self.youngs_modulus, wanted, remedy, lambda E: 1e-12 <= E <= 1e20)
        remedy = "give one, steel has 0.3; 0.499 is nearly incompressible"
        wanted = "−1 < ν < 0.5, from −0.9999 to 0.49999"
        number("poissons_ratio", self.poissons_ratio, wanted, remedy, lambda ν: -0.9999 <= ν <= 0.49999)

    @property
    def lame(self) -> tuple[float, float]:
        """(λ, μ) [MPa], of 3D and of plane strain."""
        E, ν = self.youngs_modulus, self.poissons_ratio
        return E * ν / ((1.0 + ν) * (1.0 - 2.0 * ν)), E / (2.0 * (1.0 + ν))

    @property
    def plane_modulus(self) -> float:
        """E/(1−ν²) [MPa]."""
        return self.youngs_modulus / (1.0 - self.poissons_ratio**2)


def joint_modulus(one: Material, other: Material) -> float:
    """E* [MPa] of two bodies in contact, 1/E* = Σ (1−ν²)/E."""
    return 1.0 / (1.0 / one.plane_modulus + 1.0 / other.plane_modulus)


STEEL = Material()


def traction_rows(material: Material, gradients: Floats, normals: Floats) -> Floats:
    """σ(u)n as a linear map of nodal displacements.

    gradients: (p, k, d) ∇N at p points; normals: (p, d). Returns (p, d, k, d): row component, node, node component.
    """
    λ, μ = material.lame
    d = normals.shape[1]
    along = np.einsum("pkb,pb->pk", gradients, normals)
    rows = λ * np.einsum("pa,pkb->pakb", normals, gradients) + μ * np.einsum("pka,pb->pakb", gradients, normals)
    rows += μ * np.einsum("pk,ab->pakb", along, np.eye(d))
    return rows
