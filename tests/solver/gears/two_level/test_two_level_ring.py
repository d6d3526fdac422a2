"""The compliance of fine flanks: blocks and displacements against the sum written out, with random matrices. Exact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.two_level.correction import Correction, PlacedResponse
from evolvent.gears.ring.ring_compliance import MappedNodes
from evolvent.gears.two_level.two_level_ring import RefinedLevel, TwoLevelRing
from evolvent_meshes.arrays import Floats, Ints

TEETH, COARSE, PITCH, D = 3, 5, 2 * np.pi / 17, 3


class DenseCompliance:
    """Teeth 0 to 2 with a random symmetric compliance."""

    def __init__(self, random: np.random.Generator) -> None:
        matrix = random.normal(size=(TEETH * COARSE * D,) * 2)
        self.matrix = matrix + matrix.T

    def block(self, parts: Sequence[MappedNodes]) -> Floats:
        maps = [part.map(np.eye(D * len(part.nodes))) for part in parts]
        dofs = [dofs_of(np.column_stack([np.full(len(p.nodes), p.tooth), p.nodes]), COARSE) for p in parts]
        E = sp.block_diag(maps).toarray()
        return np.asarray(E @ self.matrix[np.ix_(np.concatenate(dofs), np.concatenate(dofs))] @ E.T)

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        matrix = self.matrix[np.ix_(dofs_of(rows_out, COARSE), dofs_of(rows_in, COARSE))]
        u = forces.reshape(*forces.shape[:-2], -1) @ matrix.T
        return np.asarray(u.reshape(*forces.shape[:-2], -1, D))


def dofs_of(rows: Ints, size: int) -> Ints:
    return np.asarray(((rows[:, 0] * size + rows[:, 1])[:, None] * D + np.arange(D)).ravel())


def turn(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def level(random: np.random.Generator, size: int, before: int) -> RefinedLevel:
    """Random shape functions, and a correction of two congruent places."""
    transfer = sp.csr_matrix(random.random((size, before)) * (random.random((size, before)) < 0.4))
    nodes = np.array([random.permutation(size)[:6], random.permutation(size)[:6]])
    turns = np.array([turn(0.4), turn(-0.2)])
    change = random.normal(size=(6 * D, 2 * D))
    return RefinedLevel(transfer, Correction(size, [PlacedResponse(change, nodes, nodes[:, :2], turns)]))


def two_levels() -> tuple[TwoLevelRing, Floats]:
    """A ring with two levels of 9 and 14 nodes, and its compliance written out."""
    random = np.random.default_rng(7)
    coarse, levels = DenseCompliance(random), [level(random, 9, COARSE), level(random, 14, 9)]
    C = coarse.matrix
    for each in levels:
        n = each.correction.size
        R = np.kron(np.eye(TEETH), np.kron(each.transfer.toarray(), np.eye(D)))
        own = [np.kron(np.eye(n), turn(i * PITCH)) for i in range(TEETH)]
        near = each.correction.among(np.arange(n))
        C = R @ C @ R.T + sp.block_diag([Q @ near @ Q.T for Q in own]).toarray()
    return TwoLevelRing(coarse, levels, PITCH), C


@pytest.mark.parametrize("loads", [(), (2,)])
def test_displacements_of_fine_nodes(loads: tuple[int, ...]) -> None:
    """Forces on some nodes of two teeth move nodes of all three, for one load and for several."""
    ring, exact = two_levels()
    random = np.random.default_rng(1)
    rows_in = np.array([(0, 3), (2, 5), (0, 11), (2, 0)])
    rows_out = np.array([(1, 2), (0, 3), (2, 13), (0, 0), (1, 7)])
    forces = random.normal(size=(*loads, len(rows_in), D))
    u = forces.reshape(*loads, -1) @ exact[np.ix_(dofs_of(rows_in, 14), dofs_of(rows_out, 14))]
    assert ring.apply(rows_in, forces, rows_out) == pytest.approx(u.reshape(*loads, -1, D), rel=1e-12)


def test_block_between_mapped_nodes() -> None:
    """Maps of two teeth, one of them not the first, in any order."""
    ring, exact = two_levels()
    random = np.random.default_rng(2)
    nodes = {2: np.array([4, 1, 9]), 0: np.array([13, 2])}
    maps = {tooth: random.normal(size=(4, D * len(own))) for tooth, own in nodes.items()}
    dofs = np.concatenate([dofs_of(np.column_stack([np.full(len(n), t), n]), 14) for t, n in nodes.items()])
    E = sp.block_diag(list(maps.values())).toarray()
    found = ring.block([MappedNodes(tooth, own, maps[tooth].__matmul__) for tooth, own in nodes.items()])
    assert found == pytest.approx(E @ exact[np.ix_(dofs, dofs)] @ E.T, rel=1e-11)
