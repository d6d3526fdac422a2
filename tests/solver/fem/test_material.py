"""Elastic constants, and the traction of a displacement field."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.material import Material, contact_modulus, traction_rows


@pytest.mark.parametrize(
    ("youngs_modulus", "poissons_ratio", "message"),
    [(-1.0, 0.3, "youngs_modulus"), (float("nan"), 0.3, "youngs_modulus"), (1.0, 0.5, "poissons_ratio")],
)
def test_impossible_materials_are_refused(youngs_modulus: float, poissons_ratio: float, message: str) -> None:
    """ValueError that names the constant."""
    with pytest.raises(ValueError, match=message):
        Material(youngs_modulus, poissons_ratio)


def test_elastic_constants_of_steel() -> None:
    """E = 210 GPa, ν = 0.3: λ = Eν/((1+ν)(1−2ν)) = 121,154 MPa, μ = E/(2(1+ν)) = 80,769 MPa; two bodies alike have
    half the modulus E/(1−ν²) of one."""
    steel = Material(210e3, 0.3)
    assert steel.lame == pytest.approx((121153.846, 80769.2308))
    assert contact_modulus(steel, steel) == pytest.approx(steel.plane_modulus / 2) == pytest.approx(210e3 / 0.91 / 2)


@pytest.mark.parametrize("d", [2, 3])
def test_traction_rows_of_a_linear_field(d: int) -> None:
    """A simplex with u = Gx: the traction on a plane with normal n is (λ tr ε 1 + 2με)n, ε = (G + Gᵀ)/2."""
    rng, material = np.random.default_rng(d), Material(100.0, 0.25)
    corners, G, n = rng.normal(size=(d + 1, d)), rng.normal(size=(d, d)), rng.normal(size=d)
    gradients = np.linalg.inv(np.column_stack([np.ones(d + 1), corners]))[1:].T
    rows = traction_rows(material, gradients[None], n[None])[0]
    ε, (λ, μ) = (G + G.T) / 2, material.lame
    assert np.allclose(np.einsum("akb,kb->a", rows, corners @ G.T), (λ * np.trace(ε) * np.eye(d) + 2 * μ * ε) @ n)
