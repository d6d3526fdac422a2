"""Scatter of the largest pressure of a contact: its distance from a smooth fit of the pressures around it.

A mesh can have enough cells and still give a pressure that jumps from facet to facet: with cells of order 1, which
replace a curved surface by a polygon; where the sag of a coarse cell is not small against an interference; in nearly
incompressible bodies; or where the pressure is singular and has no peak.

A parabola is fitted by least squares to the square of the pressure at the points of a facet and its neighbours. The
square is used because the pressure between smooth bodies rises like a square root from the edge of contact; the square
of Hertz' pressure is a parabola everywhere. A wave as short as the cells does not fit a parabola over three of them.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.problem.user_warnings import warn_user
from evolvent.contact.step.paired_surfaces import PairedSurfaces
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints

SCATTER_LIMIT = 0.05
"""Scatter, over the peak pressure, above which peaks were off by 3 to 75 %; below it, from two cells across on, they
were off by at most 3 %."""


class ScatteredPressureWarning(UserWarning):
    """The largest pressure of a contact lies far from the pressures around it: it is off by about as much, or more."""


def peak_scatter(paired: PairedSurfaces, pressure: Floats) -> float:
    """Largest distance of the peak of the pressure (q,) from the parabolas fitted around it, over the peak; 0 where
    nothing presses."""
    pressed = np.flatnonzero(pressure > 0.0)
    if not len(pressed):
        return 0.0
    surface, facet = paired.placed[0], paired.pairing.facet1[pressed]
    points, weights, p = paired.operator.points[pressed], paired.operator.weights[pressed], pressure[pressed]
    peak = int(np.argmax(p))
    distances = []
    for middle in _touching(surface, facet[peak : peak + 1]):
        near = np.flatnonzero(np.isin(facet, _touching(surface, np.array([middle]))))
        if peak in near:
            smooth = parabola(points[near], weights[near], p[near] ** 2)[np.searchsorted(near, peak)]
            distances.append(abs(p[peak] - np.sqrt(max(smooth, 0.0))))
    return float(max(distances) / p[peak])


def _touching(surface: Surface, facets: Ints) -> Ints:
    """Facets that share a node with these, themselves included."""
    nodes = np.unique(surface.facets[facets])
    return np.flatnonzero(np.isin(surface.facets, nodes).any(axis=1))


def parabola(points: Floats, weights: Floats, values: Floats) -> Floats:
    """Values (m,) of a quadratic function along the surface that is fitted to values (m,) at points (m, d), with
    quadrature weights (m,); negative weights count as 0."""
    away = points - points.mean(axis=0)
    along = away @ np.linalg.svd(away, full_matrices=False)[2][: points.shape[1] - 1].T
    along = along / max(float(np.abs(along).max()), 1e-300)
    terms = [np.ones(len(points)), *along.T]
    terms += [along[:, i] * along[:, j] for i in range(along.shape[1]) for j in range(i + 1)]
    rows, root = np.stack(terms, axis=1), np.sqrt(np.maximum(weights, 0.0))
    return np.asarray(rows @ np.linalg.lstsq(root[:, None] * rows, root * values, rcond=None)[0])


def warn_if_scattered(name: str, scatter: float) -> None:
    """Warns by a ScatteredPressureWarning of a scatter beyond SCATTER_LIMIT. name: name of the contact."""
    if scatter > SCATTER_LIMIT:
        warn_user(
            f"{name}: wanted a largest pressure within {SCATTER_LIMIT:.0%} of a smooth course of the pressures around "
            f"it, found it {scatter:.0%} off, and it may be off the true one by more. Refine both surfaces there, with "
            "cells of order 2, and see whether it stays; at the edge of a flat face it is infinite, and grows with "
            "each mesh",
            ScatteredPressureWarning,
        )
