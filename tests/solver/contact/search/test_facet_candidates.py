"""Candidates of the pairing: none missed and few too many, however deep the surfaces are looked into."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.contact.search import facet_candidates as module
from evolvent.contact.search.facet_candidates import facet_candidates
from evolvent.fem.surface import Surface
from tests.support.meshes.surface_shapes import cap, facing, lattice, rectangle

COUNT = 12
DEEP = 1.0  # mm, ten facets


def plates(apart: float) -> tuple[Surface, Surface]:
    """Squares of 0.1 mm that lie opposite each other, the second plate so far above the first."""
    low, high = (0.0, 0.0), (0.1 * COUNT, 0.1 * COUNT)
    below = lattice(COUNT, COUNT, "quadrilateral", 2, rectangle(low, high))
    return below, facing(lattice(COUNT, COUNT, "quadrilateral", 2, rectangle(low, high, 0.0, apart)))


def caps() -> tuple[Surface, Surface]:
    """Concentric caps with different meshes, 0.05 mm apart."""
    first = lattice(9, 8, "quadrilateral", 2, cap(3.0, 0.3))
    return first, facing(lattice(7, 6, "triangle", 2, cap(3.05, 0.35, 0.2, 0.05)))


@pytest.mark.parametrize("apart", [-0.93, -0.5, 0.0, 0.008])
def test_facets_beside_are_not_candidates(apart: float) -> None:
    """Equal plates, looked into ten facets deep: of each square the one opposite, and at most the eight around it."""
    first, second = plates(apart)
    i1, i2 = facet_candidates(first, second, np.arange(COUNT**2), 0.01, DEEP)
    centres = [surface.points[surface.facets].mean(axis=1)[:, :2] for surface in (first, second)]
    beside = np.abs(centres[0][i1] - centres[1][i2]).max(axis=1)
    assert beside.max() < 0.11
    assert np.array_equal(np.unique(i1[beside < 1e-9]), np.arange(COUNT**2))


@pytest.mark.parametrize("apart", [-1.2, 0.2])
def test_surfaces_out_of_reach_have_no_candidates(apart: float) -> None:
    """A plate above the gap or below the overlap that is looked for."""
    assert len(facet_candidates(*plates(apart), np.arange(COUNT**2), 0.01, DEEP)[0]) == 0


@pytest.mark.parametrize("surfaces", [plates(-0.5), caps()])
def test_tree_is_asked_for_enough(surfaces: tuple[Surface, Surface], monkeypatch: pytest.MonkeyPatch) -> None:
    """Candidates are those that are found where the tree gives every facet each time, and where few facets are looked
    at together."""
    chosen = np.arange(1, len(surfaces[0].facets))
    wanted = facet_candidates(*surfaces, chosen, 0.1, DEEP)
    assert len(wanted[0]) > len(chosen)
    for name, value in (("SLIGHTLY_MORE", 1e6), ("AT_ONCE", 7)):
        monkeypatch.setattr(module, name, value)
        assert np.array_equal(facet_candidates(*surfaces, chosen, 0.1, DEEP), wanted)
