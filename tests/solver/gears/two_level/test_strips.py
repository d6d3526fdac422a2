"""Corrections as products, strip by strip, against the matrix written out, with random numbers. Exact."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.two_level.strips import StripCorrection
from evolvent_meshes.arrays import Floats, Ints
from tests.support.random_strips import strips, written_out


@pytest.fixture
def correction() -> StripCorrection:
    """Five rows, six layers."""
    return strips(np.random.default_rng(1), 5, 6)


def dofs(nodes: Ints) -> Ints:
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def test_products_with_the_forces_on_all_nodes(correction: StripCorrection) -> None:
    """½ (D + Dᵀ) f, in both precisions; and some nodes of the matrix are zero, as no strip has them."""
    f, D = np.random.default_rng(2).normal(size=(correction.size, 3)), written_out(correction)
    whole = correction.among([np.arange(correction.size)])
    assert whole.times(f).ravel() == pytest.approx(D @ f.ravel(), abs=1e-13 * np.abs(D).sum())
    single = whole.times(f.astype(np.float32))
    assert single.dtype == np.float32
    assert single.ravel() == pytest.approx(D @ f.ravel(), abs=1e-6 * np.abs(D).sum(axis=0).max())


def test_products_between_some_nodes_of_several_teeth(correction: StripCorrection) -> None:
    """Each tooth feels its own forces only: the blocks of the matrix. One tooth has nodes that no strip loads."""
    random, D = np.random.default_rng(3), written_out(correction)
    few = np.flatnonzero(np.abs(D).reshape(correction.size, -1).max(axis=1) == 0.0)[:1]
    nodes = [random.permutation(correction.size)[:17], random.permutation(correction.size)[:5], few]
    parts: list[Floats] = [random.normal(size=(len(each), 3)) for each in nodes]
    found = correction.among(nodes).times(np.concatenate(parts))
    wanted = [D[np.ix_(dofs(each), dofs(each))] @ f.ravel() for each, f in zip(nodes, parts)]
    assert found.ravel() == pytest.approx(np.concatenate(wanted), abs=1e-13 * np.abs(D).sum())


def test_normal_components(correction: StripCorrection) -> None:
    """nᵀ D n with normals that turn with the layers, in single precision."""
    n = np.random.default_rng(4).normal(size=(*correction.numbers.shape, 3))
    n[:] = n[:1]  # in the frames of the layers, one normal a row
    c, s = np.cos(correction.angle)[:, None], np.sin(correction.angle)[:, None]
    normals = np.empty((correction.size, 3))
    x, y, z = np.moveaxis(n, -1, 0)
    normals[correction.numbers] = np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
    D = written_out(correction).reshape(correction.size, 3, correction.size, 3)
    wanted = np.einsum("iajb,ia,jb->ij", D, normals, normals)
    assert np.abs(correction.normal(normals).toarray() - wanted).max() < 1e-6 * np.abs(wanted).max()


def test_small_displacements_at_the_rim_are_left_out(correction: StripCorrection) -> None:
    """A strip whose outer level and two outer rows hardly move loses them, and nothing else."""
    strip = max(correction.strips, key=lambda each: each.moved)
    Q, P = strip.moved
    change = strip.change.reshape(-1, Q, P, 3)
    change[:, 0], change[:, :, -2:] = 1e-6 * change[:, 0], 1e-6 * change[:, :, -2:]
    found = strip.trimmed(1e-3)
    assert found.moved == (Q - 1, P - 2) and found.start == (strip.start[0] + 1, strip.start[1])
    assert np.array_equal(found.change, change[:, 1:, :-2].reshape(len(change), -1))
    assert strip.trimmed(0.0).moved == (Q, P)
