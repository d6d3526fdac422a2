"""Corrections of normal components between some nodes, against the matrix written out, with random numbers. Exact."""

from __future__ import annotations

import numpy as np

from evolvent.gears.two_level.normal_strips import NormalStrips
from tests.support.random_strips import random_correction


def test_normal_components_between_some_nodes() -> None:
    """nᵀ S n with normals that turn with the layers, in single precision: between all nodes, between some of them in
    any order, and between one alone, with another tooth's beside them; of all, and of those that are half a layer
    apart at most."""
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
    level = np.empty(strips.size, dtype=int)
    level[strips.numbers] = np.arange(len(strips.numbers))[:, None]
    near = np.abs(level[:, None] - level) <= strips.per_layer / 2
    for apart, S_n in ((99.0, wanted), (0.5, np.where(near, wanted, 0.0))):
        for nodes in (np.arange(strips.size), random.permutation(strips.size)[:23], np.array([7])):
            other = random.permutation(strips.size)[:9]
            tiles = normal.among(strips.among([nodes, other]), apart)
            size, k = len(nodes) + len(other), len(nodes)
            whole = tiles.part((0, size), (0, size))
            found, both = whole[np.ix_(tiles.number, tiles.number)], np.concatenate([nodes, other])
            blocks = np.where((np.arange(size)[:, None] < k) == (np.arange(size) < k), S_n[np.ix_(both, both)], 0.0)
            assert np.abs(found - blocks).max() < 1e-6 * np.abs(wanted).max()
            assert np.array_equal(tiles.part((1, size), (0, size - 1)), whole[1:, :-1])
