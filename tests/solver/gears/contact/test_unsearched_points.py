"""Points of flanks outside a window."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.contact.search.pairing import Pairing, pair_surfaces
from evolvent.fem.surface import Surface
from evolvent.gears.contact.contact_line import ContactLine
from evolvent.gears.contact.search_window import EXTENSION
from evolvent.gears.contact.unsearched_points import unsearched_pairs
from evolvent_meshes.arrays import Floats
from tests.support.meshes.flanks_in_mesh import line, placed
from tests.support.paper_pairs import yang

WINDOW, GAP, OVERLAP = 0.4, 0.02, 1.0
"""Half-width of the window and limits of the search [mm]."""
LEAVING = 1
"""A tooth pair whose contact line has left the flanks over part of the face."""


def overlapping() -> tuple[Surface, Surface]:
    """The flanks of the tooth pair LEAVING, the wheel's moved 0.05 mm into the pinion's."""
    first, second = placed(LEAVING)
    return first, second.moved(np.eye(3), -0.05 * np.asarray(first.normals.mean(axis=0)))


def found(moved: float = 0.0) -> tuple[Pairing, Surface, Surface]:
    flanks = overlapping()
    return unsearched_pairs(line(LEAVING), WINDOW, moved, flanks, GAP, OVERLAP), *flanks


def places(pairing: Pairing, first: Surface) -> tuple[Floats, Floats]:
    """Distance from the line and roll distance of the line at the points of a pairing."""
    stand, base = line(LEAVING).stand, yang().pinion.base_radius
    x = first.positions(pairing.facet1, pairing.xi1[:, None])[:, 0]
    arc = (x[:, 0] ** 2 + x[:, 1] ** 2 - base**2) / (2.0 * base)
    return arc - line(LEAVING).arc(x[:, 2]), stand.roll_distance(LEAVING, x[:, 2])


def test_points_lie_outside_the_window() -> None:
    """Exact: in slices off the path of contact, and not within the window there; gaps are within the limits, and
    x_2 = x_1 + gap n_1."""
    pairing, first, second = found()
    across, ξ = places(pairing, first)
    (start, end), beyond = yang().path_of_contact, EXTENSION * yang().pinion.normal_module
    assert ((ξ < start) | (ξ > end)).all() and len(ξ)
    near = (ξ > start - beyond) & (ξ < end + beyond)
    assert (np.abs(across[near]) > WINDOW - 1e-3).all()
    assert (pairing.gap <= GAP).all() and (pairing.gap >= -OVERLAP).all()
    x1, n = (first.evaluate(v, pairing.facet1, pairing.xi1[:, None])[0][:, 0] for v in (first.points, first.normals))
    x2 = second.positions(pairing.facet2, pairing.xi2[:, None])[:, 0]
    n /= np.linalg.norm(n, axis=1)[:, None]
    assert x2 == pytest.approx(x1 + pairing.gap[:, None] * n, abs=1e-8)


def test_deepest_overlap_is_that_of_the_search_over_segments() -> None:
    """Problem: the same flanks by the search that cuts facets, over all of them. Exact: of its points outside the
    window none lies deeper, up to half a row beside an edge."""
    pairing, first, second = found()
    every = pair_surfaces(first, second, GAP, OVERLAP)
    across, ξ = places(every, first)
    (start, end), beyond = yang().path_of_contact, EXTENSION * yang().pinion.normal_module
    searched = (np.abs(across) <= WINDOW) & (ξ > start - beyond) & (ξ < end + beyond)
    outside = ((ξ < start) | (ξ > end)) & ~searched
    assert pairing.gap.min() == pytest.approx(every.gap[outside].min(), abs=2e-3)


def test_steep_modifications_widen_what_is_looked_at() -> None:
    """Problem: contact that modifications may move by 0.3 mm. Exact: slices on the path of contact are looked at beside
    the window, up to that distance."""
    pairing, first, _ = found(0.3)
    across, ξ = places(pairing, first)
    start, end = yang().path_of_contact
    on = (ξ >= start) & (ξ <= end)
    assert on.any()
    assert (np.abs(across[on]) > WINDOW - 1e-3).all() and (np.abs(across[on]) < WINDOW + 0.3 + 1e-3).all()


def test_points_lie_at_heights_that_both_flanks_have() -> None:
    """Problem: the same flanks, the wheel's taken to be 1 mm wide. Exact: no point lies beyond it; with the whole face
    some lie 0.9 mm from the middle."""
    whole, flanks = line(LEAVING), overlapping()
    pinion, wheel = whole.flanks
    narrow = replace(whole, flanks=(pinion, replace(wheel, height=wheel.height / np.ptp(wheel.height))))

    def heights(own: ContactLine) -> Floats:
        pairing = unsearched_pairs(own, WINDOW, 0.0, flanks, GAP, OVERLAP)
        return np.abs(flanks[0].positions(pairing.facet1, pairing.xi1[:, None])[:, 0, 2])

    assert heights(whole).max() > 0.9
    assert 0.4 < heights(narrow).max() <= 0.5
