"""The mortar projection as products with its factored mass matrix, against its matrix. Exact, random numbers."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent_meshes.arrays import Floats

N, N2 = 7, 12


def projection(seed: int = 1) -> MortarProjection:
    """Of nodes of which the last five of surface 2 are not opposite."""
    random = np.random.default_rng(seed)
    L = np.tril(random.random((N, N))) + N * np.eye(N)
    mixed = random.random((N, N2)) * (random.random((N, N2)) < 0.5)
    mixed[:, N2 - 5 :] = 0.0
    return MortarProjection(SurfaceMass(sp.csr_matrix(L @ L.T)), sp.csr_matrix(mixed))


def written_out(Π: MortarProjection) -> Floats:
    return np.linalg.solve(Π.mass.matrix.toarray(), Π.mixed.toarray())


@pytest.mark.parametrize("shape", [(), (3,), (3, 2)])
def test_products(shape: tuple[int, ...]) -> None:
    """Π u and Πᵀ f of vectors with any further axes."""
    Π, random = projection(), np.random.default_rng(2)
    u, f = random.normal(size=(N2, *shape)), random.normal(size=(N, *shape))
    assert Π @ u == pytest.approx(np.tensordot(written_out(Π), u, 1), rel=1e-10)
    assert Π.transposed(f) == pytest.approx(np.tensordot(written_out(Π).T, f, 1), rel=1e-10)


def test_columns_and_matrix() -> None:
    """Some columns, the whole matrix, and that of the nodes that are opposite alone."""
    Π, exact = projection(), written_out(projection())
    assert Π.at(np.array([4, 1])) == pytest.approx(exact[:, [4, 1]], rel=1e-10)
    assert Π.matrix().toarray() == pytest.approx(exact, abs=1e-12)
    assert Π.columns.max() < N2 - 5
    assert Π.of_columns().matrix().toarray() == pytest.approx(exact[:, Π.columns], abs=1e-12)


def test_several_side_by_side_and_sent_to_another_process() -> None:
    """Block-diagonal, and the same once pickled, also after its mass matrix was factored."""
    parts = [projection(1), projection(2)]
    both = MortarProjection.stacked(parts)
    exact = sp.block_diag([written_out(part) for part in parts]).toarray()
    u = np.random.default_rng(3).normal(size=2 * N2)
    assert both.shape == exact.shape and both @ u == pytest.approx(exact @ u, rel=1e-10)
    assert np.array_equal(pickle.loads(pickle.dumps(both)) @ u, both @ u)
