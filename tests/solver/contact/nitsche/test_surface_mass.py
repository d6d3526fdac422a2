"""The mass matrix of a surface, and what is solved with it."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent_meshes.arrays import Floats
from tests.support.meshes.surface_shapes import lattice, rectangle


def of_a_rectangle() -> tuple[SurfaceMass, Floats]:
    """The mass matrix of some facets of a plane, and the positions of their nodes."""
    surface = lattice(4, 3, "quadrilateral", 2, rectangle((0.0, 0.0), (2.0, 1.5)))
    facets = np.array([0, 1, 2, 3, 4, 5])  # the first two columns: 1 mm × 1.5 mm
    nodes = np.unique(surface.facets[facets])
    return SurfaceMass.of(surface, facets, nodes), surface.points[nodes]


def test_products_of_polynomials_are_integrated_exactly() -> None:
    """∫ u v over 1 mm × 1.5 mm: of u = 1, x, x y with v = y²."""
    mass, x = of_a_rectangle()
    v = mass.matrix @ x[:, 1] ** 2
    for u, wanted in ((1.0 + 0.0 * x[:, 0], 1.125), (x[:, 0], 0.5625), (x[:, 0] * x[:, 1], 0.5 * 1.5**4 / 4.0)):
        assert u @ v == pytest.approx(wanted, rel=1e-12)


def test_solutions() -> None:
    """M⁻¹ M v = v for columns with any further axes, also once pickled after it was factored."""
    mass, _ = of_a_rectangle()
    n = mass.matrix.shape[0]
    v = np.random.default_rng(1).normal(size=(n, 3, 2))
    f = (mass.matrix @ v.reshape(n, -1)).reshape(v.shape)
    assert mass.solved(f) == pytest.approx(v, rel=1e-9, abs=1e-9)
    assert pickle.loads(pickle.dumps(mass)).solved(f) == pytest.approx(v, rel=1e-9, abs=1e-9)


def test_solved_from_both_sides() -> None:
    """M⁻¹ (M A M) M⁻¹ = A of a symmetric A, in single precision."""
    mass, _ = of_a_rectangle()
    M = mass.matrix.toarray()
    A = np.random.default_rng(2).normal(size=M.shape)
    A += A.T
    assert mass.sandwiched((M @ A @ M).astype(np.float32)) == pytest.approx(A, abs=1e-4 * np.abs(A).max())


def test_several_in_one_list() -> None:
    """Block-diagonal."""
    mass, _ = of_a_rectangle()
    n = mass.matrix.shape[0]
    both = SurfaceMass.stacked([mass, mass]).matrix.toarray()
    assert np.array_equal(both, np.kron(np.eye(2), mass.matrix.toarray())) and both.shape == (2 * n, 2 * n)
