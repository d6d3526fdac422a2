"""The contact law at a point: positive part, projection onto the friction disc, and their derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evolvent.contact.nitsche.coulomb import LawValues, coulomb, starting_guess
from evolvent_meshes.arrays import Floats


def _trials(d: int, n: int = 400, seed: int = 0) -> Floats:
    """Random trial values away from the kinks by 1e-3, open, sticking and sliding."""
    rng = np.random.default_rng(seed)
    trial = rng.normal(size=(4 * n, d)) * ([1.0] + [0.5] * (d - 1))
    size = np.linalg.norm(trial[:, 1:], axis=1)
    return trial[(np.abs(trial[:, 0]) > 1e-3) & (np.abs(size - 0.3 * np.maximum(trial[:, 0], 0.0)) > 1e-3)][:n]


def _differences(law: Callable[[Floats], LawValues], trial: Floats, step: float = 1e-6) -> Floats:
    columns = []
    for k in range(trial.shape[1]):
        shift = np.zeros(trial.shape[1])
        shift[k] = step
        columns.append((law(trial + shift).traction - law(trial - shift).traction) / (2.0 * step))
    return np.stack(columns, axis=2)


@pytest.mark.parametrize("d", [1, 2, 3])
def test_derivative_of_coulombs_law(d: int) -> None:
    """∂(λ, τ)/∂(p, q) against central differences, 1e-6 relative."""
    trial = _trials(d)
    exact = _differences(lambda t: coulomb(t, 0.3), trial)
    assert np.abs(coulomb(trial, 0.3).derivative - exact).max() < 1e-6 * np.abs(exact).max()


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("known", [False, True])
def test_derivative_of_the_starting_guess(d: int, known: bool) -> None:
    """The same for the law of the first iteration, sticking and with a known direction of slip."""
    trial = _trials(d)
    heading = np.zeros((len(trial), d - 1))
    heading[:, 0] = 1.0 if known else 0.0
    exact = _differences(lambda t: starting_guess(t, 0.3, heading), trial)
    assert np.abs(starting_guess(trial, 0.3, heading).derivative - exact).max() < 1e-6 * np.abs(exact).max()


def test_coulombs_law_when_open_sticking_and_sliding() -> None:
    """Open: no traction. Sticking: τ = q. Sliding: |τ| = μλ along q. One point each, by hand."""
    trial = np.array([[-1.0, 5.0, 5.0], [2.0, 0.3, -0.4], [2.0, 3.0, 4.0]])
    law = coulomb(trial, 0.5)
    assert np.allclose(law.traction, np.array([[0.0, 0.0, 0.0], [2.0, 0.3, -0.4], [2.0, 0.6, 0.8]]), atol=1e-15)


@pytest.mark.parametrize("d", [2, 3])
def test_traction_stays_inside_the_friction_cone(d: int) -> None:
    """λ ≥ 0 and |τ| ≤ μλ for any trial value, also with a coefficient for each point."""
    trial = np.random.default_rng(1).normal(size=(1000, d))
    μ = np.linspace(0.0, 1.0, 1000)
    traction = coulomb(trial, μ).traction
    assert traction[:, 0].min() >= 0.0
    assert np.all(np.linalg.norm(traction[:, 1:], axis=1) <= μ * traction[:, 0] * (1.0 + 1e-14))


def test_sliding_traction_is_friction_times_pressure() -> None:
    """With μ > 0 a point far beyond its limit slides with exactly μλ; a μ that is taken as zero anywhere fails."""
    law = coulomb(np.array([[10.0, 1e6]]), 0.07)
    assert law.traction[0, 1] == pytest.approx(0.7, rel=1e-14)
    assert coulomb(np.array([[10.0, 1e6]]), 0.0).traction[0, 1] == 0.0
