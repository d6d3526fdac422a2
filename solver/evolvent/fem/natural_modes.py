"""Natural modes of a body, held or floating."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh

from evolvent.fem.mean_axes import MeanAxes
from evolvent_meshes.arrays import Floats

MOST = 0.3
"""Fraction of all modes from which on the dense eigenproblem is solved."""


@dataclass(frozen=True)
class NaturalModes:
    """The lowest m modes of n degrees of freedom."""

    frequencies: Floats
    """Natural frequencies ω (m,), ascending [rad/s]."""
    shapes: Floats
    """Mode shapes w (n, m) with wᵀ M̂ w = 1 [t^(−1/2)]."""


def natural_modes(
    stiffness: sp.csr_matrix, axes: MeanAxes, solve: Callable[[Floats], Floats], count: int
) -> NaturalModes:
    """The lowest modes of K w = ω² M̂ w.

    stiffness: K (n, n) on the free degrees of freedom [N/mm].
    axes: the body's inertia.
    solve: K⁻¹ times vectors (n,).
    count: how many; all where there are fewer.
    """
    n = stiffness.shape[0]
    if not count:
        return NaturalModes(np.zeros(0), np.zeros((n, 0)))
    if count > MOST * n:
        values, shapes = eigh(stiffness.toarray(), axes.times(np.eye(n)))
        return NaturalModes(np.sqrt(values[:count]), shapes[:, :count])
    mass = LinearOperator((n, n), axes.times, dtype=float)
    inverse = LinearOperator((n, n), solve, dtype=float)
    start = np.random.default_rng(1).standard_normal(n)  # ARPACK's own would differ from run to run
    values, shapes = eigsh(stiffness, count, M=mass, sigma=0.0, OPinv=inverse, v0=start)
    order = np.argsort(values)
    return NaturalModes(np.sqrt(values[order]), shapes[:, order])
