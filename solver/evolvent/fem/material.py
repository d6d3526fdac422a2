"""Isotropic linear elasticity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import number


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic material; 2D bodies are in plane strain.

    youngs_modulus: E [MPa], from 1e-12 to 1e20.
    poissons_ratio: ν, from −0.9999 to 0.49999, beyond which rounding spoils the stiffness. Contact pressures are
        verified up to 0.45 (evolvent.contact.problem.poisson_limit).
    density: ϱ [t/mm³], from 1e-15 to 1e-6; steel has 7.85e-9, which is 7850 kg/m³ times 1e-12. Only inertia needs it.
    Raises InputError.

    >>> steel = Material(youngs_modulus=210e3, poissons_ratio=0.3)
    >>> print(f"{steel.plane_modulus:.0f} MPa")
    230769 MPa
    """

    youngs_modulus: float = 210e3
    poissons_ratio: float = 0.3
    density: float = 7.85e-9

    def __post_init__(self) -> None:
        remedy = "give one in MPa, steel has 210e3"
        wanted = "a finite number > 0, from 1e-12 to 1e20 [MPa]"
        number("youngs_modulus", self.youngs_modulus, wanted, remedy, lambda E: 1e-12 <= E <= 1e20)
        remedy = "give one, steel has 0.3; 0.499 is nearly incompressible"
        wanted = "−1 < ν < 0.5, from −0.9999 to 0.49999"
        number("poissons_ratio", self.poissons_ratio, wanted, remedy, lambda ν: -0.9999 <= ν <= 0.49999)
        remedy = "give kg/m³ times 1e-12, steel has 7.85e-9"
        number("density", self.density, "1e-15 to 1e-6 [t/mm³]", remedy, lambda ϱ: 1e-15 <= ϱ <= 1e-6)

    @property
    def elasticity(self) -> tuple[float, float]:
        """Young's modulus E [MPa] and Poisson's ratio ν: all that stiffness depends on."""
        return self.youngs_modulus, self.poissons_ratio

    @property
    def lame(self) -> tuple[float, float]:
        """Lamé parameters (λ, μ) [MPa], of 3D and of plane strain."""
        E, ν = self.youngs_modulus, self.poissons_ratio
        return E * ν / ((1.0 + ν) * (1.0 - 2.0 * ν)), E / (2.0 * (1.0 + ν))

    @property
    def plane_modulus(self) -> float:
        """Plane strain modulus E/(1−ν²) [MPa]."""
        return self.youngs_modulus / (1.0 - self.poissons_ratio**2)


def contact_modulus(one: Material, other: Material) -> float:
    """Contact modulus E* [MPa] of two bodies, 1/E* = Σ (1−ν²)/E (Johnson, Contact Mechanics, 1985, 4.2)."""
    return 1.0 / (1.0 / one.plane_modulus + 1.0 / other.plane_modulus)


STEEL = Material()


def traction_rows(material: Material, gradients: Floats, normals: Floats) -> Floats:
    """Tractions σ(u)n at p points as a linear map of nodal displacements: (p, d, k, d), that is component of the
    traction, node, component of the displacement [N/mm³].

    gradients: (p, k, d) gradients ∇N of the shape functions [1/mm].
    normals: (p, d) unit normals n.
    """
    λ, μ = material.lame
    d = normals.shape[1]
    along = np.einsum("pkb,pb->pk", gradients, normals)
    rows = λ * np.einsum("pa,pkb->pakb", normals, gradients) + μ * np.einsum("pka,pb->pakb", gradients, normals)
    rows += μ * np.einsum("pk,ab->pakb", along, np.eye(d))
    return rows
