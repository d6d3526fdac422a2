"""Newton steps with a compliance that is known by products, against the same as a matrix.

Two contacts of 30 nodes in rows on soft bodies, coupled by three smooth modes; in each, a few nodes touch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.newton import newton_steps
from evolvent.contact.newton.applied_compliance import AppliedCompliance, summed, with_modes
from evolvent.contact.newton.block_inverse import BlockInverse, NearlyNormal, RoughContacts, few_modes
from evolvent.contact.newton.jump_compliance import DenseCompliance
from evolvent.contact.newton.newton_steps import NewtonSteps
from evolvent.contact.newton.reduced_tangent import FreeMotions
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tangent import Tangent
from evolvent_meshes.arrays import Bools, Floats, Reals

N, HALF = 60, 30
RNG = np.random.default_rng


def exact(k: int) -> Floats:
    """A (m, m): 1/(1 + distance) within each contact, less between components, and the modes."""
    place = np.arange(N)
    near = (place[:, None] < HALF) == (place < HALF)
    A = near / (1.0 + np.abs(place[:, None] - place))
    components = np.eye(k) + 0.1 * (1.0 - np.eye(k))
    modes, coupling = smooth(k)
    return np.asarray(np.kron(A, components) + modes * coupling @ modes.T)


def smooth(k: int) -> tuple[Floats, Floats]:
    """U (m, 3), K (3,)."""
    x = np.linspace(-1.0, 1.0, N)
    return np.kron(np.stack([np.ones(N), x, x**2], axis=1), np.ones((k, 1))), np.array([0.5, -0.2, 0.1])


@dataclass(frozen=True)
class Surface:
    """One of two equal bodies: half of the compliance."""

    k: int

    def times(self, force: Reals) -> Reals:
        return np.asarray((0.5 * exact(self.k)).astype(force.dtype) @ force.ravel()).reshape(force.shape)

    def normal(self) -> Surface:
        return Surface(1)

    nbytes = 0

    def nearly(self) -> NearlyNormal:
        """The normal components of each contact, without what couples them to others."""
        place = np.arange(HALF)
        block = (0.5 / (1.0 + np.abs(place[:, None] - place))).astype(np.float32)
        modes, coupling = smooth(self.k)
        return NearlyNormal((block, block), modes, 0.5 * coupling)


def applied(k: int) -> AppliedCompliance:
    found = summed([Surface(k), Surface(k)], k)
    assert isinstance(found, AppliedCompliance)
    return found


def touching() -> Bools:
    place = np.arange(N)
    return np.asarray(((place > 8) & (place < 22)) | ((place > 40) & (place < 50)))


def tangent(
    A: AppliedCompliance | DenseCompliance, k: int, friction: float = 0.2, sticks: float = 0.0, resistance: float = 0.0
) -> Tangent:
    """T where nodes touch, stiffness 5: they slide, and the last contact's first nodes stick; D (1, 1) is given."""
    block = np.array([[1.0, 0.0, 0.0], [friction, 0.0, 0.0], [0.0, 0.0, 0.01]])[:k, :k]
    on = touching()
    M = sp.csr_matrix(sp.kron(sp.diags(5.0 * on), block))
    kept = [k * np.flatnonzero(on)]
    if sticks:
        stuck = k * np.array([41, 42, 43])[:, None] + np.arange(1, k)
        M = M + sp.csr_matrix(sp.diags(np.bincount(stuck.ravel(), minlength=N * k) * sticks))
        kept.append(stuck.ravel())
    M.eliminate_zeros()
    H = np.tile(np.eye(k)[0], N)[:, None].copy()
    return Tangent(M, A, FreeMotions(H, np.array([[resistance]])), np.sort(np.concatenate(kept)), whole=k == 1)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-9])
@pytest.mark.parametrize(("k", "sticks", "resistance"), [(1, 0.0, 0.0), (3, 0.0, 0.0), (3, 4.0, 0.0), (3, 4.0, 9.0)])
def test_newton_step_is_that_of_the_matrix(k: int, sticks: float, resistance: float, accuracy: float) -> None:
    """T y = b to the accuracy, with a free motion, also where nodes stick, and with inertia."""
    T = tangent(applied(k), k, sticks=sticks, resistance=resistance)
    right = np.append(T.M @ RNG(1).normal(size=N * k), 3.0)
    found = NewtonSteps(T.A, T.motions).solve(T, right, accuracy)
    A, H = exact(k), T.motions.jumps
    dense = np.block([[np.eye(N * k) + T.M @ A, -(T.M @ H)], [H.T, T.motions.resistance]])
    assert np.linalg.norm(right - dense @ found) <= 1.1 * accuracy * np.linalg.norm(right)


@pytest.mark.parametrize("k", [1, 3])
def test_all_columns_are_factored_where_iterations_fail(k: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """GMRES that always fails: the step comes from a matrix that is made of products, exact to rounding; with more
    active unknowns than it may have, an error says so."""
    monkeypatch.setattr(newton_steps, "gmres", lambda times, inverse, right, *_: (np.zeros_like(right), False))
    T = tangent(applied(k), k, friction=1.0)
    steps, same = NewtonSteps(T.A, T.motions), tangent(DenseCompliance(exact(k), k), k, friction=1.0)
    few, every = np.append(T.M @ RNG(7).normal(size=N * k), 3.0), RNG(8).normal(size=N * k + 1)
    for right in (few, 2.0 * few, every):  # the last has more active unknowns
        found = steps.solve(T, right, 1e-2)
        assert np.linalg.norm(right - same.times(found)) < 1e-12 * np.linalg.norm(right)
    assert k * np.count_nonzero(touching()) < N * k
    monkeypatch.setattr(newton_steps, "MOST_COLUMNS", 2)
    with pytest.raises(NotConverged, match="at most 2 active unknowns"):
        NewtonSteps(T.A, T.motions).solve(T, few, 1e-2)


@pytest.mark.parametrize("resistance", [0.0, 9.0])
def test_rough_inverse_is_exact_without_friction(resistance: float) -> None:
    """k = 1, where the rough compliance is A itself: the inverse to single precision. Other blocks are left out."""
    T = tangent(applied(1), 1, resistance=resistance)
    unknowns = np.flatnonzero(touching())
    rough = RoughContacts.of(applied(1).rough, unknowns)
    motions = T.motions.of(unknowns, float)
    inverse = BlockInverse(rough, T.M[unknowns][:, unknowns], motions, np.arange(len(unknowns)))
    A, M, H = exact(1)[np.ix_(unknowns, unknowns)], T.M[unknowns][:, unknowns].toarray(), motions.jumps
    dense = np.block([[np.eye(len(A)) + M @ A, -M @ H], [H.T, motions.resistance]])
    right = RNG(2).normal(size=len(unknowns) + 1)
    assert dense @ inverse.solve(right) == pytest.approx(right, abs=1e-4)


def test_rough_inverse_where_nothing_touches() -> None:
    """M = 0: f = b, and what resists the free motion takes what they leave of the load."""
    unknowns, H = np.arange(3, 7), np.ones((4, 1))
    rough = RoughContacts.of(applied(1).rough, unknowns)
    motions, none = FreeMotions(H, np.array([[2.0]])), np.zeros(0, dtype=int)
    inverse = BlockInverse(rough, sp.csr_matrix((4, 4), dtype=np.float32), motions, none)
    found = inverse.solve(np.array([1.0, 2.0, 3.0, 4.0, 30.0]))
    assert found == pytest.approx([1.0, 2.0, 3.0, 4.0, 10.0], rel=1e-6)


def test_few_modes_are_those_of_large_amounts() -> None:
    """Modes of which two are alike, one is nought and one is small, some amounts negative: two orthogonal ones are left
    and the sum U K Uᵀ is good to what was left out."""
    random = RNG(3)
    a, b, c = random.normal(size=(3, N))
    modes, couplings = np.stack([a, b, 2.0 * b, np.zeros(N), c], axis=1), np.array([1.0, -3.0, 0.5, 1.0, 1e-5])
    found, amounts = few_modes(modes, couplings)
    assert found.shape == (N, 2)
    assert found.T @ found == pytest.approx(np.eye(2), abs=1e-12)
    left = modes * couplings @ modes.T - found * amounts @ found.T
    assert np.abs(left).max() <= 1.1 * 1e-5 * np.abs(np.outer(c, c)).max()


def test_products_and_normal_components() -> None:
    """A f in both precisions, and A of the normal components alone."""
    A, f = applied(3), RNG(3).normal(size=3 * N)
    assert A.times(f) == pytest.approx(exact(3) @ f, rel=1e-12)
    assert A.active(np.arange(7)).times(f[:7].astype(np.float32)) == pytest.approx(exact(3)[:7, :7] @ f[:7], rel=1e-4)
    assert A.normal().times(f[:N]) == pytest.approx(exact(1) @ f[:N], rel=1e-12)


@pytest.mark.parametrize("k", [1, 3])
def test_modes_are_added(k: int) -> None:
    """A − Φ diag(s) Φᵀ with two smooth modes that take half of what is smooth away: its products, those of its normal
    components, and a Newton step, of a matrix and of products alike."""
    modes, coupling = smooth(k)
    Φ, s = modes[:, [0, 2]], 0.5 * coupling[[0, 2]]
    wanted = exact(k) - (Φ * s) @ Φ.T
    for A in (with_modes(applied(k), Φ, -s), with_modes(DenseCompliance(exact(k), k), Φ, -s)):
        f = RNG(4).normal(size=k * N)
        assert A.times(f) == pytest.approx(wanted @ f, rel=1e-12)
        assert A.normal().times(f[:N]) == pytest.approx(wanted[::k, ::k] @ f[:N], rel=1e-12)
        assert isinstance(A, AppliedCompliance | DenseCompliance)
        T = tangent(A, k)
        right = np.append(T.M @ f, 3.0)
        found = NewtonSteps(T.A, T.motions).solve(T, right, 1e-9)
        H = T.motions.jumps
        dense = np.block([[np.eye(N * k) + T.M @ wanted, -(T.M @ H)], [H.T, T.motions.resistance]])
        assert np.linalg.norm(right - dense @ found) <= 1.1e-9 * np.linalg.norm(right)
    assert with_modes(applied(k), Φ[:, :0], s[:0]).times(f) == pytest.approx(exact(k) @ f, rel=1e-12)


def test_memory_is_that_of_its_parts() -> None:
    """A matrix of 60 × 60 doubles; products: the rough matrix, and the modes that are added."""
    A, modes = applied(1), np.ones((N, 2))
    assert DenseCompliance(exact(1), 1).nbytes == 8 * N**2
    assert A.nbytes == A.rough.nbytes > 4 * 2 * HALF**2
    assert with_modes(A, modes, np.array([0.1, 0.1])).nbytes >= A.nbytes + modes.nbytes


def test_what_cannot_be_solved_or_summed_is_refused() -> None:
    """Nothing touches, and a motion is free: no step. Matrices beside products have no sum."""
    T = tangent(applied(1), 1)
    nothing = Tangent(0.0 * T.M, T.A, T.motions, T.kept, whole=True)
    with pytest.raises(NotConverged):
        NewtonSteps(T.A, T.motions).solve(nothing, np.append(np.zeros(N), 1.0), 1e-3)
    with pytest.raises(ValueError, match="all matrices or all products"):
        summed([exact(1), Surface(1)], 1)
    assert isinstance(summed([exact(1), exact(1)], 1), DenseCompliance)
