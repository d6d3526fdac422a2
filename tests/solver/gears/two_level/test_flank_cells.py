"""Places on a swept flank, by profile arc and height."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.two_level.flank_cells import FlankCells, FlankPlaces
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.arrays import Floats
from tests.support.meshes.sector_cases import gear_and_start, sector

BASE = gear_and_start("yang pinion")[0].base_radius


@cache
def flank() -> tuple[Surface, FlankCells]:
    surface = surface_of(sector("yang pinion"), "flank")
    return surface, FlankCells.of(FlankLattice.of(surface.points), surface, BASE)


def arcs_and_heights(points: Floats) -> tuple[Floats, Floats]:
    """Profile arc (r² − r_b²)/2r_b and height of points (n, 3)."""
    r = np.hypot(points[:, 0], points[:, 1])
    return (r**2 - BASE**2) / (2.0 * BASE), points[:, 2]


def test_places_of_nodes_are_theirs() -> None:
    """Problem: the nodes of a helical flank are looked up by profile arc and height. Exact: the facet's shape functions
    there give the nodes."""
    surface, cells = flank()
    facets, xi = cells.reference(cells.place(*arcs_and_heights(surface.points)))
    assert surface.positions(facets, xi[:, None])[:, 0] == pytest.approx(surface.points, abs=1e-9)


def test_places_between_nodes_have_the_arc_and_height_asked_for() -> None:
    """Problem: random places. Exact: their points on the facets have that height, and that arc up to what second-order
    facets leave of an involute, a thousandth of a row."""
    surface, cells = flank()
    random = np.random.default_rng(1)
    arc, z = (random.uniform(each[0], each[-1], 200) for each in (cells.arc, cells.height))
    facets, xi = cells.reference(cells.place(arc, z))
    found = arcs_and_heights(surface.positions(facets, xi[:, None])[:, 0])
    assert found[1] == pytest.approx(z, abs=1e-9)
    assert found[0] == pytest.approx(arc, abs=1e-3 * np.diff(cells.arc[::2]).max())


def test_slopes_are_derivatives_of_arc_and_height() -> None:
    """Problem: places moved by a small step within their cells. Exact: arc and height grow by slope times step."""
    _, cells = flank()
    row, layer = np.array([0, 3, 7]), np.array([1, 0, 3])
    at, step = np.array([[0.1, 0.2], [0.5, 0.7], [0.9, 0.4]]), 1e-6

    def values(at: Floats) -> Floats:
        parts = []
        for nodes, cell, t in zip((cells.arc, cells.height), (row, layer), at.T):
            a, m, b = (nodes[2 * cell + i] for i in range(3))
            parts.append(a * (1 - t) * (1 - 2 * t) + 4 * m * t * (1 - t) + b * t * (2 * t - 1))
        return np.stack(parts, axis=1)

    slopes = cells.slopes(FlankPlaces(row, layer, at))
    assert (values(at + step) - values(at)) / step == pytest.approx(slopes, rel=1e-4)


def test_places_beyond_a_cell_move_to_the_next_one_but_not_off_the_flank() -> None:
    """Problem: reference coordinates a tenth of a cell beyond an inner cell, and beyond the tip. Exact: a tenth into
    the neighbour; beyond the tip the cell stays."""
    _, cells = flank()
    rows, layers = cells.facets.shape
    places = FlankPlaces(np.array([2, rows - 1]), np.array([1, layers - 1]), np.full((2, 2), 0.5))
    beyond = FlankPlaces(places.row, places.layer, np.array([[1.1, -0.1], [1.1, 0.5]]))
    moved = cells.moved(places, cells.reference(beyond)[1])
    assert moved.row.tolist() == [3, rows - 1] and moved.layer.tolist() == [0, layers - 1]
    assert moved.at == pytest.approx(np.array([[0.1, 0.9], [1.1, 0.5]]))
