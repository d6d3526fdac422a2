"""Corrections as products, strip by strip, against the matrix written out, with random numbers. Exact."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.two_level.strips import StripCorrection
from evolvent_meshes.arrays import Floats, Ints
from tests.support.random_strips import RandomCorrection, random_correction


@pytest.fixture
def correction() -> RandomCorrection:
    """Five rows, six layers."""
    return random_correction(np.random.default_rng(1), 5, 6)


def dofs(nodes: Ints) -> Ints:
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def test_products_with_the_forces_on_all_nodes(correction: RandomCorrection) -> None:
    """S f, in both precisions."""
    strips, S = correction.strips, correction.matrix
    f = np.random.default_rng(2).normal(size=(strips.size, 3))
    whole = strips.among([np.arange(strips.size)])
    assert whole.times(f).ravel() == pytest.approx(S @ f.ravel(), abs=1e-13 * np.abs(S).sum())
    single = whole.times(f.astype(np.float32))
    assert single.dtype == np.float32
    assert single.ravel() == pytest.approx(S @ f.ravel(), abs=1e-6 * np.abs(S).sum(axis=0).max())


def test_products_between_some_nodes_of_several_teeth(correction: RandomCorrection) -> None:
    """Each tooth feels its own forces only: the blocks of the matrix."""
    strips, S, random = correction.strips, correction.matrix, np.random.default_rng(3)
    nodes = [random.permutation(strips.size)[:count] for count in (17, 5, 1)]
    parts: list[Floats] = [random.normal(size=(len(each), 3)) for each in nodes]
    found = strips.among(nodes).times(np.concatenate(parts))
    wanted = [S[np.ix_(dofs(each), dofs(each))] @ f.ravel() for each, f in zip(nodes, parts)]
    assert found.ravel() == pytest.approx(np.concatenate(wanted), abs=1e-13 * np.abs(S).sum())


def test_sources_that_leave_nodes_out_are_refused(correction: RandomCorrection) -> None:
    """Nodes of no patch would have no displacement."""
    strips = correction.strips
    with pytest.raises(ValueError, match="each node once"):
        StripCorrection.of(strips.lattice, strips.per_layer, strips.angle, strips.strips[1:])
