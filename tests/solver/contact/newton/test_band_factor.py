"""Banded matrices: products and factors against dense ones, in single precision."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.newton.band_factor import BandFactor, times_banded
from evolvent.contact.newton.snes import NotConverged

N = 400


def banded(seed: int, below: int, above: int, density: float = 1.0) -> sp.csr_matrix:
    """Random entries on some diagonals, (N, N)."""
    random = np.random.default_rng(seed)
    full = random.normal(size=(N, N)) * (random.random((N, N)) < density)
    return sp.csr_matrix(np.triu(np.tril(full, above), -below).astype(np.float32))


def test_product() -> None:
    """A M, also where some columns of M are empty."""
    A, M = banded(1, 20, 11), banded(2, 3, 5, 0.5).tolil()
    M[:, 130:300] = 0.0
    found = times_banded(A, sp.csc_matrix(M)).toarray()
    assert found == pytest.approx(A.toarray() @ M.toarray(), abs=1e-4)
    assert times_banded(A, sp.csc_matrix((N, N), dtype=np.float32)).nnz == 0


@pytest.mark.parametrize("columns", [(), (3,)])
def test_inverse(columns: tuple[int, ...]) -> None:
    """(I + B)⁻¹ r for one and for several r; B = 0 too."""
    B, right = 0.05 * banded(3, 7, 12), np.random.default_rng(4).normal(size=(N, *columns)).astype(np.float32)
    found = BandFactor(B.tocoo()).solve(right)
    assert found + B @ found == pytest.approx(right, abs=1e-4)
    assert BandFactor(sp.coo_matrix((N, N), dtype=np.float32)).solve(right) == pytest.approx(right)


def test_singular_matrix_is_an_error() -> None:
    """I + B with a zero row: NotConverged."""
    with pytest.raises(NotConverged, match="singular"):
        BandFactor(sp.coo_matrix(([np.float32(-1.0)], ([0], [0])), (N, N)))
