"""Cells along contact lines."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from evolvent.gears.contact.contact_lattice import ContactLattice
from tests.support.meshes.flanks_in_mesh import TEETH, line


def test_teeth_out_of_reach_have_no_lattice() -> None:
    """A tooth pair three pitches away."""
    assert not len(line(4).cell_limits(np.ones_like))
    assert ContactLattice.of(line(4), 1.0) is None


@pytest.mark.parametrize("tooth", TEETH)
def test_shape_functions(tooth: int) -> None:
    """Exact: they add up to one, and interpolate height and profile arc: displacements that are linear on the flank are
    represented exactly. Points of a cell follow each other."""
    lattice = ContactLattice.of(line(tooth), 0.8)
    assert lattice is not None
    N = lattice.shape
    assert np.asarray(N.sum(axis=1)).ravel() == pytest.approx(np.ones(N.shape[0]))
    assert N @ lattice.z == pytest.approx(lattice.point_z)
    assert N @ lattice.arc == pytest.approx(lattice.point_arc, abs=1e-12)
    first = N.indices.reshape(-1, 9)[:, 0]
    assert np.count_nonzero(np.diff(first)) + 1 == len(np.unique(first))


@pytest.mark.parametrize("tooth", TEETH)
def test_points_cover_what_both_flanks_share(tooth: int) -> None:
    """Problem: cells over the whole flanks, also where the contact line has left the path of contact. Exact: the
    weights add up to the area between the tips of both gears, profile arc times height, but for slivers and for the
    curve of a tip across a cell, a thousandth."""
    found = line(tooth)
    lattice = ContactLattice.of(found, np.inf)
    assert lattice is not None

    def width(z: float) -> float:
        at = np.array([z])
        low, high = found.edges(at, found.arc(at))
        return float(max(high[0] - low[0], 0.0))

    limits = found.layer_limits(found.cell_limits(np.ones_like, whole=True))
    pinion, wheel = (flank.height for flank in found.flanks)
    assert limits[[0, -1]] == pytest.approx([max(pinion[0], wheel[0]), min(pinion[-1], wheel[-1])])
    area = sum(quad(width, a, b)[0] for a, b in pairwise(limits))
    assert lattice.weights.sum() == pytest.approx(area, rel=2e-3)


def test_window_holds_what_is_near_the_line() -> None:
    """Problem: a window 0.8 mm about the line. Exact: the cells reach at least that far wherever the flanks do, and
    no cell lies beyond."""
    lattice = ContactLattice.of(line(0), 0.8)
    assert lattice is not None
    low, high = line(0).edges(lattice.point_z, line(0).arc(lattice.point_z))
    width = line(0).row_width(lattice.point_z)
    inside = (low < -0.8 - 2.0 * width) & (high > 0.8 + 2.0 * width)
    assert inside.any()
    for z in np.unique(lattice.point_z[inside]):
        here = lattice.point_across[lattice.point_z == z]
        assert here.min() < -0.8 and here.max() > 0.8
    assert (np.abs(lattice.point_across) < 0.8 + 1.3 * width).all()


def test_line_runs_through_the_middle_of_cells() -> None:
    """Exact: corners of cells are half a row's width and multiples of it beyond from the line."""
    lattice = ContactLattice.of(line(0), 0.8)
    assert lattice is not None
    corners = lattice.shape.indices.reshape(-1, 9)[:, [0, 2, 6, 8]]
    z = lattice.z[corners].ravel()
    place = ((lattice.arc[corners].ravel() - line(0).arc(z)) / line(0).row_width(z)).reshape(corners.shape)
    assert place - np.floor(place) == pytest.approx(np.full(corners.shape, 0.5))
