"""Error of the stress below the flanks by half-ellipses in place of the pressures as solved."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evolvent.strength.fatigue.criteria import largest_shear
from evolvent.strength.fatigue.flank_loads import LoadedPosition
from evolvent.strength.fatigue.half_plane import HertzTractions, LineForces, plane_strain
from evolvent_meshes.arrays import Floats

PLACES, DEPTHS = np.linspace(-1.5, 1.5, 61), np.array([0.6, 0.8, 1.0, 1.3])
"""Places and depths in half-widths, around the largest shear stress of a line contact, at 0.786 below its middle."""


def shear_differences(positions: Sequence[LoadedPosition], inner: tuple[float, float], poisson: float) -> Floats:
    """Largest shear stress below each slice under the forces of the contact solution over that under the fitted
    half-ellipse, less 1 (n,). inner: see `RunData.inner_path`."""
    pairs = [pair for position in positions for pair in position.solved_and_fitted(inner)]
    found = [_largest(solved, fitted, poisson) / _largest(fitted, fitted, poisson) for solved, fitted in pairs]
    return np.array(found) - 1.0


def _largest(tractions: LineForces | HertzTractions, scale: HertzTractions, poisson: float) -> float:
    x, z = (each.ravel() * scale.half_width for each in np.meshgrid(PLACES, DEPTHS))
    return float(largest_shear(plane_strain(tractions.stress(x, z), poisson)).max())
