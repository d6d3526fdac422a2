"""Corrections of normal components between some nodes, against the matrix written out, with random numbers. Exact."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from evolvent.gears.two_level.normal_strips import NormalStrips
from tests.support.random_strips import random_correction


def test_normal_components_between_some_nodes() -> None:
    """N nᵀ S n Nᵀ with normals that turn with the layers, in single precision: between all nodes, between some of them
    in any order, and of one alone, with another tooth's beside them."""
    random = np.random.default_rng(1)
    correction = random_correction(random, 5, 6)
    strips = correction.strips
    n = np.random.default_rng(4).normal(size=(*strips.numbers.shape, 3))
    n[:] = n[:1]  # in the frames of the layers, one normal a row
    c, s = np.cos(strips.angle)[:, None], np.sin(strips.angle)[:, None]
    normals = np.empty((strips.size, 3))
    x, y, z = np.moveaxis(n, -1, 0)
    normals[strips.numbers] = np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
    S = correction.matrix.reshape(strips.size, 3, strips.size, 3)
    wanted = np.einsum("iajb,ia,jb->ij", S, normals, normals)
    normal = NormalStrips.of(strips, normals)
    for nodes in (np.arange(strips.size), random.permutation(strips.size)[:23], np.array([7])):
        other = random.permutation(strips.size)[:9]
        tiles = normal.among(strips.among([nodes, other]))
        for start, chosen in ((0, nodes), (len(nodes), other)):
            N = sp.random(6, len(chosen), 0.9, format="csr", random_state=3).astype(np.float32)
            found = np.zeros((6, 6), dtype=np.float32)
            tiles.add_sandwiched(found, N, start)
            exact = N @ wanted[np.ix_(chosen, chosen)] @ N.T
            assert np.abs(found - exact).max() < 1e-6 * len(chosen) * np.abs(wanted).max()
