"""The nodes of a flank as a lattice."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.surface import surface_of
from evolvent.gears.two_level.flank_lattice import FlankLattice
from tests.support.meshes.sector_cases import COARSE, sector


def test_lattice_of_a_helical_flank() -> None:
    """Rows of one radius from the root to the tip, levels of one height, whatever the order of the nodes; places are
    found again. Exact."""
    points = surface_of(sector("yang pinion"), "flank").points
    shuffled = np.random.default_rng(3).permutation(points)
    lattice = FlankLattice.of(shuffled)
    assert lattice.cells == (COARSE.profile_elements, COARSE.face_elements)
    assert np.array_equal(lattice.points, shuffled[lattice.nodes])
    assert np.ptp(np.hypot(lattice.points[..., 0], lattice.points[..., 1]), axis=1).max() < 1e-9
    assert np.ptp(lattice.points[..., 2], axis=0).max() < 1e-9
    assert (np.diff(lattice.radius) > 0.0).all() and (np.diff(lattice.height) > 0.0).all()
    place = lattice.place(shuffled)
    assert np.array_equal(lattice.nodes[tuple(place.T)], np.arange(len(shuffled)))


def test_nodes_that_are_no_lattice_are_refused() -> None:
    """One node is missing."""
    points = surface_of(sector("yang pinion"), "flank").points
    with pytest.raises(ValueError, match="wanted a lattice of nodes, found 224 on 25 radii and 9 heights"):
        FlankLattice.of(points[1:])
