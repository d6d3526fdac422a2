"""The compliance of fine flanks: products and displacements against the sum written out, with random matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.newton.block_inverse import NearlyNormal
from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent.gears.ring.jump_map import JumpMap
from evolvent.gears.ring.ring_compliance import MappedNodes
from evolvent.gears.ring.ring_window import RingWindow, TeethCoupling
from evolvent.gears.two_level.refined_level import RefinedLevel
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent_meshes.arrays import Floats, Ints
from tests.support.random_strips import random_correction

TEETH, COARSE, PITCH, D = 3, 9, 2 * np.pi / 17, 3


@dataclass(frozen=True)
class RandomRing:
    """Teeth 0 to 2 with a random symmetric compliance between nodes, in the frames of their sectors."""

    matrix: Floats

    def window(self, parts: Sequence[tuple[int, Ints]]) -> RingWindow:
        """The coupling of sectors has one mode for each displacement."""
        rows = [dofs_of(np.column_stack([np.full(len(nodes), tooth), nodes]), COARSE) for tooth, nodes in parts]
        own = tuple(self.matrix[np.ix_(each, each)] for each in rows)
        every = [dofs_of(np.column_stack([np.full(COARSE, t), np.arange(COARSE)]), COARSE) for t, _ in parts]
        coupling = self.matrix[np.ix_(np.concatenate(every), np.concatenate(every))].copy()
        for i in range(len(parts)):
            coupling[i * COARSE * D : (i + 1) * COARSE * D, i * COARSE * D : (i + 1) * COARSE * D] = 0.0
        modes = tuple(np.eye(COARSE * D)[dofs_of(np.column_stack([0 * n, n]), COARSE)] for _, n in parts)
        return RingWindow(own, modes, TeethCoupling(coupling))


def dofs_of(rows: Ints, size: int) -> Ints:
    return np.asarray(((rows[:, 0] * size + rows[:, 1])[:, None] * D + np.arange(D)).ravel())


def turn(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def level(random: np.random.Generator, layers: int, before: int) -> tuple[RefinedLevel, Floats]:
    """Random shape functions and a random correction of four rows and some layers, and that as a matrix."""
    correction = random_correction(random, 4, layers)
    size = correction.strips.size
    transfer = sp.csr_matrix(random.random((size, before)) * (random.random((size, before)) < 0.4))
    return RefinedLevel(transfer, correction.strips, random.normal(size=(size, 3))), correction.matrix


def two_levels(normal: Floats | None = None) -> tuple[TwoLevelRing, Floats]:
    """A ring with two levels of 28 and 36 nodes, and its compliance written out. normal: (3,) of all nodes, None:
    random ones."""
    random = np.random.default_rng(7)
    matrix = random.normal(size=(TEETH * COARSE * D,) * 2)
    first = level(random, 3, COARSE)
    both = [first, level(random, 4, first[0].correction.size)]
    levels = [each for each, _ in both]
    matrix = matrix @ matrix.T
    C = matrix
    for each, change in both:
        R = np.kron(np.eye(TEETH), np.kron(each.transfer.toarray(), np.eye(D)))
        C = R @ C @ R.T + np.kron(np.eye(TEETH), change)
    Q = sp.block_diag([np.kron(np.eye(levels[-1].correction.size), turn(i * PITCH)) for i in range(TEETH)]).toarray()
    flank: Any = SimpleNamespace(points=random.normal(size=(COARSE, 3)), normals=random.normal(size=(COARSE, 3)))
    if normal is not None:
        flank.normals[:] = normal
        levels = [replace(each, normals=np.tile(normal, (len(each.normals), 1))) for each in levels]
    coarse: Any = RandomRing(matrix)
    return TwoLevelRing(coarse, flank, tuple(levels), PITCH), Q @ C @ Q.T


@pytest.mark.parametrize("loads", [(), (2,)])
def test_displacements_of_fine_nodes(loads: tuple[int, ...]) -> None:
    """Forces on some nodes of two teeth move nodes of all three, for one load and for several."""
    ring, exact = two_levels()
    random = np.random.default_rng(1)
    rows_in = np.array([(0, 3), (2, 5), (0, 11), (2, 0)])
    rows_out = np.array([(1, 2), (0, 3), (2, 13), (0, 0), (1, 7)])
    forces = random.normal(size=(*loads, len(rows_in), D))
    u = forces.reshape(*loads, -1) @ exact[np.ix_(dofs_of(rows_in, ring.size), dofs_of(rows_out, ring.size))]
    assert ring.apply(rows_in, forces, rows_out) == pytest.approx(u.reshape(*loads, -1, D), rel=1e-12)


def mapped(ring: TwoLevelRing) -> list[MappedNodes]:
    """Two components of the jump at four nodes of tooth 2, from nine nodes of its flank, and at two of tooth 0."""
    random = np.random.default_rng(2)
    mass, mixed = sp.csr_matrix(np.diag([1.0, 2.0, 1.5, 1.2])), sp.csr_matrix(random.random((4, 9)))
    many = JumpMap(MortarProjection(SurfaceMass(mass), mixed), random.normal(size=(4, 2, D)))
    equal = MortarProjection(SurfaceMass(sp.csr_matrix(2.0 * np.eye(2))), sp.csr_matrix(2.0 * np.eye(2)))
    few = JumpMap(equal, random.normal(size=(2, 2, D)))
    return [MappedNodes(2, random.permutation(ring.size)[:9], many), MappedNodes(0, np.array([13, 2]), few)]


def of_jumps(ring: TwoLevelRing, exact: Floats, parts: Sequence[MappedNodes]) -> Floats:
    """E C Eᵀ of the parts' maps E, written out."""
    dofs = np.concatenate([dofs_of(np.column_stack([0 * p.nodes + p.tooth, p.nodes]), ring.size) for p in parts])
    E = sp.block_diag([part.jumps(np.eye(D * len(part.nodes))) for part in parts]).toarray()
    return np.asarray(E @ exact[np.ix_(dofs, dofs)] @ E.T)


def test_products_between_mapped_nodes() -> None:
    """Jumps of two teeth under forces on both, in double and in single precision, and of the first component alone."""
    ring, exact = two_levels()
    parts = mapped(ring)
    A = of_jumps(ring, exact, parts)
    window, f = ring.jumps(parts), np.random.default_rng(3).normal(size=(6, 2))
    assert window.times(f).ravel() == pytest.approx(A @ f.ravel(), rel=1e-11)
    single = window.times(f.astype(np.float32))
    assert single.dtype == np.float32
    assert single.ravel() == pytest.approx(A @ f.ravel(), abs=1e-5 * np.abs(A @ f.ravel()).max())
    assert window.normal().times(f[:, :1]).ravel() == pytest.approx(A[::2, ::2] @ f[:, 0], rel=1e-11)


def test_modes_that_teeth_share() -> None:
    """With all modes kept, U K Uᵀ between nodes of different teeth is the compliance there."""
    ring, exact = two_levels()
    parts = mapped(ring)
    A = of_jumps(ring, exact, parts)
    rough = ring.jumps(parts).nearly()
    found = rough.modes * rough.couplings @ rough.modes.T
    assert found[:8, 8:] == pytest.approx(A[:8, 8:], abs=3e-3 * np.abs(A).max())
    assert [block.shape for block in rough.blocks] == [(4, 4), (2, 2)]


def test_normal_components_of_a_tooth() -> None:
    """Problem: one tooth, all of whose nodes have one normal, and jumps of a mortar projection along it. Exact: blocks
    and modes are the compliance of the normal components, but for modes that are a thousandth of the largest."""
    n = np.array([0.6, 0.0, 0.8])
    ring, exact = two_levels(n)
    random = np.random.default_rng(4)
    projection = MortarProjection(
        SurfaceMass(sp.csr_matrix(np.diag([1.0, 2.0, 1.5, 1.2]))), sp.csr_matrix(random.random((4, 9))))
    part = MappedNodes(0, random.permutation(ring.size)[:9], JumpMap(projection, np.tile(n, (4, 1, 1))))
    rough = NearlyNormal.sum([ring.jumps([part]).nearly()])
    found = rough.blocks[0] + rough.modes * rough.couplings @ rough.modes.T
    A = of_jumps(ring, exact, [part])
    assert found == pytest.approx(A, abs=2e-3 * np.abs(A).max())
