"""Mesh harmonics of quantities that repeat with the mesh."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats

COUNT = 5
"""Number of mesh harmonics that are reported."""


def mesh_harmonics(values: Floats, count: int = COUNT) -> tuple[Floats, Floats]:
    """Amplitudes (count,) and phases (count,) [rad] of the mesh harmonics 1, 2, ... of values (n,) at equidistant
    phases of a mesh period: values = mean + Σ A_r cos(2π r τ + ψ_r).

    Raises ValueError where n < 2·count + 1: the values do not hold so many.
    """
    n = len(values)
    if n < 2 * count + 1:
        raise ValueError(f"{count} mesh harmonics: wanted at least {2 * count + 1} positions of the pitch, found {n}")
    terms = np.fft.rfft(values)[1 : count + 1] * (2.0 / n)
    return np.abs(terms), np.angle(terms)
