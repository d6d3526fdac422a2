"""GMRES for products."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest

from evolvent.contact.newton.krylov import gmres
from evolvent_meshes.arrays import Floats

N = 40


def matrix() -> Floats:
    """Diagonally dominant, not symmetric."""
    return np.diag(np.linspace(1.0, 9.0, N)) + 0.3 * np.random.default_rng(1).normal(size=(N, N)) / np.sqrt(N)


@pytest.mark.parametrize(("dtype", "relative"), [(np.float64, 1e-10), (np.float64, 1e-3), (np.float32, 1e-4)])
def test_residual_is_as_small_as_wanted(dtype: type, relative: float) -> None:
    """T y = b with the diagonal as a preconditioner: |b − T y| ≤ relative |b|, in the precision of b."""
    T: Floats = matrix().astype(dtype)
    b: Floats = np.random.default_rng(2).normal(size=N).astype(dtype)
    diagonal = np.diag(T).copy()
    y, reached = gmres(lambda v: T @ v, lambda v: v / diagonal, b, relative, N)
    assert reached and y.dtype == dtype
    assert np.linalg.norm(b - T @ y) <= 1.01 * relative * np.linalg.norm(b)


def test_exact_preconditioner_needs_one_iteration_and_too_few_are_said() -> None:
    """With T⁻¹ as its preconditioner one iteration is enough; without one, three are too few, which is not silent."""
    T, b = matrix(), np.random.default_rng(3).normal(size=N)
    inverse = np.linalg.inv(T)
    y, reached = gmres(lambda v: T @ v, lambda v: inverse @ v, b, 1e-8, 1)
    assert reached and np.allclose(T @ y, b, atol=1e-8)
    assert not gmres(lambda v: T @ v, lambda v: v, b, 1e-8, 3)[1]


def test_exceptions_of_products_pass() -> None:
    """A product that fails: its own exception, not a crash of PETSc."""

    def failing(_: Floats) -> Floats:
        raise ArithmeticError("as the test wants")

    for times, inverse in ((failing, lambda v: v), (lambda v: v, failing)):
        with pytest.raises(ArithmeticError, match="as the test wants"):
            gmres(times, inverse, np.ones(N), 1e-8, 10)


def test_nothing_is_held_afterwards() -> None:
    """The product, and with it all that it has, such as a compliance, is free once GMRES has returned."""

    class Doubling:
        def __call__(self, v: Floats) -> Floats:
            return 2.0 * v

    times = Doubling()
    gmres(times, lambda v: v, np.ones(N), 1e-8, 10)
    held = weakref.ref(times)
    del times
    gc.collect()
    assert held() is None
