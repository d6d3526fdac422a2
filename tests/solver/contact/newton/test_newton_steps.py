"""Newton steps: accuracy, and reuse of factors from step to step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent import NotConverged
from evolvent.contact.newton import newton_steps
from evolvent.contact.newton.jump_compliance import DenseCompliance
from evolvent.contact.newton.newton_steps import NewtonSteps
from evolvent.contact.newton.reduced_tangent import FreeMotions, ReducedTangent
from evolvent.contact.newton.tangent import Tangent
from evolvent_meshes.arrays import Floats, Ints, Reals

N, K = 60, 3
RNG = np.random.default_rng


def compliance() -> DenseCompliance:
    """A (m, m) of 60 nodes in a row on a soft body: 1/(1 + distance) between equal components, m = 180."""
    place = np.arange(N)
    return DenseCompliance(np.kron(1.0 / (1.0 + np.abs(place[:, None] - place)), np.eye(K)), K)


def motion(resistance: float = 0.0) -> FreeMotions:
    """H (m, 1): all nodes along their normals; D (1, 1)."""
    return FreeMotions(np.tile([1.0, 0.0, 0.0], N)[:, None].copy(), np.array([[resistance]]))


def sliding(first: int, last: int, friction: float, tangential: float = 0.01, resistance: float = 0.0) -> Tangent:
    """T where the nodes from `first` to before `last` slide, stiffness 5, with tangential derivatives that are small
    beside it and left out."""
    block = np.array([[1.0, 0.0, 0.0], [friction, 0.0, 0.0], [0.0, 0.0, tangential]])
    M = sp.csr_matrix(sp.kron(sp.diags(5.0 * ((np.arange(N) >= first) & (np.arange(N) < last))), block))
    M.eliminate_zeros()
    return Tangent(M, compliance(), motion(resistance), K * np.arange(first, last), whole=False)


def dense(tangent: Tangent) -> Floats:
    """[I + M A, −M H; Hᵀ, D]."""
    M, A, H = tangent.M.toarray(), tangent.A.matrix, tangent.motions.jumps
    assert A is not None
    return np.block([[np.eye(len(A)) + M @ A, -M @ H], [H.T, tangent.motions.resistance]])


def error(tangent: Tangent, found: Floats, right: Floats) -> float:
    """Residual of T y = b over |b|."""
    return float(np.linalg.norm(right - dense(tangent) @ found) / np.linalg.norm(right))


@pytest.fixture
def factored(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """Precision and number of columns of each factor made."""
    made: list[tuple[str, int]] = []
    original = ReducedTangent.of

    def counted(M: sp.csr_matrix, A: Reals, motions: FreeMotions, columns: Ints) -> ReducedTangent:
        made.append((A.dtype.name, len(columns)))
        return original(M, A, motions, columns)

    monkeypatch.setattr(ReducedTangent, "of", staticmethod(counted))
    return made


@pytest.mark.parametrize("resistance", [0.0, 0.7, 300.0])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-7, 1e-11])
def test_newton_step_is_as_accurate_as_wanted(accuracy: float, resistance: float) -> None:
    """A random right-hand side: T y = b within the accuracy, also beyond that of single precision; with a free motion
    that contact alone holds, and with one that has inertia."""
    right = RNG(1).normal(size=N * K + 1)
    tangent = sliding(20, 40, 0.2, resistance=resistance)
    found = NewtonSteps(tangent.A, tangent.motions).solve(tangent, right, accuracy)
    assert error(tangent, found, right) <= 1.1 * accuracy


def test_zero_residual_gives_a_zero_step() -> None:
    """T y = 0: y = 0 exactly."""
    tangent = sliding(20, 40, 0.2)
    assert not NewtonSteps(tangent.A, tangent.motions).solve(tangent, np.zeros(N * K + 1), 1e-7).any()


def test_factor_is_reused_for_a_similar_tangent(factored: list[tuple[str, int]]) -> None:
    """Three friction coefficients at which the same nodes touch: one factor of their normal columns, and every step is
    as accurate as wanted. When other nodes touch as well, a second factor is made."""
    steps = NewtonSteps(compliance(), motion())
    for friction in (0.1, 0.15, 0.2):
        tangent = sliding(20, 40, friction)
        right = tangent.M @ RNG(2).normal(size=N * K)
        assert error(tangent, steps.solve(tangent, np.append(right, 1.0), 1e-8), np.append(right, 1.0)) < 1e-8
    assert factored == [("float32", 20)]
    tangent = sliding(18, 40, 0.2)
    right = np.append(tangent.M @ RNG(3).normal(size=N * K), 1.0)
    assert error(tangent, steps.solve(tangent, right, 1e-8), right) < 1e-8
    assert factored == [("float32", 20), ("float32", 22)]


def test_factor_of_a_dissimilar_tangent_is_replaced(factored: list[tuple[str, int]]) -> None:
    """All nodes touch, then only every third: GMRES does not converge with the first factor, a second one is made."""
    steps = NewtonSteps(compliance(), motion())
    whole = sliding(0, N, 0.1)
    right = np.append(whole.M @ RNG(4).normal(size=N * K), 1.0)
    steps.solve(whole, right, 1e-8)
    some = sp.diags(np.repeat(np.arange(N) % 3 == 0, K).astype(float))
    tangent = Tangent(sp.csr_matrix(whole.M @ some), whole.A, whole.motions, K * np.arange(0, N, 3), whole=False)
    assert error(tangent, steps.solve(tangent, right, 1e-8), right) < 1e-8
    assert factored == [("float32", N), ("float32", N // 3)]


def test_all_columns_are_factored_where_iterations_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    """GMRES that always fails: the step comes from a factor of all columns, exact to rounding."""
    monkeypatch.setattr(newton_steps, "gmres", lambda times, inverse, right, *_: (np.zeros_like(right), False))
    tangent = sliding(20, 40, 0.2)
    right = RNG(5).normal(size=N * K + 1)
    assert error(tangent, NewtonSteps(tangent.A, tangent.motions).solve(tangent, right, 1e-2), right) < 1e-13


def test_reduced_tangent_with_all_columns_is_the_inverse() -> None:
    """With all columns that hold anything, T times its inverse is the identity to 1e-13; where nothing touches, a free
    motion meets no resistance: said so; one with inertia does, Hᵀ b + D δ = c."""
    tangent = sliding(20, 40, 0.2)
    right = RNG(6).normal(size=N * K + 1)
    assert error(tangent, tangent.solve(right), right) < 1e-13
    nothing = Tangent(0.0 * tangent.M, tangent.A, tangent.motions, tangent.kept, whole=True)
    with pytest.raises(NotConverged, match="no resistance"):
        nothing.solve(right)
    flying = replace(nothing, motions=motion(4.0))
    force, load = np.split(right, [N * K])
    known = np.append(force, (load - flying.motions.jumps.T @ force) / 4.0)
    assert flying.solve(right) == pytest.approx(known, rel=1e-12)

