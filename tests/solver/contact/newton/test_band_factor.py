"""Factors of banded matrices against dense products, in single precision."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.newton.band_factor import BandFactor
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tiled_band import TiledBand

N = 400


def banded(seed: int, below: int, above: int, density: float = 1.0) -> sp.csr_matrix:
    """Random entries on some diagonals, (N, N)."""
    random = np.random.default_rng(seed)
    full = random.normal(size=(N, N)) * (random.random((N, N)) < density)
    return sp.csr_matrix(np.triu(np.tril(full, above), -below).astype(np.float32))


@pytest.mark.parametrize("columns", [(), (3,)])
def test_inverse(columns: tuple[int, ...]) -> None:
    """(I + A M)⁻¹ r for one and for several r, where some columns of M, of A or all are empty too."""
    A, M = banded(1, 20, 11).tolil(), 0.01 * banded(2, 3, 5, 0.5).tolil()
    M[:, 130:300] = 0.0
    A[:, 320:330] = 0.0
    empty = sp.csr_matrix((N, N), dtype=np.float32)
    right = np.random.default_rng(4).normal(size=(N, *columns)).astype(np.float32)
    for left, middle in ((A, M), (A, empty), (empty, M)):
        found = BandFactor(TiledBand.of(left.tocsc()), middle.tocsc()).solve(right)
        assert found + left @ (middle @ found) == pytest.approx(right, abs=1e-4)


def test_singular_matrix_is_an_error() -> None:
    """I + A M with a zero row: NotConverged."""
    one = sp.csr_matrix(([np.float32(1.0)], ([0], [0])), (N, N))
    with pytest.raises(NotConverged, match="singular"):
        BandFactor(TiledBand.of(one.tocsc()), -one.tocsc())
