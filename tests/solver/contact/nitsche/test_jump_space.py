"""Projections of two surfaces onto a space of its own for the jump between them."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.nitsche.jump_space import JumpSpace
from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent.fem.lagrange import quadrature, tabulate
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints
from tests.support.meshes.surface_shapes import lattice, rectangle

WIDTH = 1.3
"""Usual width of the surfaces [mm]. The space is 2 mm wide, of two cells, so that 0.7 mm of one lie beyond them."""


def rows(surface: Surface, facets: Ints, xi: Floats) -> sp.csr_matrix:
    """Shape functions (q, n) at points of facets."""
    N = tabulate(surface.shape, surface.order, xi)[0]
    q, k = N.shape
    return sp.csr_matrix((N.ravel(), surface.facets[facets].ravel(), k * np.arange(q + 1)), (q, len(surface.points)))


def projected(width: float = WIDTH) -> tuple[JumpSpace, list[MortarProjection], tuple[Surface, Surface]]:
    """The space, and the projections of a surface of 13 × 2 facets and of one of a single facet."""
    cells = lattice(2, 1, "quadrilateral", 2, rectangle((0.0, 0.0), (2.0, 1.0)))
    fine, coarse = (
        lattice(*count, "quadrilateral", 2, rectangle((0.0, 0.0), (width, 1.0))) for count in ((13, 2), (1, 1))
    )
    xi, w = quadrature("quadrilateral", 6)
    facets = np.repeat(np.arange(26), len(w))
    points, at = np.tile(xi, (26, 1)), fine.positions(np.arange(26), np.tile(xi, (26, 1, 1))).reshape(-1, 3)
    cell = (at[:, 0] > 1.0).astype(int)
    shape = rows(cells, cell, np.column_stack([at[:, 0] - cell, at[:, 1]]))
    mass = SurfaceMass.of(cells, np.arange(2), np.arange(len(cells.points))).matrix
    space = JumpSpace(np.tile(np.eye(3), (len(cells.points), 1, 1)), cells.points, shape, mass)
    trace = rows(coarse, np.zeros(len(at), dtype=int), at[:, :2] / [width, 1.0])
    sides = (fine, rows(fine, facets, points)), (coarse, trace)
    return space, space.projections(np.tile(w, 26) * width / 26.0, *sides), (fine, coarse)


def test_fields_that_all_spaces_have_are_kept() -> None:
    """Problem: u = 1 + x − 2 y + x y on either surface. Exact: the same at the nodes of cells on the surfaces, up to
    the weight of the part beyond; a constant everywhere. Both are solved with one mass matrix."""
    space, (first, second), surfaces = projected()
    assert first.mass is second.mass
    for side, surface in zip((first, second), surfaces):
        x, y = surface.points[:, 0], surface.points[:, 1]
        found, (X, Y) = side @ np.asarray(1.0 + x - 2.0 * y + x * y), space.points[:, :2].T
        on = X <= 1.0
        assert found[on] == pytest.approx((1.0 + X - 2.0 * Y + X * Y)[on], abs=1e-4)
        assert side @ np.ones(len(x)) == pytest.approx(np.ones(len(X)), abs=1e-9)


@pytest.mark.parametrize("width", [1.005, 1.02, WIDTH])
def test_nodes_beyond_a_surface_have_finite_values(width: float) -> None:
    """Problem: √(1 − x/width), from 1 to 0 at the edge of the surfaces, where it is steep; they have a part of the
    second cell, or next to none. Right: at nodes beyond the edge no value is more than a few times as large. Without a
    weight beyond the surfaces there is no solution, or one a thousand times as large."""
    _, (side, _), (fine, _) = projected(width)
    assert np.abs(side @ np.sqrt(np.maximum(1.0 - fine.points[:, 0] / width, 0.0))).max() < 4.0
